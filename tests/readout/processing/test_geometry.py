"""Objects of known pose: what is told of them, on even and uneven grids.

Errors are the method's own: markers lie on the segments between cells, so limits scale with the
pitch. Each limit stands about a third above what 60 poses give today.
"""

from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from lumitip import Layout
from lumitip.processing import Contact, Processor

Make = Callable[..., Layout]

GRIDS = {
    "published": ((5, 4, 5, 4, 5, 4, 5), 6.0),
    "asymmetric": ((4, 5, 6, 5), 5.0),
    "dense": ((10, 9, 10, 9, 10, 9, 10, 9, 10, 9, 10, 9, 10), 3.0),
    "uneven": ((3, 4, 5, 6, 7, 6, 5), 4.0),
}
POSES = 60


@pytest.fixture(params=GRIDS)
def grid(request: pytest.FixtureRequest, make_layout: Make) -> tuple[str, Layout]:
    return request.param, make_layout(*GRIDS[request.param])


def _poses(seed: int) -> Iterator[tuple[float, float, float, np.random.Generator]]:
    """Angle, offset and blur of each pose."""
    chance = np.random.default_rng(seed)
    for _ in range(POSES):
        blur_mm = chance.choice([1.3, 1.9, 4.5])
        yield chance.uniform(-90.0, 90.0), chance.uniform(-4.0, 4.0), blur_mm, chance


def _noisy(values: Any, chance: np.random.Generator) -> Any:
    return np.clip(values + chance.normal(0.0, 2.0, values.size), 0.0, 255.0)


def _turn(angle_deg: float, other_deg: float) -> float:
    """Difference of two directions of lines, in [−90, 90)."""
    return (angle_deg - other_deg + 90.0) % 180.0 - 90.0


def _offset(point_mm: tuple[float, float], angle_deg: float) -> float:
    angle = np.radians(angle_deg)
    return float(point_mm[1] * np.cos(angle) - point_mm[0] * np.sin(angle))


def _rms(errors: list[float]) -> float:
    return float(np.sqrt(np.mean(np.square(errors))))


LINE_LIMITS = {
    "published": (3.3, 0.65),
    "asymmetric": (4.5, 0.6),
    "dense": (0.8, 0.2),
    "uneven": (1.6, 0.3),
}


def test_edges(grid: tuple[str, Layout], scene: Any) -> None:
    name, layout = grid
    process, turns, shifts, shapes = Processor(layout), [], [], Counter[str]()
    for angle_deg, offset_mm, blur_mm, chance in _poses(1):
        contact = process(_noisy(scene(layout, blur_mm).edge(angle_deg, offset_mm), chance))
        assert contact.line is not None
        assert -90.0 < contact.line.angle_deg <= 90.0
        turns.append(_turn(contact.line.angle_deg, angle_deg))
        shifts.append(_offset(contact.line.point_mm, angle_deg) - offset_mm)
        shapes[contact.shape] += 1
    assert shapes["edge"] >= 0.95 * POSES, shapes
    assert (_rms(turns), _rms(shifts)) <= LINE_LIMITS[name]
    assert _rms(shifts) < LINE_LIMITS[name][1]


CABLE_LIMITS = {
    "published": (3.0, 0.5, 1.8),
    "asymmetric": (2.6, 0.3, 1.6),
    "dense": (0.5, 0.1, 1.0),
    "uneven": (1.6, 0.2, 1.4),
}


def test_cables(grid: tuple[str, Layout], scene: Any) -> None:
    name, layout = grid
    process, shapes = Processor(layout), Counter[str]()
    turns, shifts, widths = [], [], []
    for angle_deg, offset_mm, blur_mm, chance in _poses(2):
        values = scene(layout, blur_mm).cable(angle_deg, offset_mm / 2.0, 6.0)
        contact = process(_noisy(values, chance))
        shapes[contact.shape] += 1
        if contact.cable is not None:
            assert -90.0 < contact.cable.angle_deg <= 90.0
            turns.append(_turn(contact.cable.angle_deg, angle_deg))
            shifts.append(_offset(contact.cable.axis_point_mm, angle_deg) - offset_mm / 2.0)
            widths.append(contact.cable.width_mm - 6.0)
    assert shapes["cable"] >= 0.9 * POSES, shapes
    assert len(turns) >= shapes["cable"]
    for error, limit in zip((turns, shifts, widths), CABLE_LIMITS[name], strict=True):
        assert _rms(error) < limit


CORNER_LIMITS = {"published": (25.0, 4.0), "dense": (5.0, 0.8), "uneven": (14.0, 2.0)}


@pytest.mark.parametrize("name", CORNER_LIMITS)
@pytest.mark.parametrize("dark", [True, False], ids=["dark", "light"])
@pytest.mark.parametrize("opening_deg", [45.0, 60.0, 90.0, 120.0])
def test_corners(make_layout: Make, scene: Any, name: str, dark: bool, opening_deg: float) -> None:
    layout = make_layout(*GRIDS[name])
    process, shapes = Processor(layout), Counter[str]()
    openings, misses, turns = [], [], []
    for angle_deg, x_mm, blur_mm, chance in _poses(3):
        vertex_mm, first_deg = (x_mm, chance.uniform(-3.0, 3.0)), 2.0 * angle_deg
        values = scene(layout, blur_mm).corner(vertex_mm, first_deg, opening_deg, dark)
        contact = process(_noisy(values, chance))
        shapes[contact.shape] += 1
        if contact.corner is not None:
            corner = contact.corner
            assert 0.0 < corner.opening_deg < 180.0
            assert all(-180.0 < d <= 180.0 for d in corner.directions_deg)
            between = (corner.directions_deg[1] - corner.directions_deg[0]) % 360.0
            assert between == pytest.approx(corner.opening_deg)
            openings.append(corner.opening_deg - opening_deg)
            misses.append(float(np.hypot(*np.subtract(corner.vertex_mm, vertex_mm))))
            middle = corner.directions_deg[0] + corner.opening_deg / 2.0
            off = middle - first_deg - opening_deg / 2.0
            turns.append((off + 180.0) % 360.0 - 180.0)
    assert shapes["corner"] >= (1.0 if name == "dense" else 0.85) * POSES, shapes
    opening_limit, miss_limit = CORNER_LIMITS[name]
    assert _rms(openings) < opening_limit
    assert _rms(misses) < miss_limit
    assert _rms(turns) < opening_limit


@pytest.mark.parametrize("angle_deg", [-60.0, -13.0, 0.0, 30.0, 77.0, 90.0])
def test_a_plane_of_values_gives_its_level_line_to_the_float(
    grid: tuple[str, Layout], angle_deg: float
) -> None:
    """Interpolation between neighbours is exact on a plane, and so is the line."""
    layout, angle = grid[1], np.radians(angle_deg)
    left_mm = layout.y_mm * np.cos(angle) - layout.x_mm * np.sin(angle)
    contact = Processor(layout)(100.0 + 3.0 * left_mm)
    assert contact.line is not None and contact.threshold is not None
    assert contact.line.angle_deg == pytest.approx(angle_deg, abs=1e-4)
    assert contact.line.rms_mm == pytest.approx(0.0, abs=1e-5)
    level_mm = (contact.threshold - 100.0) / 3.0
    assert _offset(contact.line.point_mm, angle_deg) == pytest.approx(level_mm, abs=1e-6)


def test_the_parts_of_a_contact_apply_by_the_documented_rule(layout: Layout, scene: Any) -> None:
    process = Processor(layout)

    def parts(contact: Contact) -> set[str]:
        return {n for n in ("line", "corner", "cable") if getattr(contact, n) is not None}

    edge = process(scene(layout, 1.9).edge(20.0, 0.0))
    assert (edge.shape, parts(edge)) == ("edge", {"line"})
    cable = process(scene(layout, 1.9).cable(0.0, 0.0, 8.0))
    assert cable.shape == "cable" and parts(cable) >= {"line", "cable"}
    corner = process(scene(layout, 1.9).corner((0.0, 0.0), -45.0, 90.0))
    assert corner.shape == "corner" and parts(corner) >= {"line", "corner"}


@pytest.mark.parametrize("name", ["published", "dense"])
def test_cells_dark_by_chance_are_no_corner_and_no_cable(make_layout: Make, name: str) -> None:
    layout, chance = make_layout(*GRIDS[name]), np.random.default_rng(8)
    for _ in range(100):
        dark = chance.random(len(layout)) < 0.5
        contact = Processor(layout)(_noisy(np.where(dark, 30.0, 230.0), chance))
        assert (contact.shape, contact.corner, contact.cable) == ("edge", None, None)


@pytest.mark.parametrize("dark", [True, False], ids=["dark", "light"])
@pytest.mark.parametrize("name", ["published", "dense"])
def test_what_is_round_and_within_the_grid_is_no_corner_and_no_cable(
    make_layout: Make, scene: Any, name: str, dark: bool
) -> None:
    layout = make_layout(*GRIDS[name])
    for _, x_mm, blur_mm, chance in _poses(4):
        values = scene(layout, blur_mm).disc((x_mm / 2.0, 0.0), chance.uniform(4.0, 7.0), dark)
        contact = Processor(layout)(_noisy(values, chance))
        assert (contact.shape, contact.corner, contact.cable) == ("edge", None, None)
        assert contact.markers_mm is not None and len(contact.markers_mm) >= 6


def test_a_thin_cable_that_darkens_no_cell_at_the_rim_is_one(layout: Layout, scene: Any) -> None:
    missed = 0
    for angle_deg, offset_mm, _, chance in _poses(5):
        values = _noisy(scene(layout, 1.9).cable(angle_deg, offset_mm, 3.0), chance)
        contact = Processor(layout)(values)
        dark = values < (contact.threshold or 0.0)
        rim = np.bincount(layout.neighbours.ravel()) < 6
        if contact.threshold is not None and not dark[rim].any():
            missed += 1
            assert contact.cable is not None
    assert missed > 0
