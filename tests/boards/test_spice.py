"""ngspice against the closed forms of derive, from the nets of the boards."""

import dataclasses
import math
from pathlib import Path

import pytest

from lumitip_fab.boards.circuit import circuit
from lumitip_fab.boards.spice import simulation
from lumitip_fab.boards.spice_channel import (
    STEPS,
    Corner,
    Step,
    corners,
    detectors,
    first_mux,
)
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.wiring.sources import string_current_ma
from lumitip_fab.design import Design, Electrical, Wiring
from spice_runs import needs_ngspice, simulated

SETTLED_COUNTS = 0.5  # of 255
PRESETS = ("published", "asymmetric", "dense", "mux16", "integrated", "../fingertip")
OWN_PULL_UPS = ("../fingertip", "asymmetric", "mux16", "integrated")


@pytest.fixture(scope="module")
def presets(design_dir: Path) -> dict[str, Design]:
    """Every preset, derived."""
    return {name: derive(load(design_dir / "presets" / f"{name}.toml")) for name in PRESETS}


def _netlist(
    design: Design,
    name: str,
    wiring: Wiring | None = None,
    electrical: Electrical | None = None,
) -> str:
    d, finger = design, getattr(design, name)
    made, *_ = simulation(
        dataclasses.replace(d, wiring=wiring or d.wiring, electrical=electrical or d.electrical),
        finger,
    )
    assert made.path == f"boards/{name}/{name}.cir"
    return made.data.decode()


@pytest.mark.slow_cases
@needs_ngspice
@pytest.mark.parametrize("preset", PRESETS)
def test_a_string_draws_its_nominal_current(
    presets: dict[str, Design], preset: str, tmp_path: Path
) -> None:
    design = presets[preset]
    found = simulated(_netlist(design, "emitter"), tmp_path)
    # The closed form takes the forward voltage at the target current, not at the string's own,
    # from which that of dense differs by 1 %.
    rel = 0.005 if preset == "dense" else 0.002
    assert found["i_ma"] == pytest.approx(design.wiring.current_ma[0], rel=rel)


@needs_ngspice
@pytest.mark.parametrize("sign", [-1, 1])
@pytest.mark.parametrize("preset", ["published"])
def test_the_spread_over_tolerances_is_what_ngspice_finds(
    presets: dict[str, Design], preset: str, sign: int, tmp_path: Path
) -> None:
    design = presets[preset]
    strings = design.electrical.strings
    supply_v = design.wiring.supply_v * (1 + sign * strings.supply_tolerance)
    kelvin = abs(strings.temperatures_c[sign > 0] - 25.0)
    off_v = strings.forward_tolerance_v + kelvin * strings.forward_v_per_k
    forward_v = strings.forward_v - sign * off_v
    off = dataclasses.replace(
        design.electrical, strings=dataclasses.replace(strings, forward_v=forward_v)
    )
    ohm = tuple(r * (1 - sign * strings.resistor_tolerance) for r in design.wiring.resistor_ohm)
    wiring = dataclasses.replace(design.wiring, supply_v=supply_v, resistor_ohm=ohm)
    found = simulated(_netlist(design, "emitter", wiring, off), tmp_path)
    wanted = (strings.low_ma if sign < 0 else strings.high_ma)[0]
    assert found["i_ma"] == pytest.approx(wanted, rel=0.002)


@needs_ngspice
@pytest.mark.parametrize("preset", PRESETS)
def test_a_channel_reads_and_settles_as_computed(
    presets: dict[str, Design], preset: str, tmp_path: Path
) -> None:
    design = presets[preset]
    found = simulated(_netlist(design, "receiver"), tmp_path)
    channel = design.electrical.channel
    assert found["full_v"] == pytest.approx(channel.full_scale_v, abs=0.001)
    assert found["dark_v"] == pytest.approx(channel.dark_v, abs=0.001)
    assert found["settle_us"] == pytest.approx(channel.settle_us, rel=0.01)


@needs_ngspice
def test_a_detector_that_does_not_saturate_reads_by_its_light(
    presets: dict[str, Design], tmp_path: Path
) -> None:
    design = presets["published"]
    channel = dataclasses.replace(design.electrical.channel, light_current_ua=20.0)
    dim = dataclasses.replace(design.electrical, channel=channel)
    found = simulated(_netlist(design, "receiver", electrical=dim), tmp_path)
    assert found["full_v"] == pytest.approx(3.3 - 20e-6 * 75e3, abs=0.001)


def _detector(design: Design, corner: Corner, step: str, folder: Path) -> dict[str, float]:
    """Readings of a phototransistor after a change of channel."""
    nets = first_mux(circuit(design, design.receiver), design)
    lines = ("*", *detectors(nets, design, corner, (STEPS | HALF_LIT)[step]), ".end")
    return simulated("\n".join(lines) + "\n", folder)


@needs_ngspice
def test_a_detector_without_gain_or_base_settles_as_computed(
    presets: dict[str, Design], tmp_path: Path
) -> None:
    design = presets["published"]
    found = _detector(design, Corner(1, 0.01), "to_dark", tmp_path)
    channel = design.electrical.channel
    assert found["end_v"] == pytest.approx(channel.dark_v, abs=0.002)
    assert channel.settle_us < 100
    assert abs(found["wrong_100"]) < SETTLED_COUNTS


@pytest.mark.slow_cases
@needs_ngspice
@pytest.mark.parametrize("step", STEPS)
def test_a_phototransistor_of_the_published_circuit_does_not_settle_in_the_dark(
    presets: dict[str, Design], step: str, tmp_path: Path
) -> None:
    """README says to measure this: the circuit keeps the published values."""
    design = presets["published"]
    fastest, *_, slowest = corners(design)
    fast = _detector(design, fastest, step, tmp_path)
    slow = _detector(design, slowest, step, tmp_path)
    if STEPS[step].now:
        assert abs(fast["wrong_400"]) < SETTLED_COUNTS > abs(slow["wrong_400"])
    else:
        assert abs(fast["wrong_400"]) < SETTLED_COUNTS < abs(fast["wrong_200"])
        assert slow["wrong_400"] < -100
        assert slow["wrong_3200"] < -SETTLED_COUNTS
    assert slow["end_v"] == pytest.approx(fast["end_v"], abs=0.1)


HALF_LIT = {
    "dim": Step(1, 0.02, 0.02),
    "tenth": Step(0, 0.1, 0.1),
    "third": Step(0, 0.35, 0.35),
    "after light": Step(1, 0.2, 0.2),
    "before it saturates": Step(1, 0.48, 0.48),
    "from light": Step(1, 1, 0.1),
}


@pytest.mark.slow_cases
@needs_ngspice
@pytest.mark.parametrize("step", [*STEPS, *HALF_LIT])
@pytest.mark.parametrize("preset", OWN_PULL_UPS)
def test_with_pull_ups_of_their_own_phototransistors_settle_within_half_a_count(
    presets: dict[str, Design], preset: str, step: str, tmp_path: Path
) -> None:
    """At 200 scans a second, over the whole spread, at the wait that the firmware has."""
    design = presets[preset]
    channel = design.electrical.channel
    wait = f"wrong_{math.ceil(channel.wait_us)}"
    middle = Corner(math.sqrt(channel.gain[0] * channel.gain[1]), channel.base_pf[1])
    wrong = [
        _detector(design, corner, step, tmp_path)[wait] for corner in (*corners(design), middle)
    ]
    assert max(map(abs, wrong)) <= SETTLED_COUNTS


@needs_ngspice
def test_the_wait_is_not_much_longer_than_it_must_be(
    presets: dict[str, Design], tmp_path: Path
) -> None:
    design = presets["mux16"]
    channel = design.electrical.channel
    third = dataclasses.replace(channel, wait_us=channel.wait_us / 3)
    hasty = dataclasses.replace(
        design, electrical=dataclasses.replace(design.electrical, channel=third)
    )
    found = _detector(hasty, Corner(1000, 5.5), "third", tmp_path)
    assert abs(found[f"wrong_{math.ceil(third.wait_us)}"]) > SETTLED_COUNTS


@needs_ngspice
def test_a_lower_load_settles_sooner(presets: dict[str, Design], tmp_path: Path) -> None:
    published = presets["published"]
    wiring = dataclasses.replace(published.wiring, pull_up_ohm=7500.0)
    low = dataclasses.replace(published, wiring=wiring)
    slowest = corners(published)[-1]
    wrong = [_detector(d, slowest, "to_dark", tmp_path)["wrong_400"] for d in (published, low)]
    assert abs(wrong[1]) < abs(wrong[0]) / 5


@needs_ngspice
def test_the_netlist_of_the_detectors_is_the_slowest_that_dims(
    presets: dict[str, Design], tmp_path: Path
) -> None:
    design = presets["published"]
    _, made = simulation(design, design.receiver)
    assert made.path == "boards/receiver/receiver_detectors.cir"
    found = simulated(made.data.decode(), tmp_path)
    assert found == pytest.approx(
        _detector(design, corners(design)[-1], "dimmed", tmp_path), rel=1e-3, abs=1e-3
    )


def test_the_published_string_is_wide_and_fewer_leds_are_steadier(
    presets: dict[str, Design],
) -> None:
    strings = presets["published"].electrical.strings
    assert strings.low_ma == pytest.approx((3.9, 3.9), abs=0.1)
    assert strings.high_ma == pytest.approx((41.5, 41.5), abs=0.1)
    assert strings.fewer_leds == 12
    wide = strings.high_ma[0] / strings.low_ma[0]
    assert strings.fewer_high_ma / strings.fewer_low_ma < wide / 2


def test_the_published_channel_has_the_figures_of_its_time_constant(
    presets: dict[str, Design],
) -> None:
    channel = presets["published"].electrical.channel
    assert channel.full_scale_v == pytest.approx(0.2 + 250 * 3.1 / 75250)
    assert channel.dark_v == pytest.approx(3.3 - 75e3 * 100e-9)
    assert channel.settle_us == pytest.approx(75e3 * 75e-6 * 8.942, rel=0.001)


def test_current_falls_with_leds_and_rises_with_supply() -> None:
    def current(supply_v: float, leds: int) -> float:
        return string_current_ma(supply_v, leds, 150.0, 1.32, 19.2, 2.0)

    assert current(24.0, 16) == pytest.approx(19.2, rel=1e-6)
    assert current(25.0, 16) > 19.2 > current(24.0, 17)
    assert current(5.0, 16) < 0.01
