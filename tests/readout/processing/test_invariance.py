"""What must not matter, does not: scale, place, order and orientation."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from lumitip import Layout
from lumitip.processing import Contact, Processor

Make = Callable[..., Layout]
QUICK = settings(max_examples=40, deadline=None)
seeds = st.integers(0, 2**32 - 1)


def _border(layout: Layout, seed: int) -> NDArray[np.float64]:
    """A soft border, strip or wedge with noise, of no particular pose."""
    chance = np.random.default_rng(seed)
    x, y = layout.x_mm, layout.y_mm
    level = [
        np.cos(a) * y - np.sin(a) * x - chance.uniform(-4.0, 4.0)
        for a in chance.uniform(0.0, 2.0 * np.pi, chance.integers(1, 3))
    ]
    values = 128.0 + 110.0 * np.tanh(np.max(level, axis=0) / 3.0) + chance.normal(0.0, 2.0, x.size)
    contrast = Processor(layout)(values).contrast
    assume(contrast is not None and contrast > 80.0)
    return values


def _same(contact: Contact, other: Contact, turn_deg: float = 0.0, scale: float = 1.0) -> None:
    assert contact.shape == other.shape
    for name in ("line", "corner", "cable"):
        one, two = getattr(contact, name), getattr(other, name)
        assert (one is None) == (two is None)
        if one is None:
            continue
        assert one.rms_mm * scale == pytest.approx(two.rms_mm, abs=1e-6)
        if name != "corner":
            turn = two.angle_deg - one.angle_deg - turn_deg
            assert (turn + 90.0) % 180.0 - 90.0 == pytest.approx(0.0, abs=1e-6)
        else:
            assert one.opening_deg == pytest.approx(two.opening_deg, abs=1e-6)


@pytest.fixture(scope="module")
def published(make_layout: Make) -> Layout:
    return make_layout()


@QUICK
@given(seed=seeds, gain=st.floats(0.5, 2.0), shift=st.floats(-50.0, 50.0))
@example(seed=1092666, gain=1.46875, shift=0.0)  # two gaps between markers are equally wide
def test_gain_and_offset_of_the_values_move_no_marker(
    published: Layout, seed: int, gain: float, shift: float
) -> None:
    values = _border(published, seed)
    processor = Processor(published)
    one, other = processor(values), processor(gain * values + shift)
    assert one.markers_mm is not None and other.markers_mm is not None
    np.testing.assert_allclose(one.markers_mm, other.markers_mm, atol=1e-9)
    _same(one, other)


@QUICK
@given(seed=seeds)
def test_light_and_dark_swapped_give_the_same_border(published: Layout, seed: int) -> None:
    values = _border(published, seed)
    processor = Processor(published)
    one, other = processor(values), processor(255.0 - values)
    assert one.markers_mm is not None and other.markers_mm is not None
    np.testing.assert_allclose(one.markers_mm, other.markers_mm, atol=1e-9)
    assert (one.line is None) == (other.line is None)
    if one.line is not None and other.line is not None:
        assert one.line.angle_deg == pytest.approx(other.line.angle_deg)


@QUICK
@given(seed=seeds, turn_deg=st.floats(-180.0, 180.0))
def test_a_turned_grid_turns_the_contact(published: Layout, seed: int, turn_deg: float) -> None:
    turn = np.radians(turn_deg)
    x, y = published.x_mm, published.y_mm
    turned = replace(
        published,
        x_mm=x * np.cos(turn) - y * np.sin(turn),
        y_mm=x * np.sin(turn) + y * np.cos(turn),
    )
    values = _border(published, seed)
    one, other = Processor(published)(values), Processor(turned)(values)
    assert one.line is not None and other.line is not None
    turned_by = other.line.angle_deg - one.line.angle_deg - turn_deg
    assert (turned_by + 90.0) % 180.0 - 90.0 == pytest.approx(0.0, abs=1e-6)
    assert one.line.rms_mm == pytest.approx(other.line.rms_mm, abs=1e-6)
    if one.cable is not None and other.cable is not None:
        assert one.cable.width_mm == pytest.approx(other.cable.width_mm)


@QUICK
@given(seed=seeds, scale=st.floats(0.2, 5.0))
def test_a_larger_grid_enlarges_the_contact(published: Layout, seed: int, scale: float) -> None:
    larger = replace(
        published,
        x_mm=published.x_mm * scale,
        y_mm=published.y_mm * scale,
        pitch_mm=published.pitch_mm * scale,
    )
    values = _border(published, seed)
    one, other = Processor(published)(values), Processor(larger)(values)
    assert one.centre_mm is not None and other.centre_mm is not None
    assert np.multiply(one.centre_mm, scale) == pytest.approx(np.array(other.centre_mm))
    _same(one, other, scale=scale)


@QUICK
@given(seed=seeds)
def test_the_order_of_the_cells_does_not_matter(published: Layout, seed: int) -> None:
    order = np.random.default_rng(seed).permutation(32)
    place = np.argsort(order)
    names = ("x_mm", "y_mm", "column", "row", "mux", "channel", "adc_pin")
    pairs = np.sort(place[published.neighbours], axis=1)
    mixed = replace(published, neighbours=pairs, **{n: getattr(published, n)[order] for n in names})
    values = _border(published, seed)
    one, other = Processor(published)(values), Processor(mixed)(values[order])
    assert one.threshold == pytest.approx(other.threshold)
    assert one.centre_mm == pytest.approx(other.centre_mm)
    _same(one, other)


odd = st.sampled_from([np.nan, np.inf, -np.inf, 0.0, 255.0])
numbers = st.lists(st.one_of(odd, st.floats(-1e6, 1e6)), min_size=32, max_size=32)


@QUICK
@given(values=numbers)
def test_any_numbers_give_a_contact(published: Layout, values: list[float]) -> None:
    contact = Processor(published)(values)
    assert contact.shape in ("none", "edge", "corner", "cable", "covered")
    touched = contact.shape not in ("none", "covered")
    assert (contact.threshold is not None) == touched
    if contact.line is not None:
        assert -90.0 < contact.line.angle_deg <= 90.0
        assert np.isfinite([contact.line.rms_mm, *contact.line.point_mm]).all()
    if contact.centre_mm is not None:
        inside = np.hypot(published.x_mm, published.y_mm).max() + 1e-9
        assert np.hypot(*contact.centre_mm) <= inside
