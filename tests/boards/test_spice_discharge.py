"""Discharges into the wires at the controller's board: ngspice against the closed form, the limit
and the check."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from lumitip_fab.boards.spice_discharge import discharge_simulation
from lumitip_fab.checks.discharge import Clamp, generator_a, pin_pulse_a
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.protection import Protection
from spice_runs import needs_ngspice, simulated

pytestmark = pytest.mark.slow
FILES = ("fingertip.toml", "presets/mux16.toml", "presets/integrated.toml")


@pytest.fixture(scope="module")
def design(design_dir: Path) -> Design:
    """The design to edit."""
    return derive(load(design_dir / "fingertip.toml"))


def _simulated(design: Design, folder: Path) -> dict[str, float]:
    (board,) = design.protecting
    (made,) = discharge_simulation(design, board)
    assert made.path == f"boards/{board.name}/{board.name}_discharge.cir"
    return simulated(made.data.decode(), folder)


def _protection(design: Design) -> Protection:
    assert design.electrical.protection is not None
    return design.electrical.protection


def _changed(design: Design, **values: float) -> Design:
    other = dataclasses.replace(_protection(design), **values)
    electrical = dataclasses.replace(design.electrical, protection=other)
    return dataclasses.replace(design, electrical=electrical)


def _pulse_a(design: Design, capacitor_pf: float) -> float:
    """By the check's equations, with the way over the diode as long as it may be."""
    protection = _protection(design)
    nanohenry = protection.nh_per_mm * protection.reach_mm
    clamp = Clamp(protection.breakdown_v, protection.dynamic_ohm, nanohenry)
    series_ohm = protection.series_ohm * (1 - protection.resistor_tolerance)
    volts = design.electrical.channel.supply_v
    return pin_pulse_a(clamp, series_ohm, capacitor_pf, volts, protection.discharge_kv)


@needs_ngspice
@pytest.mark.parametrize("file", FILES)
def test_a_pin_s_current_is_within_its_rating(design_dir: Path, file: str, tmp_path: Path) -> None:
    design = derive(load(design_dir / file))
    protection, found = _protection(design), _simulated(design, tmp_path)
    assert protection.most_pin_a is not None
    for net in (design.wiring.adc_pins[0].lower(), "s0"):
        high, low = found[f"pin_a_high_{net}"], -found[f"pin_a_low_{net}"]
        assert min(high, low) > 0.01
        assert max(high, low) <= protection.pin_a <= protection.most_pin_a


@needs_ngspice
def test_without_resistor_and_diode_it_is_not(design: Design, tmp_path: Path) -> None:
    """The simulation can fail."""
    limit = _protection(design).most_pin_a
    assert limit is not None
    bare = _simulated(_changed(design, series_ohm=1.0), tmp_path)
    assert bare["pin_a_high_s0"] > limit
    unclamped = _simulated(_changed(design, breakdown_v=2000.0), tmp_path)
    assert unclamped["pin_a_high_s0"] > limit


@needs_ngspice
@pytest.mark.parametrize("ohm", [330.0, 1000.0, 4700.0])
def test_the_check_finds_the_same_pulse(design: Design, ohm: float, tmp_path: Path) -> None:
    other = _changed(design, series_ohm=ohm)
    found = _simulated(other, tmp_path)
    assert _pulse_a(other, 0.0) == pytest.approx(found["pin_a_high_s0"], rel=0.08)
    assert _pulse_a(other, 22.0) >= 0.95 * found["pin_a_high_a0"]


def test_the_generator_has_the_current_of_the_standard() -> None:
    """IEC 61000-4-2 at 8 kV: 30 A within 15 %, 16 A after 30 ns and 8 A after 60 ns within 30 %."""
    time_ns = np.arange(0.0, 100.0, 0.05)
    current = generator_a(time_ns, 8.0)
    assert current.max() == pytest.approx(30.0, rel=0.15)
    start = time_ns[current >= 0.1 * current.max()][0]
    after = [np.interp(start + ns, time_ns, current) for ns in (30.0, 60.0)]
    assert after == pytest.approx([16.0, 8.0], rel=0.3)
    rise = time_ns[current >= 0.9 * current.max()][0] - start
    assert rise == pytest.approx(0.8, rel=0.25)
