"""Angles of LEDs in placement lists: houses count from the cathode, whichever end is marked."""

import shutil
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import pytest

from lumitip_fab.boards.fab.order import angle_at, turned_by_assumption
from lumitip_fab.boards.files import board_files
from lumitip_fab.checks.orders import measure_board
from lumitip_fab.checks.result import Measurement
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Box, Component, Design, Footprint, Pad
from lumitip_fab.design.encoding import design_text
from lumitip_fab.errors import InputError

ANODE_MARKED, ANODE_LEFT_AT_JLCPCB, USUAL = "XL-1608HIRC-850", "VSMB1940X01", "15406085BA300"
SMALL = {
    "grid.columns": (3, 2, 3, 2, 3),
    "board.tip_margin_mm": 4.6,
    "supply.voltage_v": 12.0,
    "emitter.current_ma": 12.0,
}
CHIP = Footprint("LEDC1608X60N", (Pad("1", -0.6, 0, 0.8, 1.0),), Box(-1, 1, -1, 1), 0.6)


def with_led(led: str, design_dir: Path) -> Design:
    published = load(design_dir / "presets/published.toml")
    return derive(published.with_values({**SMALL, "emitter.led": led}))


def led(order_number: str) -> Component:
    return Component("D1", "", order_number, "led", CHIP, 0, 0, 0.0, "front", ())


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    ("name", "turns"),
    [
        (USUAL, {"generic": 0, "jlcpcb": 0, "pcbway": 0}),
        # Its cathode is at the right, as we place it.
        (ANODE_MARKED, {"generic": 180, "jlcpcb": 180, "pcbway": 180}),
        # This house's own footprint has the anode at the left.
        (ANODE_LEFT_AT_JLCPCB, {"generic": 0, "jlcpcb": 180, "pcbway": 0}),
    ],
)
def test_an_led_is_turned_by_its_cathode(
    name: str, turns: dict[str, float], design_dir: Path
) -> None:
    design = with_led(name, design_dir)
    part = led(design.packages.led.order_number)
    assert {fab.name: angle_at(part, fab) for fab in design.fabs} == turns


def test_angles_of_leds_at_jlcpcb_are_assumed_but_of_those_whose_footprint_is_known(
    design_dir: Path,
) -> None:
    (fab,) = (fab for fab in with_led(USUAL, design_dir).fabs if fab.name == "jlcpcb")
    assert turned_by_assumption(led(USUAL), fab)
    assert turned_by_assumption(led(ANODE_MARKED), fab)
    assert not turned_by_assumption(led(ANODE_LEFT_AT_JLCPCB), fab)


def failing(found: Iterable[Measurement]) -> set[str]:
    return {m.check for m in found if not m.passed}


@pytest.mark.slow
@pytest.mark.parametrize("name", [ANODE_MARKED, ANODE_LEFT_AT_JLCPCB])
def test_leds_that_are_turned_by_their_mark_are_seen(
    name: str, design_dir: Path, tmp_path: Path
) -> None:
    design = with_led(name, design_dir)
    by_mark = replace(
        design,
        fabs=tuple(replace(fab, anode_first=(), part_rotations=()) for fab in design.fabs),
    )
    emitter = next(finger for finger in design.fingers if finger.name == "emitter")
    for folder, made in (("right", design), ("wrong", by_mark)):
        for file in board_files(made, emitter):
            path = tmp_path / folder / file.path
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(file.data)
        (tmp_path / folder / "design.json").write_text(design_text(made), encoding="utf-8")
    assert failing(measure_board(tmp_path / "right", design, "emitter")) == set()
    assert "orders.turns" in failing(measure_board(tmp_path / "wrong", design, "emitter"))


def test_a_part_that_no_entry_has_is_not_turned_in_silence(
    design_dir: Path, tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    entries = folder / "parts/fabs.toml"
    text = entries.read_text(encoding="utf-8")
    entries.write_text(text.replace("VSMB1940X01 = 180", "VSMB1940XO1 = 180"), encoding="utf-8")
    message = (
        r"fabs\.toml:\d+: jlcpcb\.part_rotations is 'VSMB1940XO1', which does not exist\. Did you"
    )
    with pytest.raises(InputError, match=message):
        load(folder / "fingertip.toml")
