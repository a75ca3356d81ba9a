"""Stated errors count cells that are off their places, and borders of sheets."""

from dataclasses import replace

import numpy as np
import pytest

from lumitip import Layout
from lumitip.estimation import PoseEstimator
from lumitip.twin import Cable, Corner, HalfPlane, Scene, Twin

OFF_MM, FINGERS = 0.1, 150
SCENES = {
    "edge": HalfPlane(offset_mm=1.3, angle_deg=12.0),
    "cable": Cable(offset_mm=-0.7, angle_deg=-19.0),
    "corner": Corner(x_mm=1.0, y_mm=-2.0, angle_deg=100.0),
}


def moved(scene: Scene, x_mm: float, y_mm: float) -> Scene:
    """The scene, moved."""
    if isinstance(scene, Corner):
        return replace(scene, x_mm=scene.x_mm + x_mm, y_mm=scene.y_mm + y_mm)
    turn = np.radians(scene.angle_deg)
    along_normal_mm = y_mm * np.cos(turn) - x_mm * np.sin(turn)
    return replace(scene, offset_mm=scene.offset_mm + along_normal_mm)


def by_mm(twin: Twin, scene: Scene) -> np.ndarray:
    """Change of each cell's value by a move of the cell along x and y, shape `(2, cells)`."""
    return np.array(
        [
            (twin.values(moved(scene, -x, -y)) - twin.values(moved(scene, x, y))) / (2.0 * OFF_MM)
            for x, y in ((OFF_MM, 0.0), (0.0, OFF_MM))
        ]
    )


@pytest.mark.slow_cases
@pytest.mark.parametrize("kind", SCENES)
def test_fingertips_with_cells_off_their_places_spread_as_is_said(
    cells: Layout, twin: Twin, kind: str
) -> None:
    sure = PoseEstimator(cells, gap_sd_mm=0.0, alpha_sd=0.0, place_sd_mm=0.0, border_sd_mm=0.0)
    unsure = PoseEstimator(cells, gap_sd_mm=0.0, alpha_sd=0.0, place_sd_mm=OFF_MM, border_sd_mm=0.0)
    frame = twin.values(SCENES[kind])
    by_noise, by_both = sure(frame, kind), unsure(frame, kind)
    assert by_both.offset_mm == by_noise.offset_mm, "the pose itself is the same"
    said = np.sqrt(np.diag(by_both.covariance - by_noise.covariance)[:2])
    off_mm = OFF_MM * np.random.default_rng(0).standard_normal((FINGERS, 2, len(cells)))
    frames = frame + (off_mm * by_mm(twin, SCENES[kind])).sum(axis=1)
    found = [sure(each, kind) for each in frames]
    spread = [np.std([f.angle_deg for f in found]), np.std([f.offset_mm for f in found])]
    assert said == pytest.approx(spread, rel=0.35)


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "added_mm"), [("edge", 0.3), ("corner", 0.3), ("cable", 0.0)])
def test_the_border_of_a_sheet_is_uncertain(
    cells: Layout, twin: Twin, kind: str, added_mm: float
) -> None:
    frame = twin.values(SCENES[kind])
    without, with_it = (
        PoseEstimator(cells, border_sd_mm=border_mm)(frame, kind) for border_mm in (0.0, 0.3)
    )
    added = with_it.offset_sd_mm**2 - without.offset_sd_mm**2
    assert np.sqrt(added) == pytest.approx(added_mm, rel=1e-6, abs=1e-9)
    assert with_it.angle_sd_deg == pytest.approx(without.angle_sd_deg)
