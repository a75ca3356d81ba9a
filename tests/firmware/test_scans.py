"""Scans on the bench: several conversions, ambient light, and the wait at each input."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lumitip.layout import Layout
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.wiring.ambient import CONVERSION_US, RADIO_US
from lumitip_fab.paths import firmware_sources

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(("defines", "ceiling"), [((), 4095), (("-DLUMITIP_CEILING=939",), 3845)])
def test_several_conversions_and_ambient_light(
    defines: tuple[str, ...],
    ceiling: int,
    host_program: Callable[..., Path],
    run: Callable[..., Any],
    sketch: Callable[[str], Path],
) -> None:
    """Codes have the range that ambient light took, up to the converter's greatest reading; a cell
    without ambient light keeps its code."""
    done = run(str(host_program("scans", "published", *defines)))
    assert done.returncode == 0, done.stderr
    mean, lit, unlit, bright, counts, _ = done.stdout.splitlines()
    layout = Layout.load(sketch("published").parent / "layout.json")
    assert set(mean.split()) == {"102"}  # 101.5, rounded
    assert lit.split() == [str(ceiling - 1000 - 17 * mux) for mux in layout.mux.tolist()]
    assert unlit.split() == [str(4095 - 1000 - 17 * mux) for mux in layout.mux.tolist()]
    assert bright.split() == ["0", "0", "1"], "ambient light of one, two and over three quarters"
    assert counts.split() == ["7", "8", "0"]


OWN_PULL_UPS = (
    "asymmetric",
    "flex",
    "franka_hand",
    "integrated",
    "mux16",
    "robotiq_2f140",
    "wsg50",
)
"""Presets whose photodetectors have a pull-up each."""


@pytest.mark.parametrize(
    ("preset", "period_us", "defines", "waits"),
    [
        ("published", 5000, (), True),
        ("published", 20_000, (), True),
        ("published", 5000, ("-DLUMITIP_RADIO_US=1000",), True),
        ("published", 20_000, ("-DLUMITIP_EMITTER_PIN=4",), True),
        ("mux16", 10_000, ("-DLUMITIP_AMBIENT=0",), True),
        ("dense", 5000, (), False),  # 124 conversions take the time
        ("published", 2000, (), False),
    ],
)
def test_inputs_wait_for_as_long_as_the_period_allows(
    host_program: Callable[..., Path],
    run: Callable[..., Any],
    sketch: Callable[[str], Path],
    preset: str,
    period_us: int,
    defines: tuple[str, ...],
    waits: bool,
) -> None:
    program = host_program("scans", preset, f"-DLUMITIP_PERIOD_US={period_us}", *defines)
    took_us, shortest_us = map(int, run(str(program)).stdout.splitlines()[-1].split())
    layout = Layout.load(sketch(preset).parent / "layout.json")
    channels, cells = int(layout.channel.max()) + 1, len(layout)
    waited_us = took_us - 15 * cells  # of the bench's conversions
    assert waited_us >= channels * shortest_us
    emitter = int("-DLUMITIP_EMITTER_PIN=4" in defines)
    radio_us = 1000 if "-DLUMITIP_RADIO_US=1000" in defines else 2750
    took_us += 15 * cells + 200 * emitter  # conversions of 30 us; light that becomes steady
    left_us = period_us - took_us * (1 + emitter)
    if waits:
        assert radio_us <= left_us < radio_us + channels * 2 * (1 + emitter)
    else:
        assert waited_us == channels * shortest_us


def test_a_design_with_a_switch_has_time_for_both_scans(
    host_program: Callable[..., Path], run: Callable[..., Any], design_dir: Path
) -> None:
    """The period in layout.h, with conversions of 30 us and what radio and USB take."""
    design = derive(load(design_dir / "presets" / "flex.toml"))
    ambient = design.electrical.ambient
    assert ambient is not None
    took_us, shortest_us = map(int, run(str(host_program("scans", "flex"))).stdout.split()[-2:])
    assert took_us - 15 * len(design.layout) >= 8 * shortest_us
    frame_us = 2 * (took_us + 15 * len(design.layout) + ambient.light_us) + 2750
    assert ambient.period_us - 500 < frame_us <= ambient.period_us


@pytest.mark.parametrize("file", ["fingertip", *(f"presets/{name}" for name in OWN_PULL_UPS)])
def test_cells_are_read_200_times_a_second(file: str, design_dir: Path) -> None:
    """Each after the whole wait that its phototransistor needs."""
    design = derive(load(design_dir / f"{file}.toml"))
    channel, inputs = design.electrical.channel, 2 ** len(design.wiring.select_pins)
    assert channel.wait_us is not None
    assert inputs * channel.wait_us + len(design.layout) * CONVERSION_US <= 1e6 / 200


def test_times_of_the_design_are_those_of_the_settings() -> None:
    (settings,) = (
        f.read_text(encoding="utf-8") for f in firmware_sources() if f.name == "settings.h"
    )
    assert f"#define LUMITIP_RADIO_US {RADIO_US} " in settings
    assert f"#define LUMITIP_CONVERSION_US {CONVERSION_US} " in settings
