"""The sheet on a positioning stage: how exactly its edge is found."""

import numpy as np
import pytest

from lumitip.acceptance.stage import STEP_MM, Trace, Traverse, places_mm, trace, ways_mm
from lumitip.estimation import PoseEstimator
from lumitip.links.twin import published_layout
from lumitip.twin import Twin

LAYOUT = published_layout()
TWIN = Twin(LAYOUT)
ACROSS_MM, ALONG_MM = ways_mm(LAYOUT)


@pytest.fixture(scope="module")
def estimate() -> PoseEstimator:
    return PoseEstimator(LAYOUT).prepare("edge")


def traced(
    estimate: PoseEstimator,
    angle_deg: float,
    way_mm: float,
    *,
    stretch: float = 1.0,
    play_mm: float = 0.0,
    swapped: tuple[int, int] = (0, 0),
    blind: slice = slice(0, 0),
) -> Trace:
    """The trace of a sheet that covers the right of its edge and moves to the left, and back."""
    moved_mm = places_mm(way_mm)
    offset = stretch * (moved_mm - way_mm / 2.0) * np.cos(np.radians(_askew(angle_deg)))
    offset[len(offset) // 2 + 1 :] += play_mm
    values = TWIN.edges(offset, np.full(offset.size, angle_deg))
    values[:, swapped] = values[:, swapped[::-1]]
    values[blind] = np.nan
    light = np.repeat(values[:, None], 2, axis=1).astype(np.float32)
    return trace(Traverse("Z-", moved_mm, light), values, LAYOUT, estimate)


def _askew(angle_deg: float) -> float:
    return angle_deg - 90.0 * round(angle_deg / 90.0)


def test_the_ways_pass_all_holes_from_beside_them() -> None:
    hole_mm = LAYOUT.optics.hole_mm
    for way_mm, cells in ((ACROSS_MM, LAYOUT.x_mm), (ALONG_MM, LAYOUT.y_mm)):
        assert np.ptp(cells) + hole_mm < way_mm < np.ptp(cells) + hole_mm + 10.0
    moved_mm = places_mm(ACROSS_MM)
    assert moved_mm[0] == moved_mm[-1] == 0.0
    assert moved_mm.max() == ACROSS_MM
    assert set(np.abs(np.diff(moved_mm)).tolist()) == {STEP_MM}


@pytest.mark.parametrize("angle_deg", [0.0, 90.0, -90.0, 180.0, 6.0, 97.0, -84.0])
def test_a_drawn_fingertip_finds_the_edge_where_the_stage_is(
    estimate: PoseEstimator, angle_deg: float
) -> None:
    way_mm = ACROSS_MM if abs(angle_deg % 180.0 - 90.0) < 20.0 else ALONG_MM
    found = traced(estimate, angle_deg, way_mm)
    assert found.direction == "Z-"
    assert found.places > 40
    assert found.missed == 0
    assert found.error_mm < 0.15
    assert found.error_mm <= found.worst_mm < 0.5
    assert found.scale == pytest.approx(1.0, abs=0.01)
    assert found.turn_deg < 1.0
    assert found.play_mm < 0.02


def test_an_edge_across_the_rows_is_found_more_exactly(estimate: PoseEstimator) -> None:
    """The figures of `docs/accept.md`."""
    along = [traced(estimate, 0.0, ALONG_MM), traced(estimate, 90.0, ACROSS_MM)]
    turned = [traced(estimate, 4.0, ALONG_MM), traced(estimate, 94.0, ACROSS_MM)]
    assert 0.12 < max(of.error_mm for of in along) < 0.14
    assert max(of.error_mm for of in turned) < 0.04


def test_a_scale_that_is_wrong_is_part_of_the_error(estimate: PoseEstimator) -> None:
    good, wide = (traced(estimate, 0.0, ALONG_MM, stretch=of) for of in (1.0, 1.05))
    assert wide.scale / good.scale == pytest.approx(1.05, abs=0.005)
    assert wide.error_mm > 3.0 * good.error_mm


def test_play_of_the_stage_is_no_error_of_the_fingers(estimate: PoseEstimator) -> None:
    good, loose = (traced(estimate, 90.0, ACROSS_MM, play_mm=of) for of in (0.0, 0.3))
    assert loose.play_mm == pytest.approx(0.3, abs=0.06)
    assert loose.error_mm == pytest.approx(good.error_mm, abs=0.03)


def test_swapped_cells_are_an_error(estimate: PoseEstimator) -> None:
    good = traced(estimate, 0.0, ALONG_MM)
    swapped = traced(estimate, 0.0, ALONG_MM, swapped=(1, 30))
    assert swapped.error_mm > 2.0 * good.error_mm


def test_a_place_without_an_estimate_is_counted(estimate: PoseEstimator) -> None:
    good = traced(estimate, 0.0, ALONG_MM)
    blind = traced(estimate, 0.0, ALONG_MM, blind=slice(18, 23))
    assert (blind.places, blind.missed) == (good.places, 5)


def test_a_sheet_that_never_came_has_no_error(estimate: PoseEstimator) -> None:
    moved_mm = places_mm(20.0)
    values = np.full((moved_mm.size, len(LAYOUT)), 255.0)
    light = values[:, None].astype(np.float32)
    found = trace(Traverse("Y+", moved_mm, light), values, LAYOUT, estimate)
    assert found.places == 0
    assert np.isnan(found.error_mm)
