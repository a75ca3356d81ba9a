"""Frames at the edge of sense: each has one defined answer."""

import warnings
from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest

from lumitip import Layout, LumitipError
from lumitip.processing import Contact, Processor, ValuesError

Make = Callable[..., Layout]


def _is_empty(contact: Contact) -> bool:
    return all(getattr(contact, f.name) is None for f in fields(contact) if f.name != "shape")


@pytest.mark.parametrize(
    ("level", "shape"), [(255, "none"), (128, "none"), (127, "covered"), (0, "covered")]
)
def test_a_flat_frame_is_no_contact(layout: Layout, level: int, shape: str) -> None:
    contact = Processor(layout)(np.full(32, level))
    assert contact.shape == shape
    assert _is_empty(contact)


def test_a_flat_frame_is_no_contact_even_when_no_contrast_is_asked_for(layout: Layout) -> None:
    processor = Processor(layout, min_contrast=0.0)
    assert _is_empty(processor(np.full(32, 200)))
    assert processor.batch(np.full((1, 32), 200)).counts.tolist() == [0]


def test_below_the_minimum_contrast_there_is_no_contact(layout: Layout) -> None:
    values = np.full(32, 200.0)
    values[:8] = 180.5
    assert _is_empty(Processor(layout)(values))
    assert Processor(layout, min_contrast=19.5)(values).contrast == pytest.approx(19.5)
    values[:8] = 180.0
    assert Processor(layout)(values).contrast == pytest.approx(20.0)


def test_the_level_of_a_covered_finger_is_a_parameter(layout: Layout) -> None:
    assert Processor(layout, covered_below=230.0)(np.full(32, 223)).shape == "covered"


def test_of_equal_steps_the_lowest_is_the_threshold(layout: Layout) -> None:
    values = np.full(32, 200.0)
    values[:10] = 100.0
    values[:2] = 0.0
    contact = Processor(layout)(values)
    high = (8 * 100 + 22 * 200) / 30
    assert contact.threshold == pytest.approx(high / 2)
    assert Processor(layout).batch(values[None]).thresholds == pytest.approx([high / 2])


@pytest.mark.parametrize("dark", [True, False])
def test_one_cell_is_a_cluster(layout: Layout, dark: bool) -> None:
    """Cell 16 has six neighbours: its markers form a hexagon, which favours no direction."""
    low, high = (40.0, 240.0) if dark else (240.0, 40.0)
    values = np.full(32, high)
    values[16] = low
    contact = Processor(layout)(values)
    centre = np.array((layout.x_mm[16], layout.y_mm[16]))
    assert contact.threshold == 140.0
    assert contact.line is None
    assert contact.markers_mm is not None and len(contact.markers_mm) == 6
    assert np.hypot(*(contact.markers_mm - centre).T) == pytest.approx([3.0] * 6)
    assert (contact.shape, contact.corner, contact.cable) == ("edge", None, None)
    if dark:
        assert contact.centre_mm == pytest.approx(tuple(centre))


@pytest.mark.parametrize("odd", [np.nan, np.inf, -np.inf])
def test_cells_that_are_not_finite_are_left_out(layout: Layout, odd: float) -> None:
    """As if the grid had no such cell: the others give what a grid without it gives."""
    values = np.where(layout.y_mm < 1.0, 200.0, 20.0) + layout.x_mm
    dead = [0, 12, 31]
    alive = np.setdiff1d(np.arange(32), dead)
    number = np.full(32, -1)
    number[alive] = np.arange(alive.size)
    pairs = number[layout.neighbours]
    names = ("x_mm", "y_mm", "column", "row", "mux", "channel", "adc_pin")
    smaller = replace(
        layout,
        neighbours=pairs[(pairs >= 0).all(axis=1)],
        **{name: getattr(layout, name)[alive] for name in names},
    )
    expected = Processor(smaller)(values[alive])
    values[dead] = odd
    contact = Processor(layout)(values)
    for name in ("shape", "threshold", "contrast", "centre_mm", "line", "corner", "cable"):
        assert getattr(contact, name) == getattr(expected, name), name
    assert contact.markers_mm is not None and expected.markers_mm is not None
    np.testing.assert_array_equal(contact.markers_mm, expected.markers_mm)
    assert len(expected.markers_mm) > 5


@pytest.mark.parametrize("alive", [0, 1])
def test_with_less_than_two_cells_alive_there_is_no_contact(layout: Layout, alive: int) -> None:
    values = np.full(32, np.nan)
    values[:alive] = -500.0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert _is_empty(Processor(layout)(values))
        assert np.isnan(Processor(layout).batch(values[None]).thresholds).all()


def test_two_cells_give_one_marker_and_no_line(make_layout: Make) -> None:
    contact = Processor(make_layout((2, 1)))([200.0, 200.0, 100.0])
    assert contact.markers_mm is not None and len(contact.markers_mm) == 2
    assert contact.line is not None and contact.line.rms_mm == pytest.approx(0.0)
    assert (contact.corner, contact.cable, contact.shape) == (None, None, "edge")
    single = Processor(make_layout((2,)))([200.0, 100.0])
    assert single.markers_mm == pytest.approx(np.array([[0.0, 0.0]]))
    assert (single.line, single.shape) == (None, "edge")


def test_a_grid_of_one_cell_never_has_contact(make_layout: Make) -> None:
    processor = Processor(make_layout((1,)))
    assert _is_empty(processor([0.0]))
    assert processor.batch([[0.0]]).markers_mm.shape == (1, 0, 2)


def test_a_grid_without_neighbours_has_no_markers(layout: Layout) -> None:
    alone = replace(layout, neighbours=np.zeros((0, 2), dtype=np.int64))
    contact = Processor(alone)(np.repeat([200.0, 20.0], 16))
    assert contact.markers_mm is not None and contact.markers_mm.shape == (0, 2)
    assert (contact.line, contact.shape) == (None, "edge")
    assert contact.centre_mm is not None


@pytest.mark.parametrize(
    ("values", "said"),
    [
        (np.zeros(31), r"shape \(31,\); a frame of this layout has \(32,\)"),
        (np.zeros((2, 32)), "`batch` takes several frames"),
        (5.0, r"shape \(\);"),
    ],
)
def test_values_of_another_shape_are_refused(layout: Layout, values: Any, said: str) -> None:
    with pytest.raises(ValuesError, match=said) as caught:
        Processor(layout)(values)
    assert isinstance(caught.value, LumitipError)


@pytest.mark.parametrize("shape", [(32,), (2, 31), (1, 2, 32)])
def test_a_batch_of_another_shape_is_refused(layout: Layout, shape: tuple[int, ...]) -> None:
    with pytest.raises(ValuesError, match=r"have \(n, 32\)"):
        Processor(layout).batch(np.zeros(shape))


def test_upright_lines_are_at_plus_90_degrees(make_layout: Make) -> None:
    layout = make_layout((2, 3, 2, 3, 2))
    for sign in (1.0, -1.0):
        contact = Processor(layout)(np.where(layout.x_mm * sign > 1.0, 20.0, 200.0))
        assert contact.line is not None and contact.line.angle_deg == pytest.approx(90.0)


@pytest.mark.parametrize("huge", [1e10, 1e154, 1e308, -1e308, np.inf, np.nan])
def test_values_of_no_sensor_are_left_out_without_a_word(layout: Layout, huge: float) -> None:
    values = np.where(layout.x_mm < 0.5, 30.0, 220.0)
    missing = values.copy()
    values[[3, 20]], missing[[3, 20]] = huge, np.nan
    processor = Processor(layout)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        contact, batch = processor(values), processor.batch(values[None])
        flat = processor(np.full(32, huge))
    wanted = processor(missing)
    assert contact.threshold == wanted.threshold == batch.thresholds[0]
    np.testing.assert_array_equal(contact.markers_mm, wanted.markers_mm)
    assert batch.counts[0] == len(wanted.markers_mm)
    assert flat.shape == "none"
    assert _is_empty(flat)


@pytest.mark.parametrize("values", [["a"] * 32, [[1, 2], [3]], [1j] * 32, [10**400] * 32, {}])
def test_what_is_no_number_is_refused(layout: Layout, values: Any) -> None:
    for ask in (Processor(layout), Processor(layout).batch):
        with pytest.raises(ValuesError, match="an array of numbers is needed"):
            ask(values)
