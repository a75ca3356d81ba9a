"""The published frame of a cloth edge, and the line that the publication drew over it."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from lumitip import Layout
from lumitip.processing import Contact, Processor

Frame = NDArray[np.uint8]


def _without_the_last_columns_pairs(layout: Layout) -> Layout:
    """As the published program reads the grid: it skips the pairs inside the last column."""
    columns = layout.column[layout.neighbours]
    inside_last = (columns == layout.column.max()).all(axis=1)
    assert np.count_nonzero(inside_last) == 4
    return replace(layout, neighbours=layout.neighbours[~inside_last])


def test_the_complete_grid_gives_thirteen_markers_and_a_line_at_6_7_degrees(
    layout: Layout, cloth_edge: Frame
) -> None:
    contact = Processor(layout)(cloth_edge)
    assert len(layout.neighbours) == 73
    assert contact.shape == "edge"
    assert contact.markers_mm is not None and contact.markers_mm.shape == (13, 2)
    assert contact.line is not None and round(contact.line.angle_deg, 1) == 6.7


def test_without_the_last_columns_pairs_the_figure_results(
    layout: Layout, cloth_edge: Frame
) -> None:
    contact = Processor(_without_the_last_columns_pairs(layout))(cloth_edge)
    assert contact.markers_mm is not None and contact.markers_mm.shape == (12, 2)
    assert contact.line is not None and round(contact.line.angle_deg, 1) == 5.9


def test_a_value_between_the_step_and_the_threshold_decides_by_the_threshold(
    layout: Layout, cloth_edge: Frame
) -> None:
    """The largest step is 131 to 196; 131 lies above λ, and so its cell is light."""
    contact = Processor(layout)(cloth_edge)
    low = cloth_edge[cloth_edge <= 131].astype(float)
    high = cloth_edge[cloth_edge >= 196].astype(float)
    assert len(low) + len(high) == 32
    assert contact.threshold == pytest.approx((low.mean() + high.mean()) / 2.0)
    assert contact.contrast == pytest.approx(high.mean() - low.mean())
    assert contact.threshold is not None and contact.threshold < 131
    in_step, dark = len(low), np.count_nonzero(cloth_edge < contact.threshold)
    assert (in_step, dark) == (17, 16)
    cell = int(np.flatnonzero(cloth_edge == 131)[0])
    beside = layout.neighbours[(layout.neighbours == cell).any(axis=1)]
    darker = [p for p in beside if cloth_edge[p].min() < contact.threshold]
    assert contact.markers_mm is not None and len(darker) == 3
    for pair in darker:
        ends = np.stack((layout.x_mm[pair], layout.y_mm[pair]), axis=1)
        lengths = [sum(np.hypot(*(ends - m).T)) for m in contact.markers_mm]
        assert min(lengths) == pytest.approx(layout.pitch_mm)


def test_markers_lie_where_the_threshold_is_crossed(layout: Layout, cloth_edge: Frame) -> None:
    contact = Processor(layout)(cloth_edge)
    level, markers = contact.threshold or 0.0, contact.markers_mm
    expected = []
    for a, b in layout.neighbours:
        va, vb = float(cloth_edge[a]), float(cloth_edge[b])
        if (va < level) != (vb < level):
            share = (level - va) / (vb - va)
            ends = [(layout.x_mm[i], layout.y_mm[i]) for i in (a, b)]
            expected.append([p + share * (q - p) for p, q in zip(*ends, strict=True)])
    assert markers is not None
    np.testing.assert_allclose(markers, expected, atol=1e-12)


def test_the_line_is_that_of_total_least_squares(layout: Layout, cloth_edge: Frame) -> None:
    contact = Processor(layout)(cloth_edge)
    assert contact.markers_mm is not None and contact.line is not None
    mean = contact.markers_mm.mean(axis=0)
    _, sizes, axes = np.linalg.svd(contact.markers_mm - mean)
    assert contact.line.point_mm == pytest.approx(tuple(mean))
    assert contact.line.angle_deg == pytest.approx(np.degrees(np.arctan(axes[0, 1] / axes[0, 0])))
    assert contact.line.rms_mm == pytest.approx(sizes[1] / np.sqrt(13))


@pytest.mark.parametrize("kind", [np.uint8, np.uint16, np.float32, np.float64])
def test_any_kind_of_number_gives_the_same_contact(
    layout: Layout, cloth_edge: Frame, kind: type[np.generic]
) -> None:
    expected = Processor(layout)(cloth_edge)
    contact = Processor(layout)(cloth_edge.astype(kind))
    assert contact.line == expected.line
    assert contact.centre_mm == expected.centre_mm


def test_what_a_contact_holds_cannot_be_changed(layout: Layout, cloth_edge: Frame) -> None:
    contact = Processor(layout)(cloth_edge)
    assert isinstance(contact, Contact) and contact.markers_mm is not None
    with pytest.raises(ValueError, match="read-only"):
        contact.markers_mm[0] = 0.0
    with pytest.raises(AttributeError):
        contact.shape = "cable"  # type: ignore[misc]
