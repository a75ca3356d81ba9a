"""The dark centre: the published definition, on three real frames and by brute force."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from lumitip import Layout
from lumitip.processing import Processor

Make = Callable[..., Layout]
Values = Callable[[str], NDArray[np.uint8]]
Frames = dict[str, dict[str, Any]]
NAMES = ("cloth_edge", "cloth_corner", "cable")
GRIDS = ((5, 4, 5, 4, 5, 4, 5), (2, 1), (3, 4, 5, 6, 7), (4, 5, 6, 5), (7,))


def _reference(layout: Layout, values: list[float]) -> tuple[float, tuple[float, float]] | None:
    """Threshold and dark centre cell by cell in plain Python; `None` without contrast."""
    ordered = sorted(values)
    step, cut = max((ordered[i + 1] - ordered[i], -i) for i in range(len(ordered) - 1))
    if step < 1e-9:  # rounding decides which cells are dark
        return None
    low, high = ordered[: 1 - cut], ordered[1 - cut :]
    threshold = (math.fsum(low) / len(low) + math.fsum(high) / len(high)) / 2.0
    total = x_mm = y_mm = 0.0
    for cell in layout.cells:
        if values[cell.index] < threshold:
            weight = 255.0 - values[cell.index]
            total += weight
            x_mm += weight * cell.x_mm
            y_mm += weight * cell.y_mm
    return threshold, (x_mm / total, y_mm / total)


@pytest.mark.parametrize("name", NAMES)
def test_a_real_frame_gives_the_published_threshold_markers_and_dark_centre(
    layout: Layout, published_frames: Frames, published_values: Values, name: str
) -> None:
    expected, values = published_frames[name], published_values(name)
    contact, batch = Processor(layout)(values), Processor(layout).batch(values[None])
    assert contact.threshold == pytest.approx(expected["threshold"], abs=1e-3)
    assert contact.markers_mm is not None
    assert len(contact.markers_mm) == batch.counts[0] == expected["markers"]
    assert contact.centre_mm == pytest.approx(expected["dark_centre_mm"], abs=0.01)
    assert batch.thresholds[0] == pytest.approx(expected["threshold"], abs=1e-3)
    assert batch.centres_mm[0] == pytest.approx(expected["dark_centre_mm"], abs=0.01)


@pytest.mark.parametrize("name", NAMES)
def test_the_dark_centre_of_a_real_frame_lies_next_to_the_drawn_dot(
    layout: Layout, published_frames: Frames, published_values: Values, name: str
) -> None:
    """The dots were measured as distances to the defined centre, hence the triangle."""
    expected, values = published_frames[name], published_values(name)
    contact = Processor(layout)(values)
    assert contact.centre_mm is not None
    drawn_mm = expected["drawn_dot_to_dark_centre_mm"]
    ours_mm = math.dist(contact.centre_mm, expected["dark_centre_mm"])
    assert ours_mm + drawn_mm < 0.66

    # Weighted with the value itself, the brightest of the dark cells would weigh most.
    dark = values < contact.threshold
    weights = values[dark].astype(float)
    wrong = [float(weights @ c[dark] / weights.sum()) for c in (layout.x_mm, layout.y_mm)]
    assert math.dist(wrong, contact.centre_mm) > 1.0


@pytest.mark.parametrize(
    ("name", "shape", "figure_deg", "most_deg"),
    [
        ("cloth_edge", "edge", 5.8, 1.0),
        ("cloth_corner", "corner", 93.0, 0.5),
        ("cable", "cable", 31.9, 0.6),
    ],
)
def test_a_real_frame_has_the_shape_and_the_angle_that_its_figure_draws(
    layout: Layout,
    published_frames: Frames,
    published_values: Values,
    name: str,
    shape: str,
    figure_deg: float,
    most_deg: float,
) -> None:
    contact, frame = Processor(layout)(published_values(name)), published_frames[name]
    assert frame.get("drawn_line_deg", frame.get("drawn_opening_deg")) == figure_deg
    assert contact.shape == shape
    if shape == "corner":
        assert contact.corner is not None
        angle_deg = contact.corner.opening_deg
        assert contact.corner.vertex_mm == pytest.approx((-6.7, -5.8), abs=0.1)
    else:
        line = contact.cable if shape == "cable" else contact.line
        assert line is not None
        angle_deg = line.angle_deg
    assert angle_deg == pytest.approx(figure_deg, abs=most_deg)


numbers = st.one_of(st.sampled_from([0, 254, 255]), st.integers(0, 255))


@settings(max_examples=200, deadline=None)
@given(columns=st.sampled_from(GRIDS), data=st.data())
def test_any_frame_on_any_grid_gives_what_the_definition_gives(
    make_layout: Make, columns: tuple[int, ...], data: st.DataObject
) -> None:
    layout = make_layout(columns, data.draw(st.floats(1.0, 12.0)))
    size = len(layout)
    values = data.draw(st.lists(numbers, min_size=size, max_size=size))
    _compare(layout, [float(v) for v in values])


@settings(max_examples=100, deadline=None)
@given(values=st.lists(st.floats(0.0, 255.0), min_size=32, max_size=32))
@example(values=[0.0] * 31 + [255.0])
@example(values=[255.0] * 31 + [0.0])
@example(values=[254.0] * 31 + [255.0])
def test_values_that_are_not_whole_give_what_the_definition_gives(
    make_layout: Make, values: list[float]
) -> None:
    _compare(make_layout(), values)


def _compare(layout: Layout, values: list[float]) -> None:
    processor = Processor(layout, min_contrast=1e-3)
    contact, batch = processor(values), processor.batch([values])
    expected = _reference(layout, values)
    if contact.threshold is None:
        assert expected is None or max(values) - min(values) < 1.0
        assert contact.centre_mm is None and np.isnan(batch.centres_mm).all()
        return
    assert expected is not None
    threshold, centre_mm = expected
    assert contact.threshold == pytest.approx(threshold, abs=1e-9)
    if min(abs(value - threshold) for value in values) < 1e-9:
        return  # rounding decides whether that cell is dark
    assert contact.centre_mm == pytest.approx(centre_mm, abs=1e-6)
    assert batch.centres_mm[0] == pytest.approx(centre_mm, abs=1e-6)


def test_all_dark_cells_at_zero_weigh_the_same(layout: Layout) -> None:
    values = np.full(32, 200.0)
    values[[3, 4, 7]] = 0.0
    _expect(layout, values, [3, 4, 7], [1.0, 1.0, 1.0])


def test_a_darker_cell_weighs_more(layout: Layout) -> None:
    values = np.full(32, 240.0)
    values[[3, 7]] = 0.0, 85.0
    _expect(layout, values, [3, 7], [255.0, 170.0])


def test_values_beyond_the_scale_weigh_as_its_ends(layout: Layout) -> None:
    values = np.full(32, 200.0)
    values[[3, 4]] = -5.0, 10.0
    _expect(layout, values, [3, 4], [255.0, 245.0])
    values = np.full(32, 900.0)
    values[[3, 4]] = 255.0, 200.0
    _expect(layout, values, [4], [55.0])


def test_dark_cells_without_any_weight_weigh_the_same(layout: Layout) -> None:
    """Only values beyond the scale can do it: λ of others lies below 255."""
    values = np.full(32, 900.0)
    values[[3, 4, 7]] = 255.0, 300.0, 260.0
    _expect(layout, values, [3, 4, 7], [1.0, 1.0, 1.0])


@pytest.mark.parametrize("value", [0.0, 255.0])
def test_without_contrast_there_is_no_dark_centre(layout: Layout, value: float) -> None:
    processor, values = Processor(layout, min_contrast=0.0), np.full(32, value)
    assert processor(values).centre_mm is None
    assert np.isnan(processor.batch(values[None]).centres_mm).all()


def _expect(
    layout: Layout, values: NDArray[np.float64], cells: list[int], weights: list[float]
) -> None:
    expected = [np.average(c[cells], weights=weights) for c in (layout.x_mm, layout.y_mm)]
    processor = Processor(layout)
    assert processor(values).centre_mm == pytest.approx(expected, abs=1e-9)
    assert processor.batch(values[None]).centres_mm[0] == pytest.approx(expected, abs=1e-9)
