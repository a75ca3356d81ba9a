"""Drilled holes are compared with those of the board in any order."""

import math

import pytest

from lumitip_fab.checks.order_layers import Holes, farthest_mm

BOARD: Holes = [(-11.945, 4.6, 0.3), (-11.945, -20.5, 0.3), (3.0, 4.6, 1.2)]


def test_the_order_of_holes_and_the_last_bit_of_a_place_do_not_matter() -> None:
    read = [(x + 4e-7, y - 4e-7, size) for x, y, size in reversed(BOARD)]
    assert farthest_mm(read, BOARD) < 1e-6


@pytest.mark.parametrize("number", range(len(BOARD)))
@pytest.mark.parametrize("change", [(0.2, 0.0, 0.0), (0.0, -0.2, 0.0), (0.0, 0.0, 0.2)])
def test_a_hole_that_is_moved_or_of_another_size_is_found(
    number: int, change: tuple[float, float, float]
) -> None:
    read = list(BOARD)
    x, y, size = (a + b for a, b in zip(read[number], change, strict=True))
    read[number] = (x, y, size)
    assert farthest_mm(read, BOARD) == pytest.approx(0.2)


def test_a_hole_drilled_twice_in_place_of_another_is_found() -> None:
    assert farthest_mm([BOARD[0], BOARD[0], BOARD[2]], BOARD) == pytest.approx(25.1)


def test_a_missing_hole_is_found() -> None:
    assert math.isnan(farthest_mm(BOARD[1:], BOARD))
    assert math.isnan(farthest_mm([], []))
