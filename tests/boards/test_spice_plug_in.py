"""The board that the supply enters, plugged into a live one: ngspice against the closed forms and
the limits."""

import dataclasses
from pathlib import Path

import pytest

from lumitip_fab.boards.spice import plug_in_simulation
from lumitip_fab.checks.plug_in import plugged
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.electrical import PlugIn
from spice_runs import needs_ngspice, simulated

pytestmark = pytest.mark.slow
SUPPLIES_V = (5, 9, 12, 24)


def _design(design_dir: Path, volts: float) -> Design:
    config = load(design_dir / "presets/published.toml")
    return derive(config.with_values({"supply.voltage_v": float(volts)}))


def _simulated(design: Design, folder: Path) -> tuple[PlugIn, dict[str, float]]:
    (plug_in,), (board,) = design.electrical.plug_ins, design.entered
    (made,) = plug_in_simulation(design, board)
    assert made.path == f"boards/{plug_in.board}/{plug_in.board}_plug_in.cir"
    return plug_in, simulated(made.data.decode(), folder)


def _changed(design: Design, **values: float) -> Design:
    (plug_in,) = design.electrical.plug_ins
    other = dataclasses.replace(plug_in, **values)
    electrical = dataclasses.replace(design.electrical, plug_ins=(other,))
    return dataclasses.replace(design, electrical=electrical)


@needs_ngspice
@pytest.mark.parametrize("volts", SUPPLIES_V)
def test_no_part_of_the_flange_gets_more_than_it_bears(
    design_dir: Path, volts: float, tmp_path: Path
) -> None:
    plug_in, found = _simulated(_design(design_dir, volts), tmp_path)
    for cable in ("short", "long"):
        assert found[f"input_v_{cable}"] <= plug_in.limit_v
        assert found[f"supply_v_{cable}"] <= 32.0
        if plug_in.capacitor_uf:
            assert found[f"input_v_{cable}"] <= 1.01 * plug_in.supply_v, "it does not ring"
            assert 0.7 * plug_in.peak_a < found[f"peak_a_{cable}"] <= plug_in.peak_a
            assert 0 < 1e-6 * found[f"surge_ua2s_{cable}"] <= plug_in.surge_a2s
            assert plug_in.pulse_a and found[f"peak_a_{cable}"] < plug_in.pulse_a


@needs_ngspice
@pytest.mark.parametrize("volts", SUPPLIES_V)
def test_a_reversed_supply_does_not_reach_the_board(
    design_dir: Path, volts: float, tmp_path: Path
) -> None:
    _, found = _simulated(_design(design_dir, volts), tmp_path)
    assert found["reversed_v"] > -1.0
    assert abs(found["reversed_ma"]) < 0.01


@needs_ngspice
def test_without_the_resistor_the_input_rings(design_dir: Path, tmp_path: Path) -> None:
    """As on the published board: the simulation can fail."""
    design = _changed(_design(design_dir, 24), inrush_ohm=0.01, breakdown_v=(200.0, 220.0))
    plug_in, found = _simulated(design, tmp_path)
    assert found["input_v_long"] > plug_in.limit_v
    assert plug_in.pulse_a and found["peak_a_short"] > plug_in.pulse_a


@needs_ngspice
@pytest.mark.parametrize("ohm", [0.3, 1.0, 4.7])
def test_the_check_steps_through_the_same_pulse(
    design_dir: Path, ohm: float, tmp_path: Path
) -> None:
    design = _changed(_design(design_dir, 24), inrush_ohm=ohm, breakdown_v=(200.0, 220.0))
    plug_in, found = _simulated(design, tmp_path)
    volts, amperes, surge = plugged(plug_in, ohm, plug_in.cable_uh[1], 1.0)
    assert volts == pytest.approx(found["input_v_long"], rel=0.15)
    assert amperes == pytest.approx(found["peak_a_long"], rel=0.35)
    assert amperes >= found["peak_a_long"], "without fuse and MOSFET it is more"
    assert surge == pytest.approx(1e-6 * found["surge_ua2s_long"], rel=0.6)


def test_every_part_of_the_input_is_in_the_netlist(design_dir: Path) -> None:
    design = _design(design_dir, 24)
    (made,) = plug_in_simulation(design, design.entered[0])
    lines = made.data.decode().splitlines()
    assert {"R3 24V VIN 4.7", "D1 0 24V tvs", "MQ1 FUSED GATE 24V pmos"} <= set(lines)
    assert {"R1 24V GATE 100000", "R2 GATE 0 100000"} <= set(lines)
    assert any(line.startswith("C1 VIN 0 q=") for line in lines)


def test_a_supply_without_regulator_has_a_tvs_diode_alone(design_dir: Path) -> None:
    design = _design(design_dir, 5)
    (made,) = plug_in_simulation(design, design.entered[0])
    assert "D1 0 5V tvs" in made.data.decode()
    assert "R3" not in made.data.decode()
    (board,) = (each for each in design.auxiliary_boards if each.name == "flange")
    assert {"D1", "F1", "Q1"} <= {part.ref for part in board.components}


@needs_ngspice
@pytest.mark.parametrize("name", ["franka_hand", "wsg50"])
def test_without_a_flange_the_breakout_bears_a_live_and_a_reversed_supply(
    design_dir: Path, name: str, tmp_path: Path
) -> None:
    design = derive(load(design_dir / f"presets/{name}.toml"))
    latest = design.electrical.plug_ins[0].breakdown_v[1]
    plug_in, found = _simulated(_changed(design, breakdown_v=(latest, latest)), tmp_path)
    assert plug_in.board == "breakout"
    for cable in ("short", "long"):
        assert plug_in.supply_v < found[f"supply_v_{cable}"] <= min(plug_in.limit_v, 32.0)
    assert found["reversed_v"] > -1.0
    assert abs(found["reversed_ma"]) < 0.01


@needs_ngspice
def test_without_its_tvs_diode_the_breakout_rings(design_dir: Path, tmp_path: Path) -> None:
    """The simulation can fail."""
    design = derive(load(design_dir / "presets/franka_hand.toml"))
    plug_in, found = _simulated(_changed(design, breakdown_v=(200.0, 220.0)), tmp_path)
    assert found["supply_v_long"] > plug_in.limit_v
