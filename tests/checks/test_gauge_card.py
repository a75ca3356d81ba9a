"""Damage the gauge card's files, and exactly the right checks fail."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from damages import Body, box, carve, excerpt, failing, flip_a_triangle
from lumitip_fab.design.encoding import read_design
from lumitip_fab.design.frames import gauge_bed_to_sensor

pytestmark = pytest.mark.slow

Damage = Callable[[Body], Body]
CARD, GAUGE = "gauge/gauge_card.stl", "gauge.json"


@pytest.fixture
def copied(outputs: Path, tmp_path: Path) -> Path:
    """The files that the gauge card's checks read, to damage."""
    names = ("gauge", "backing", GAUGE, "layout.json", "assembly/assembly.glb")
    return excerpt(outputs, tmp_path / "gauged", *names)


# The published card in the sensor frame of the finger in its end E: frame from z = 0 to 3, blade to
# 2.2; window to x = ±19.03 and y = ±15.44, bar to y = -21.44; rails outside x = ±24.35 at y = -20,
# from z = -3; stop from y = 22.2 to 24.2, round which end S is turned, its strip through (0, 46.4).


def moved_across(part: Body) -> Body:
    return part.translate((0.3, 0, 0))


def moved_along(part: Body) -> Body:
    return part.translate((0, 0.3, 0))


def moved_up(part: Body) -> Body:
    return part.translate((0, 0, 0.3))


def scaled(part: Body) -> Body:
    return part.scale((1.01, 1.01, 1.01))


def mirrored(part: Body) -> Body:
    return part.mirror((1, 0, 0))


def upside_down(part: Body) -> Body:
    """Turned over in its file: blade and rails change sides."""
    return part.translate((0, 0, -1.5)).rotate((0, 180, 0)).translate((0, 0, 1.5))


def blade_thicker(part: Body) -> Body:
    return part + box((-19.5, -16, 2.1), (19.5, -6, 3))


def blade_recessed(part: Body) -> Body:
    return part - box((-19, -15, 2.9), (19, -6, 3.1))


def blade_with_a_hole(part: Body) -> Body:
    return part - box((-2, -14, 2), (2, -10, 3.1))


def edge_bent(part: Body) -> Body:
    return part + box((-1.0, -1.0, 2.2), (1.0, 0.1, 3))


def strip_wider(part: Body) -> Body:
    return part + part.translate((0.05, 0, 0)) ^ box((-18, 32, 2.2), (18, 61, 3)) + part


def strip_gone(part: Body) -> Body:
    return part - box((-18, 30, 2), (18, 62, 3.1))


def lid_over_a_window(part: Body) -> Body:
    return part + box((-19.5, 32, 0.5), (-12, 61, 1.5))


def frame_thinner(part: Body) -> Body:
    """On the side of one rail alone."""
    return part - box((19.5, -12, -0.1), (23.5, 8, 0.1))


def frame_without_a_side(part: Body) -> Body:
    return part - box((19.1, -12, -0.1), (23.5, 8, 3.1))


def crumb_on_the_frame(part: Body) -> Body:
    return part + box((20, -5, 2.9), (22, 0, 3.2))


def rail_inward(part: Body) -> Body:
    return part + box((-24.8, -20, -3), (-24.2, -10, 0.5))


def rail_into_the_finger(part: Body) -> Body:
    return part + box((-26, -20, -3), (-22.5, -10, 0.5))


def stop_away(part: Body) -> Body:
    return part - box((-14, 22, -3.1), (14, 22.4, -0.01))


CARVED: dict[Damage, set[str]] = {
    moved_across: {"line", "rails", "window"},
    moved_along: {"clear", "line", "rails", "window"},
    moved_up: {"bed_contact", "clear", "frame", "heights"},
    scaled: {"bed_contact", "clear", "frame", "heights", "line", "rails", "width", "window"},
    mirrored: {"angle", "window"},
    upside_down: {"borders", "heights", "line", "overhang", "rails", "span", "window"},
    blade_thicker: {"heights"},
    blade_recessed: {"heights", "min_wall", "overhang"},
    blade_with_a_hole: {"angle", "borders", "straight", "window"},
    edge_bent: {"straight"},
    strip_wider: {"line", "straight", "width"},
    strip_gone: {"borders", "frame", "heights", "line", "overhang", "span", "window"},
    lid_over_a_window: {"overhang", "span", "window"},
    frame_thinner: {"frame", "min_wall"},
    frame_without_a_side: {"frame", "min_wall"},
    crumb_on_the_frame: {"clear", "frame"},
    rail_inward: {"rails"},
    rail_into_the_finger: {"clear", "frame", "rails"},
    stop_away: {"rails"},
}


@pytest.mark.parametrize("damage", CARVED, ids=lambda d: d.__name__)
def test_a_damaged_card(damage: Damage, copied: Path) -> None:
    (card,) = read_design(copied / "design.json").gauge_cards
    carve(copied / CARD, damage, gauge_bed_to_sensor(card))
    assert failing(copied, "gauge_card") == CARVED[damage]


def change(number: int | None, **values: Any) -> Callable[[Path], None]:
    """Change `gauge.json`, or one of its placements."""

    def damage(folder: Path) -> None:
        record = json.loads((folder / GAUGE).read_text())
        (record if number is None else record["placements"][number]).update(values)
        (folder / GAUGE).write_text(json.dumps(record))

    return damage


def card_missing(folder: Path) -> None:
    (folder / CARD).unlink()


def json_missing(folder: Path) -> None:
    (folder / GAUGE).unlink()


def scene_missing(folder: Path) -> None:
    (folder / "assembly/assembly.glb").unlink()


def backing_missing(folder: Path) -> None:
    (folder / "backing/emitter_backing.stl").unlink()


def triangle_flipped(folder: Path) -> None:
    flip_a_triangle(folder / CARD)


def a_placement_missing(folder: Path) -> None:
    record = json.loads((folder / GAUGE).read_text())
    del record["placements"][2]
    (folder / GAUGE).write_text(json.dumps(record))


def a_placement_twice(folder: Path) -> None:
    record = json.loads((folder / GAUGE).read_text())
    record["placements"].append(record["placements"][0])
    (folder / GAUGE).write_text(json.dumps(record))


def swapped(folder: Path) -> None:
    """The figures of the edge on the receiver and on the emitter."""
    record = json.loads((folder / GAUGE).read_text())
    one, other = record["placements"][:2]
    for key in ("angle_deg", "low_mm", "high_mm"):
        one[key], other[key] = other[key], one[key]
    (folder / GAUGE).write_text(json.dumps(record))


FILES: dict[str, tuple[Callable[[Path], None], set[str]]] = {
    "angle": (change(0, angle_deg=12.2), {"angle"}),
    "far side": (change(1, angle_deg=168.0), {"angle", "window"}),
    "not mirrored": (change(3, angle_deg=102.0), {"angle", "window"}),
    "offset": (change(2, offset_mm=0.05), {"line"}),
    "width": (change(3, width_mm=3.1), {"width"}),
    "low": (change(0, low_mm=2.25), {"heights"}),
    "high": (change(1, high_mm=0.9), {"heights"}),
    "swapped": (swapped, {"borders", "line", "heights", "window"}),
    "gap": (change(None, gap_mm=3.1), {"gap", "frame"}),
    "hash": (change(None, design_hash="0" * 64), {"hash"}),
    "name": (change(0, name="edge"), {"placements"}),
    "finger": (change(0, on="emitter"), {"placements"}),
    "missing placement": (a_placement_missing, {"placements"}),
    "placement twice": (a_placement_twice, {"placements"}),
    "text": (change(0, angle_deg="12"), {"readable"}),
    "no name": (change(0, name=["edge"]), {"readable"}),
    "version": (change(None, schema_version=2), {"readable"}),
    "nan": (change(0, angle_deg=float("nan")), {"angle"}),
    "card_missing": (card_missing, {"readable"}),
    "json_missing": (json_missing, {"readable"}),
    "scene_missing": (scene_missing, {"readable"}),
    "backing_missing": (backing_missing, {"readable"}),
    "triangle_flipped": (triangle_flipped, {"watertight", "clear"}),
}


@pytest.mark.parametrize("case", FILES)
def test_a_damaged_file(case: str, copied: Path) -> None:
    damage, wanted = FILES[case]
    damage(copied)
    assert failing(copied, "gauge_card") == wanted


def test_an_undamaged_card_passes(outputs: Path) -> None:
    assert failing(outputs, "gauge_card") == set()
