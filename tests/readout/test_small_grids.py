"""Fingertips of few cells, of one column, and of odd silhouettes: whatever reads them works, or
says why it cannot."""

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lumitip import Layout
from lumitip.estimation import EstimationError, PoseEstimator
from lumitip.health.doctor import examine
from lumitip.processing import Processor
from lumitip.twin import Cable, Corner, Disc, HalfPlane, Twin
from lumitip.twin.fit import fit_edge, read
from lumitip.twin.optics import TwinError

Make = Callable[..., Layout]
GRIDS = [(3,), (2, 1), (1, 1, 1), (7,), (2, 2), (1, 4, 1), (5, 2, 5), (1,) * 8, (4, 4, 4, 4)]
OBJECTS = [
    HalfPlane(1.0, 20.0),
    Cable(0.5, 90.0, diameter_mm=6.0),
    Corner(0.0, 0.0, 30.0, 90.0),
    Disc(0.0, 0.0, 8.0),
]


@pytest.mark.slow
@pytest.mark.parametrize("columns", GRIDS, ids=str)
def test_the_twin_of_any_grid_reads_what_covers_it(
    columns: tuple[int, ...], make_layout: Make
) -> None:
    twin = Twin(make_layout(columns))
    assert twin.values(()) == pytest.approx(np.full(sum(columns), 255.0), abs=0.5)
    assert twin.values(HalfPlane(40.0)).max() < 10.0
    for thing in OBJECTS:
        values = twin.values(thing)
        assert values.shape == (sum(columns),)
        assert values.min() < 230.0, thing


@settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    columns=st.sampled_from(GRIDS),
    codes=st.lists(st.sampled_from([0.0, 90.0, 200.0, 255.0, np.nan]), min_size=16, max_size=16),
)
def test_any_frame_of_any_grid_has_an_answer(
    columns: tuple[int, ...], codes: list[float], make_layout: Make
) -> None:
    layout = make_layout(columns)
    processor, values = Processor(layout), np.array(codes)[: len(layout)]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        contact, batch = processor(values), processor.batch(values[None])
    found = 0 if contact.markers_mm is None else len(contact.markers_mm)
    assert batch.counts.tolist() == [found]
    if contact.markers_mm is not None and found:
        begin, end = ((layout.x_mm[cells], layout.y_mm[cells]) for cells in layout.neighbours.T)
        for x, y in contact.markers_mm:
            detour = np.hypot(begin[0] - x, begin[1] - y) + np.hypot(end[0] - x, end[1] - y)
            assert detour.min() == pytest.approx(layout.pitch_mm)  # between two neighbours


def test_a_single_column_tells_where_a_border_is_and_not_its_direction(make_layout: Make) -> None:
    """All of its markers lie on the column, whichever way the border runs."""
    layout = make_layout((7,))
    contact = Processor(layout)(np.where(layout.y_mm < 1.0, 20.0, 220.0))
    assert contact.markers_mm is not None
    assert contact.markers_mm == pytest.approx(np.array([[0.0, 3.0]]))
    values = np.full(7, 220.0)
    values[2:4] = 20.0
    contact = Processor(layout)(values)
    assert contact.markers_mm is not None and len(contact.markers_mm) == 2
    assert (contact.line, contact.corner, contact.cable) == (None, None, None)
    assert contact.shape == "edge"
    zigzag = Processor(make_layout((1,) * 8))(np.repeat([20.0, 220.0], 4))
    assert zigzag.markers_mm is not None and zigzag.shape == "edge"


@pytest.mark.parametrize("columns", [(3,), (2, 1), (1, 1, 1)], ids=str)
def test_a_pose_of_three_cells_is_refused_with_the_number_needed(
    columns: tuple[int, ...], make_layout: Make
) -> None:
    with pytest.raises(EstimationError, match="layout has 3 cells; a pose needs at least 4"):
        PoseEstimator(make_layout(columns))


def test_poses_of_a_single_column_are_never_trusted(make_layout: Make) -> None:
    """It sees a line and its mirror image alike."""
    layout = make_layout((7,))
    twin, estimator = Twin(layout), PoseEstimator(layout)
    mirrored = [twin.values(HalfPlane(1.0, angle)) for angle in (25.0, -25.0)]
    assert mirrored[0] == pytest.approx(mirrored[1], abs=0.5)
    for values in mirrored:
        for kind in ("edge", "cable", "corner"):
            found = estimator(values, kind)
            assert found.kind == kind and "ambiguous" in found.flags and not found.trusted


@pytest.mark.parametrize("columns", [(2, 2), (1, 4, 1), (5, 2, 5)], ids=str)
def test_a_pose_of_few_cells_is_near_or_flagged(
    columns: tuple[int, ...], make_layout: Make
) -> None:
    layout = make_layout(columns)
    twin, estimator = Twin(layout), PoseEstimator(layout)
    for angle in (-60.0, -20.0, 0.0, 35.0, 80.0):
        found = estimator(twin.values(HalfPlane(0.5, angle)), "edge")
        if found.trusted:
            turn = (found.angle_deg - angle + 90.0) % 180.0 - 90.0
            assert abs(turn) < 8.0 and abs(abs(found.offset_mm) - 0.5) < 1.0


def test_the_doctor_says_that_few_cells_cannot_show_swapped_ones(make_layout: Make) -> None:
    chance = np.random.default_rng(0)
    for columns in GRIDS[:3]:
        layout = make_layout(columns)
        light = 128.0 + 100.0 * np.sin(np.linspace(0, 40, 400)[:, None] + layout.y_mm)
        light[:, 1] = 0.0
        report = examine(light + chance.normal(0.0, 0.2, light.shape), layout)
        assert [(f.kind, f.cells) for f in report.findings] == [("dark", (1,))]
        assert report.unseen is not None and "too few" in report.unseen


def test_an_edge_fitted_to_a_single_column_is_refused(make_layout: Make) -> None:
    layout = make_layout((9,))
    start: Any = np.array([0.5, 0.0, 0.0, 0.05, 2.5, 0.6, 0.9, 0.1, 0.1])
    values = read(layout, start)
    assert np.isfinite(values).all()
    with pytest.raises(TwinError, match="layout has all cells in one line"):
        fit_edge(layout, values, 0.5, 0.0)
