"""The hexagonal grid: positions, order and neighbours, for even and uneven columns."""

import math
from itertools import combinations

import numpy as np
import pytest

from lumitip.grid import column_pitch_mm, hexagonal_grid, hexagonal_neighbours

PUBLISHED = (5, 4, 5, 4, 5, 4, 5)
UNEVEN = (4, 5, 6, 5)
DENSE = (10, 9) * 6 + (10,)
GRIDS = [PUBLISHED, UNEVEN, DENSE, (1, 2), (2, 1, 2, 3, 4, 3), (1, 2, 3, 4, 5, 6, 7)]


def _at_one_pitch(columns: tuple[int, ...], pitch_mm: float) -> set[tuple[int, int]]:
    """Pairs of cells one pitch apart, by measuring every distance."""
    grid = hexagonal_grid(columns, pitch_mm)
    places = list(zip(grid.x_mm, grid.y_mm, strict=True))
    return {
        (i, j)
        for (i, a), (j, b) in combinations(enumerate(places), 2)
        if math.isclose(math.dist(a, b), pitch_mm, rel_tol=1e-9)
    }


@pytest.mark.parametrize("columns", GRIDS)
def test_neighbours_are_exactly_the_cells_one_pitch_apart(columns: tuple[int, ...]) -> None:
    pairs = hexagonal_neighbours(columns)
    assert {tuple(pair) for pair in pairs.tolist()} == _at_one_pitch(columns, 3.7)
    assert (pairs[:, 0] < pairs[:, 1]).all()
    assert pairs.tolist() == sorted(pairs.tolist())


@pytest.mark.parametrize("columns", GRIDS)
def test_no_two_cells_are_nearer_than_the_pitch(columns: tuple[int, ...]) -> None:
    grid = hexagonal_grid(columns, 2.5)
    places = np.stack([grid.x_mm, grid.y_mm], axis=1)
    apart = np.linalg.norm(places[:, None] - places[None], axis=2)[~np.eye(len(places), dtype=bool)]
    assert apart.min() == pytest.approx(2.5)


@pytest.mark.parametrize("columns", GRIDS)
def test_cells_are_ordered_by_column_from_the_left_and_row_from_the_tip(
    columns: tuple[int, ...],
) -> None:
    grid = hexagonal_grid(columns, 6.0)
    expected = [(c, r) for c, count in enumerate(columns) for r in range(count)]
    assert list(zip(grid.column.tolist(), grid.row.tolist(), strict=True)) == expected
    assert (np.diff(grid.x_mm) >= 0).all()
    same_column = np.diff(grid.column) == 0
    assert np.diff(grid.y_mm)[same_column] == pytest.approx(-6.0)


@pytest.mark.parametrize("columns", GRIDS)
def test_the_origin_is_the_mean_of_the_cells_and_columns_are_centred(
    columns: tuple[int, ...],
) -> None:
    grid = hexagonal_grid(columns, 4.0)
    assert grid.x_mm.mean() == pytest.approx(0, abs=1e-12)
    for column in range(len(columns)):
        assert grid.y_mm[grid.column == column].mean() == pytest.approx(0, abs=1e-12)


def test_an_uneven_grid_is_not_left_right_symmetric_yet_centred_on_its_cells() -> None:
    grid = hexagonal_grid(UNEVEN, 5.0)
    assert len(grid.x_mm) == 20
    assert grid.x_mm[0] == pytest.approx(-1.6 * column_pitch_mm(5.0))
    assert grid.x_mm[-1] == pytest.approx(1.4 * column_pitch_mm(5.0))


def test_a_grid_of_one_column_is_a_row_of_cells() -> None:
    grid = hexagonal_grid([3], 2.0)
    assert grid.y_mm.tolist() == [2.0, 0.0, -2.0]
    assert hexagonal_neighbours([3]).tolist() == [[0, 1], [1, 2]]
    assert hexagonal_neighbours([1]).shape == (0, 2)


@pytest.mark.parametrize(
    ("columns", "pitch_mm", "named"),
    [
        ([5, 5], 6.0, "columns"),
        ([5, 3], 6.0, "columns"),
        ([1, 0], 6.0, "columns"),
        ([], 6.0, "columns"),
        ([2, 1], 0.0, "pitch_mm"),
        ([2, 1], float("nan"), "pitch_mm"),
    ],
)
def test_what_is_no_hexagonal_grid_is_refused(
    columns: list[int], pitch_mm: float, named: str
) -> None:
    with pytest.raises(ValueError, match=rf"{named}: .* given, "):
        hexagonal_grid(columns, pitch_mm)
