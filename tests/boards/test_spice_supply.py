"""ngspice against the closed forms of the flange's regulator, from the nets of its board."""

import math
from pathlib import Path

import pytest

from lumitip_fab.boards.spice import supply_simulation
from lumitip_fab.cli.steps import STEPS
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.pipeline.workers import tasks
from spice_runs import needs_ngspice, simulated


def _derived(design_dir: Path, preset: str) -> Design:
    return derive(load(design_dir / "presets" / f"{preset}.toml"))


def _netlist(design: Design) -> str:
    (auxiliary,) = design.regulated
    (made,) = supply_simulation(design, auxiliary)
    assert made.path == f"boards/{auxiliary.name}/{auxiliary.name}.cir"
    return made.data.decode()


@needs_ngspice
@pytest.mark.slow
@pytest.mark.parametrize("preset", ["published", "asymmetric"])
def test_ripple_and_start_up_are_as_computed(design_dir: Path, preset: str, tmp_path: Path) -> None:
    design = _derived(design_dir, preset)
    (told,) = design.electrical.supplies
    found = simulated(_netlist(design), tmp_path)
    assert found["mean_v"] == pytest.approx(told.output_v, abs=0.01)
    assert found["ripple_a"] == pytest.approx(told.ripple_a, rel=0.05)
    assert found["ripple_mv"] == pytest.approx(told.ripple_mv, rel=0.15)
    assert found["start_ms"] == pytest.approx(0.95 * told.soft_start_ms, rel=0.03)
    assert found["top_v"] < 1.01 * told.output_v
    peak = told.load_a + told.charging_a + told.ripple_a / 2
    assert found["peak_a"] == pytest.approx(peak, rel=0.1)


def test_the_published_supply_has_the_figures_of_its_parts(design_dir: Path) -> None:
    (told,) = _derived(design_dir, "published").electrical.supplies
    assert told.ripple_a == pytest.approx(5 * (1 - 5 / 24) / (4.7e-6 * 1.1e6))
    assert told.ripple_mv == pytest.approx(1e3 * told.ripple_a / (8 * 1.1e6 * 22e-6))
    assert told.charging_a == pytest.approx(22e-6 * 5 / 4e-3)
    assert told.load_a > told.ripple_a / 2, "the coil carries current all the time"
    assert math.isclose(told.switch_ohm, (5 * 0.125 + 19 * 0.068) / 24)


def test_every_part_of_the_output_is_in_the_netlist(design_dir: Path) -> None:
    lines = _netlist(_derived(design_dir, "published")).splitlines()
    assert "L1 SW 5V 4.7u" in lines
    assert {"C2 5V 0 11u", "C3 5V 0 11u"} <= set(lines)
    assert "Vsupply VIN 0 24" in lines


def test_what_else_is_at_the_output_is_no_output_capacitor(design_dir: Path) -> None:
    design = _derived(design_dir, "integrated")
    (auxiliary,) = design.regulated
    there = {d.ref for d in auxiliary.components if d.kind == "capacitor" and ("1", "5V") in d.nets}
    assert there == {"C2", "C3", "C5"}, "C5 is of another kind, at the linear regulator's input"
    lines = _netlist(design).splitlines()
    assert [line for line in lines if line.startswith("C") and " 5V " in line] == [
        "C2 5V 0 11u",
        "C3 5V 0 11u",
    ]


def test_a_board_without_a_regulator_has_no_netlist(design_dir: Path) -> None:
    design = _derived(design_dir, "published")
    (flange,) = design.regulated
    assert [c.name for c in design.auxiliary_boards if c != flange] == ["breakout"]
    names = [task.name for task in tasks(STEPS, design) if task.step.name == "supply_spice"]
    assert names == [f"supply_spice.{flange.name}"]
