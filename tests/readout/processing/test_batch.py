"""A batch is what the frames give one by one."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from lumitip import Layout
from lumitip.processing import Processor, batch

Make = Callable[..., Layout]


def _frames(layout: Layout, scene: Any, count: int) -> NDArray[np.float64]:
    chance = np.random.default_rng(5)
    rows = []
    for i in range(count):
        angle_deg, offset_mm = chance.uniform(-90.0, 90.0), chance.uniform(-9.0, 9.0)
        with_blur = scene(layout, 1.9)
        rows.append(
            (
                np.full(len(layout), 250.0),
                with_blur.edge(angle_deg, offset_mm),
                with_blur.cable(angle_deg, offset_mm, 5.0),
                with_blur.corner((offset_mm, 0.0), angle_deg, 80.0),
            )[i % 4]
            + chance.normal(0.0, 2.0, len(layout))
        )
    return np.clip(rows, 0.0, 255.0)


def _compare(processor: Processor, values: NDArray[Any]) -> None:
    told = processor.batch(values)
    most = told.counts.max()
    assert told.thresholds.shape == (len(values),)
    assert told.centres_mm.shape == (len(values), 2)
    assert told.markers_mm.shape == (len(values), most, 2)
    for i, frame in enumerate(values):
        contact = processor(frame)
        if contact.threshold is None:
            assert np.isnan(told.thresholds[i]) and np.isnan(told.centres_mm[i]).all()
            assert told.counts[i] == 0 and np.isnan(told.markers_mm[i]).all()
            continue
        assert contact.markers_mm is not None
        assert told.thresholds[i] == pytest.approx(contact.threshold, rel=1e-12)
        assert told.centres_mm[i] == pytest.approx(contact.centre_mm, abs=1e-9)
        assert told.counts[i] == len(contact.markers_mm)
        held = told.markers_mm[i, : told.counts[i]]
        np.testing.assert_allclose(held, contact.markers_mm, atol=1e-9)
        assert np.isnan(told.markers_mm[i, told.counts[i] :]).all()


@pytest.mark.parametrize("columns", [(5, 4, 5, 4, 5, 4, 5), (4, 5, 6, 5), (3, 4, 5, 6, 7)])
def test_a_batch_is_what_the_frames_give_one_by_one(
    make_layout: Make, scene: Any, columns: tuple[int, ...]
) -> None:
    layout = make_layout(columns)
    values = _frames(layout, scene, 200)
    assert 140 <= np.count_nonzero(Processor(layout).batch(values).counts) <= 160
    _compare(Processor(layout), values)
    _compare(Processor(layout), values.astype(np.uint8))


def test_blocks_make_no_difference(
    layout: Layout, scene: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    values = _frames(layout, scene, 70)
    whole = Processor(layout).batch(values)
    monkeypatch.setattr(batch, "_BLOCK_VALUES", 100)
    parts = Processor(layout).batch(values)
    for name in ("thresholds", "centres_mm", "markers_mm", "counts"):
        np.testing.assert_allclose(getattr(whole, name), getattr(parts, name), rtol=1e-12)


def test_cells_that_are_not_finite_are_left_out_of_their_frame_alone(
    layout: Layout, scene: Any
) -> None:
    values = _frames(layout, scene, 80)
    chance = np.random.default_rng(6)
    for row in range(0, 80, 3):
        dead = chance.choice(32, chance.integers(1, 32), replace=False)
        values[row, dead] = chance.choice([np.nan, np.inf, -np.inf], dead.size)
    _compare(Processor(layout), values)


def test_a_batch_may_be_empty_or_a_view_of_other_order(layout: Layout, scene: Any) -> None:
    none = Processor(layout).batch(np.zeros((0, 32)))
    assert (none.thresholds.shape, none.markers_mm.shape) == ((0,), (0, 0, 2))
    values = _frames(layout, scene, 20)
    whole = Processor(layout).batch(values)
    turned = Processor(layout).batch(np.asfortranarray(values)[::-1])
    np.testing.assert_array_equal(turned.markers_mm[::-1], whole.markers_mm)


def test_the_values_given_are_left_as_they_are(layout: Layout, scene: Any) -> None:
    values = _frames(layout, scene, 20)
    values[3, 4] = np.nan
    before = values.copy()
    Processor(layout).batch(values)
    Processor(layout)(values[3])
    np.testing.assert_array_equal(values, before)
