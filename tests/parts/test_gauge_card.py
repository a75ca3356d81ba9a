"""The gauge card: where its edge and strip are, on either finger, and when there is none."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from lumitip.twin.optics import GAP_MM
from lumitip.twin.scene import Cable, HalfPlane
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.making import gauge_card as made
from lumitip_fab.design import Design, GaugeCard, Target
from lumitip_fab.docs.spec import rows
from lumitip_fab.parts.export import mesh
from lumitip_fab.parts.gauge_card import gauge_card_files, gauge_card_solid, gauge_text

Motion = Callable[[NDArray[np.float64]], NDArray[np.float64]]


@pytest.fixture(scope="module")
def design(design_dir: Path) -> Design:
    return derive(load(design_dir / "presets" / "published.toml"))


@pytest.fixture(scope="module")
def card(design: Design) -> GaugeCard:
    return design.gauge_cards[0]


@pytest.fixture(scope="module")
def solid(design: Design, card: GaugeCard) -> trimesh.Trimesh:
    surface = mesh(gauge_card_solid(card, design.outline))
    return trimesh.Trimesh(surface.points_mm, surface.triangles)


def test_the_gap_is_that_of_twin_and_estimator() -> None:
    assert made.GAP_MM == GAP_MM


def test_the_numbers_of_the_published_design(card: GaugeCard) -> None:
    assert (card.gap_mm, card.blade_mm, card.rail_mm, card.edge.angle_deg) == (3.0, 0.8, 3.0, 12.0)
    found = [(t.on, t.kind, t.angle_deg, t.low_mm, t.high_mm) for t in card.placements]
    assert found == [
        ("receiver", "edge", 12.0, 2.2, 3.0),
        ("emitter", "edge", -12.0, 0.0, 0.8),
        ("receiver", "strip", 102.0, 2.2, 3.0),
        ("emitter", "strip", 78.0, 0.0, 0.8),
    ]
    assert [(t.offset_mm, t.width_mm) for t in card.placements] == [(0, 0)] * 2 + [(0, 3.0)] * 2


def test_the_window_is_clear_of_the_holes_of_both_fingers(design: Design, card: GaugeCard) -> None:
    window, radius = card.window, max(design.mask.holes_mm) / np.sqrt(3)
    for finger in design.fingers:
        for x, y in finger.cells:
            assert window.x_min_mm + 1.99 < x - radius and x + radius < window.x_max_mm - 1.99
            assert window.y_min_mm + 1.99 < y - radius and y + radius < window.y_max_mm - 1.99


def motions(card: GaugeCard) -> dict[tuple[str, str], Motion]:
    """From the frame that the card is drawn in to the receiver's, written out by hand."""
    far = 2 * card.middle_y_mm

    def turned_end(p: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.column_stack([-p[:, 0], far - p[:, 1], p[:, 2]])

    def turned_over(p: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.column_stack([-p[:, 0], p[:, 1], card.gap_mm - p[:, 2]])

    return {
        ("receiver", "edge"): lambda p: p,
        ("emitter", "edge"): turned_over,
        ("receiver", "strip"): turned_end,
        ("emitter", "strip"): lambda p: turned_over(turned_end(p)),
    }


def shape(target: Target) -> HalfPlane | Cable:
    """The target as the robot side has it."""
    line = {"offset_mm": target.offset_mm, "angle_deg": target.angle_deg}
    if target.kind == "edge":
        return HalfPlane(**line)
    return Cable(**line, diameter_mm=target.width_mm)


def test_a_solid_that_is_turned_over_has_the_mirrored_targets(
    card: GaugeCard, solid: trimesh.Trimesh
) -> None:
    places = np.random.default_rng(1).uniform(-13.0, 13.0, (4000, 2))
    for target in card.placements:
        moved = solid.copy()
        moved.vertices = motions(card)[target.on, target.kind](solid.vertices)
        assert moved.volume == pytest.approx(solid.volume)  # a motion, not a mirror image
        away = shape(target).signed_distance_mm(places[:, 0], places[:, 1])
        near = (np.abs(away) > 0.02) & (np.abs(away) < 0.5)
        assert near.sum() > 100
        beyond = target.low_mm - 0.02 if target.low_mm else target.high_mm + 0.02
        for z, filled in (
            (target.low_mm + 0.02, away < 0),
            (target.high_mm - 0.02, away < 0),
            (beyond, np.zeros(len(away), bool)),
        ):
            points = np.column_stack([places, np.full(len(places), z)])[near]
            assert (moved.contains(points) == filled[near]).all(), (target.name, z)


@pytest.mark.parametrize(("kind", "width_mm", "angle_deg"), [("edge", 0, 12), ("strip", 3, 102)])
def test_an_offset_is_mirrored_too(
    kind: Literal["edge", "strip"], width_mm: float, angle_deg: float
) -> None:
    target = Target("", "receiver", kind, 1.5, angle_deg, width_mm, 2.2, 3.0)
    turned = target.turned(3.0)
    x, y = np.random.default_rng(1).uniform(-15, 15, (2, 50))
    away = shape(target).signed_distance_mm(x, y)
    assert shape(turned).signed_distance_mm(-x, y) == pytest.approx(away)
    assert (turned.low_mm, turned.high_mm) == (0.0, 0.8)


def test_gauge_json_says_what_the_robot_side_reads(design: Design, card: GaugeCard) -> None:
    record = json.loads(gauge_text(card, design.layout.design_hash))
    assert list(record) == ["schema_version", "design_hash", "gap_mm", "placements"]
    assert record["schema_version"] == 1
    assert record["design_hash"] == design.layout.design_hash
    names = ["name", "on", "kind", "offset_mm", "angle_deg", "width_mm", "low_mm", "high_mm"]
    assert [list(entry) for entry in record["placements"]] == [names] * 4
    paths = [file.path for file in gauge_card_files(design, card)]
    assert paths == [f"gauge/gauge_card.{end}" for end in ("step", "stl", "3mf")] + ["gauge.json"]


NONE = {
    "compliant": ('extends = "flex.toml"\n', "bends"),
    "tip": ('extends = "published.toml"\n[outline]\ntip_margin_mm = 5.0\n', "no room"),
}


@pytest.mark.slow_cases
@pytest.mark.parametrize("case", NONE)
def test_without_room_there_is_none(case: str, design_dir: Path, tmp_path: Path) -> None:
    for name in ("published.toml", "flex.toml"):
        (tmp_path / name).write_bytes((design_dir / "presets" / name).read_bytes())
    text, reason = NONE[case]
    (tmp_path / "changed.toml").write_text(text, encoding="utf-8")
    found = derive(load(tmp_path / "changed.toml"))
    assert found.gauge_cards == ()
    (row,) = (row for row in rows(found) if row.quantity == "gauge card")
    assert row.computed == "none" and reason in row.reason


def test_the_height_of_every_face_is_one_of_whole_layers(design_dir: Path, tmp_path: Path) -> None:
    for name in ("published.toml", "wsg50.toml"):
        (tmp_path / name).write_bytes((design_dir / "presets" / name).read_bytes())
    text = 'extends = "wsg50.toml"\n[printer]\nprofile = "fdm 0.6"\nfit_mm = 0.1\n'
    (tmp_path / "changed.toml").write_text(text, encoding="utf-8")
    (card,) = derive(load(tmp_path / "changed.toml")).gauge_cards
    for height in (card.gap_mm, card.blade_mm, card.rail_mm):
        assert height / 0.3 == pytest.approx(round(height / 0.3))
    assert card.rail_gap_mm == pytest.approx(0.55)
    assert (card.gap_mm, card.blade_mm) == (3.0, 0.9)
