"""Hysteresis over time: when a contact begins and ends, and when its shape changes."""

from typing import Any

import numpy as np
import pytest

from lumitip import Layout
from lumitip.processing import Processor, Tracker


def _with_contrast(contrast: float) -> Any:
    values = np.full(32, 200.0)
    values[:10] -= contrast
    return values


def test_a_contact_begins_at_one_contrast_and_ends_below_another(layout: Layout) -> None:
    track = Tracker(layout, min_contrast=20.0, release_contrast=15.0)
    shapes = [track(_with_contrast(c)).shape for c in (17, 20, 17, 15, 14, 17, 20)]
    assert [s != "none" for s in shapes] == [False, True, True, True, False, False, True]
    track.reset()
    assert track(_with_contrast(17)).shape == "none"


def test_without_contact_nothing_else_is_told(layout: Layout) -> None:
    contact = Tracker(layout)(_with_contrast(17))
    assert (contact.threshold, contact.markers_mm, contact.line) == (None, None, None)
    dim = np.where(np.arange(32) < 10, np.nan, 100.0)
    dim[31] = 83.0
    assert Tracker(layout)(dim).shape == "covered"


def _corner_and_cable(layout: Layout, scene: Any) -> tuple[Any, Any]:
    """Two frames which both fits describe, one called a corner and one a cable."""
    corner = scene(layout, 1.9).corner((-1.0, -1.0), -30.0, 45.0)
    cable = scene(layout, 1.9).corner((-1.0, -1.0), -175.0, 30.0)
    for values, shape in ((corner, "corner"), (cable, "cable")):
        contact = Processor(layout)(values)
        assert contact.shape == shape
        assert contact.corner is not None and contact.cable is not None
    return corner, cable


def test_another_shape_is_told_once_it_came_often_enough(layout: Layout, scene: Any) -> None:
    corner, cable = _corner_and_cable(layout, scene)
    track = Tracker(layout, hold=3)
    frames = [corner, cable, cable, corner, cable, cable, cable, corner]
    told = [track(f).shape for f in frames]
    assert told == ["corner"] * 6 + ["cable"] * 2
    assert [Processor(layout)(f).shape for f in frames] != told


def test_a_shape_whose_fit_applies_no_more_is_left_at_once(layout: Layout, scene: Any) -> None:
    track = Tracker(layout, hold=5)
    assert track(scene(layout, 1.9).cable(0.0, 0.0, 8.0)).shape == "cable"
    assert track(scene(layout, 1.9).edge(10.0, 0.0)).shape == "edge"
    assert track(np.full(32, 250.0)).shape == "none"
    assert track(scene(layout, 1.9).cable(0.0, 0.0, 8.0)).shape == "cable"


def test_a_hold_of_one_is_no_hysteresis(layout: Layout, scene: Any) -> None:
    corner, cable = _corner_and_cable(layout, scene)
    track = Tracker(layout, hold=1)
    assert [track(f).shape for f in (corner, cable, corner)] == ["corner", "cable", "corner"]


@pytest.mark.parametrize(
    ("given", "said"),
    [({"hold": 0}, "hold is 0;"), ({"release_contrast": 21.0}, "release_contrast is 21.0;")],
)
def test_parameters_out_of_range_are_refused(
    layout: Layout, given: dict[str, Any], said: str
) -> None:
    with pytest.raises(ValueError, match=said):
        Tracker(layout, **given)
