"""The order of a mask's flaps, at a gripper end with two flaps and with six."""

import numpy as np
import pytest

from lumitip_fab.checks.mask import measure_numbers
from lumitip_fab.checks.mask_flaps import Flap

TIP = (-20.0, 20.0, 90.0)


def _flap(x_from: float, x_to: float, y: float) -> Flap:
    fold = np.array([[x_from, y], [x_to, y]])
    return Flap(fold, np.concatenate([fold, fold[::-1] - (0.0, 10.0)]))


def _flaps(pairs: list[tuple[float, float, float]]) -> tuple[Flap, ...]:
    """The tip, then pairs from the left: from x to x, at y."""
    found = [_flap(*TIP)]
    for x_from, x_to, y in pairs:
        found += [_flap(x_from, x_to, y), _flap(-x_to, -x_from, y)]
    return tuple(found)


# The two beside the connector, further out at the same height but for rounding, and the sides.
WIDE = [(-20.0, -5.0, 0.0), (-35.0, -20.0, -1e-9), (-49.0, -35.0, 1e-9), (-58.0, -50.0, 30.0)]


@pytest.mark.parametrize("pairs", [WIDE, WIDE[:1], [WIDE[0], WIDE[3]]])
def test_flaps_at_the_gripper_end_are_level(pairs: list[tuple[float, float, float]]) -> None:
    flaps = _flaps(pairs)
    order = tuple(range(1, len(flaps) + 1))
    assert measure_numbers("mask", flaps, order).passed


@pytest.mark.parametrize(
    ("numbers", "wrong"),
    [
        ((1, 8, 9, 4, 5, 6, 7, 2, 3), 3),  # a side before the end, and a narrow flap before wide
        ((2, 1, 3, 4, 5, 6, 7, 8, 9), 3),
        ((1, 3, 2, 4, 5, 6, 7, 9, 8), 0),  # either side may be first
        ((1, 2, 3, 4, 6, 5, 7, 8, 9), 3),  # pairs torn apart, one wider than the last
        ((1, 2, 3, 4, 5, 6, 7, 8, 8), 1),
    ],
)
def test_flaps_out_of_order_are_counted(numbers: tuple[int, ...], wrong: int) -> None:
    measured = measure_numbers("mask", _flaps(WIDE), numbers)
    assert (measured.measured, measured.passed) == (wrong, not wrong)
