"""Damage `layout.json`, and exactly the right checks fail."""

import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.checks.run import run_checks

ALL = {
    "layout.cells",
    "layout.order",
    "layout.neighbours",
    "layout.wiring",
    "layout.facing",
    "layout.hash",
    "layout.optics",
}
ORIGIN = {"system.tcp"}
"""Measured from the origin that the layout gives."""
CARD = {"gauge_card.hash"}
"""The gauge file carries the hash of the layout that it was made for."""


def moved(told: dict[str, Any]) -> None:
    told["x_mm"][3] += 0.001


def renumbered(told: dict[str, Any]) -> None:
    told["row"][0], told["row"][1] = told["row"][1], told["row"][0]


def one_pair_lost(told: dict[str, Any]) -> None:
    told["neighbours"].pop()


def two_detectors_on_one_input(told: dict[str, Any]) -> None:
    told["channel"][1] = told["channel"][0]


def pins_swapped(told: dict[str, Any]) -> None:
    told["adc_pin"] = ["A1" if p == "A0" else "A0" if p == "A1" else p for p in told["adc_pin"]]


def another_pitch(told: dict[str, Any]) -> None:
    told["pitch_mm"] = 6.1


def a_die_elsewhere(told: dict[str, Any]) -> None:
    told["optics"]["emitter_depth_mm"] += 0.1


def another_aperture(told: dict[str, Any]) -> None:
    told["optics"]["hole_shape"] = "circle"


def a_cell_lost(told: dict[str, Any]) -> None:
    for name in ("x_mm", "y_mm", "column", "row", "mux", "channel", "adc_pin"):
        told[name].pop()
    told["neighbours"] = [pair for pair in told["neighbours"] if 31 not in pair]


DAMAGES = {
    moved: {"layout.cells", "layout.facing", "layout.hash"} | CARD,
    renumbered: {"layout.order", "layout.hash"} | CARD,
    one_pair_lost: {"layout.neighbours"},
    two_detectors_on_one_input: {"layout.wiring", "layout.hash"} | CARD,
    pins_swapped: {"layout.wiring", "layout.hash"} | CARD,
    another_pitch: {"layout.optics"},
    a_die_elsewhere: {"layout.optics"},
    another_aperture: {"layout.optics"},
    a_cell_lost: ALL | ORIGIN | CARD,
}


@pytest.mark.slow_cases
@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_fails_exactly_these_checks(
    damage: Callable[[dict[str, Any]], None],
    damaged: Path,
    failing: Callable[[Path], set[str]],
) -> None:
    file = damaged / "layout.json"
    told = json.loads(file.read_text())
    damage(told)
    file.write_text(_rehashed(told))
    assert failing(damaged) == DAMAGES[damage]


@pytest.mark.parametrize("text", ["", "{", "[]", '{"schema_version": 1}'])
def test_a_layout_that_cannot_be_read_fails_all(
    text: str, damaged: Path, failing: Callable[[Path], set[str]]
) -> None:
    (damaged / "layout.json").write_text(text)
    assert failing(damaged) == ALL | ORIGIN | {"gauge_card.readable"}


def test_every_layout_check_is_failed_by_some_damage(outputs: Path) -> None:
    assert (
        run_checks(outputs, ["layout"]).names == set.union(*DAMAGES.values()) - ORIGIN - CARD == ALL
    )


def _rehashed(told: dict[str, Any]) -> str:
    """The text of a damaged layout whose hash fits again, as a careless writer would leave it."""
    hashed = {
        name: told[name] for name in ("adc_pin", "channel", "column", "mux", "row", "x_mm", "y_mm")
    }
    text = json.dumps(hashed, sort_keys=True, separators=(",", ":"))
    return json.dumps(told | {"design_hash": hashlib.sha256(text.encode()).hexdigest()})
