"""The hexagonal grid: positions, order and neighbours, for columns of any lengths."""

import math
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumitip.grid import collinear, column_pitch_mm, hexagonal_grid, hexagonal_neighbours

PUBLISHED = (5, 4, 5, 4, 5, 4, 5)
UNEVEN = (4, 5, 6, 5)
DENSE = (10, 9) * 6 + (10,)
CENTRED = [PUBLISHED, UNEVEN, DENSE, (1, 2), (2, 1, 2, 3, 4, 3), (1, 4, 1), (5, 2, 5), (7,)]
GRIDS = [*CENTRED, (4, 4, 4, 4), (3, 3), (1, 1, 1), (5, 4, 5, 5), (2, 9, 9, 1)]
COLUMNS = st.lists(st.integers(1, 12), min_size=1, max_size=12)


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


@pytest.mark.parametrize("columns", CENTRED)
def test_where_the_lattice_allows_it_every_column_is_centred(columns: tuple[int, ...]) -> None:
    grid = hexagonal_grid(columns, 4.0)
    assert grid.x_mm.mean() == pytest.approx(0, abs=1e-12)
    for column in range(len(columns)):
        assert grid.y_mm[grid.column == column].mean() == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize(
    ("columns", "shifts"),
    [
        ((4, 4, 4, 4), (1, -1, 1, -1)),
        ((3, 3), (1, -1)),
        ((1, 1, 1), (1, -1, 1)),
        ((5, 4, 5, 5), (1, 1, 1, -1)),
        ((2, 4), (1, -1)),
    ],
)
def test_columns_that_cannot_all_be_centred_are_a_quarter_of_the_pitch_off(
    columns: tuple[int, ...], shifts: tuple[int, ...]
) -> None:
    grid = hexagonal_grid(columns, 8.0)
    assert grid.x_mm.mean() == pytest.approx(0, abs=1e-12)
    found = [grid.y_mm[grid.column == c].mean() / 2.0 for c in range(len(columns))]
    assert found == list(shifts)


@given(COLUMNS)
def test_any_columns_make_one_connected_patch_of_a_hexagonal_lattice(columns: list[int]) -> None:
    """Each place is a whole number of steps along two directions of one lattice."""
    grid = hexagonal_grid(columns, 2.0)
    x_mm, y_mm = grid.x_mm - grid.x_mm[0], grid.y_mm - grid.y_mm[0]
    along = x_mm / column_pitch_mm(2.0)
    up = y_mm / 2.0 - along / 2.0
    steps = np.stack([along, up], axis=1)
    assert np.abs(steps - np.round(steps)).max() < 1e-9
    assert len({(a, b) for a, b in np.round(steps).tolist()}) == sum(columns)
    reached, edge = {0}, [0]
    near: dict[int, list[int]] = {i: [] for i in range(sum(columns))}
    for a, b in hexagonal_neighbours(columns).tolist():
        near[a].append(b)
        near[b].append(a)
    while edge:
        new = set(near[edge.pop()]) - reached
        reached |= new
        edge += new
    assert len(reached) == sum(columns)


@given(COLUMNS)
def test_no_column_is_farther_off_than_another_lattice_would_have_it(columns: list[int]) -> None:
    """Of all lattices, whatever their phase, none has a smaller largest shift."""
    grid = hexagonal_grid(columns, 1.0)
    shifts = [grid.y_mm[grid.column == c].mean() for c in range(len(columns))]
    largest = max(map(abs, shifts))

    def shifted(column: int, phase: float) -> float:
        off = (phase + column / 2.0 - (columns[column] - 1) / 2.0) % 1.0
        return min(off, 1.0 - off)

    least = min(
        max(shifted(c, phase) for c in range(len(columns))) for phase in np.arange(0.0, 1.0, 0.05)
    )
    assert largest <= least + 1e-9


@settings(deadline=None)
@given(COLUMNS, st.floats(1.5, 30.0))
def test_neighbours_of_any_columns_are_the_cells_one_pitch_apart(
    columns: list[int], pitch_mm: float
) -> None:
    pairs = [tuple(pair) for pair in hexagonal_neighbours(columns).tolist()]
    assert len(set(pairs)) == len(pairs)
    assert set(pairs) == _at_one_pitch(tuple(columns), pitch_mm)


def test_the_cells_of_the_published_sensor_are_where_they_were() -> None:
    """To the last bit: their places are in `design_hash`, and so in firmware and recordings."""
    grid = hexagonal_grid(PUBLISHED, 6.0)
    heights = [(5 - 1) / 2 - r for r in range(5)], [(4 - 1) / 2 - r for r in range(4)]
    wanted = [y * 6.0 for column in range(7) for y in heights[column % 2]]
    assert grid.y_mm.tolist() == wanted
    column = np.repeat(np.arange(7), PUBLISHED)
    assert grid.x_mm.tolist() == ((column - column.mean()) * (6.0 * np.sqrt(3.0) / 2.0)).tolist()


@pytest.mark.parametrize(
    ("places", "in_line"),
    [
        ([(0.0, 3.0), (0.0, 0.0), (0.0, -3.0)], True),
        ([(5.0, 1.0)], True),
        ([(0.0, 0.0), (1.0, 2.0), (2.0, 4.0)], True),
        ([(0.0, 0.0), (1.0, 2.0), (2.0, 4.1)], False),
    ],
)
def test_cells_in_one_line(places: list[tuple[float, float]], in_line: bool) -> None:
    x_mm, y_mm = np.array(places).T
    assert collinear(x_mm, y_mm) is in_line


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
        ([5, -3], 6.0, "columns"),
        ([5.0, 4.0], 6.0, "columns"),
        ([1, 0], 6.0, "columns"),
        ([], 6.0, "columns"),
        ([2, 1], 0.0, "pitch_mm"),
        ([2, 1], float("nan"), "pitch_mm"),
    ],
)
def test_what_is_no_hexagonal_grid_is_refused(
    columns: list[int], pitch_mm: float, named: str
) -> None:
    with pytest.raises(ValueError, match=rf"{named} is .*; "):
        hexagonal_grid(columns, pitch_mm)
