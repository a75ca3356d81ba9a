"""Apertures of groups of cells, which a search varies together.

`[vary]` has `mask.cell_holes_mm = { from, to, step, by = "ring" }`; each ring of the grid is then
an axis of its own, and a design has one size for each cell.
"""

from collections.abc import Sequence

import numpy as np

from lumitip.grid import Integers, hexagonal_grid, hexagonal_neighbours
from lumitip_fab.explore.vary import Changes

FIELD = "mask.cell_holes_mm"
BY = ("cell", "column", "ring", "row")
"""What cells of one size have in common. Rings are counted from the border."""


def groups(columns: Sequence[int], by: str) -> Integers:
    """Number of the group of each cell, from 0, shape `(cells,)`.

    Args:
        columns: cells of each column.
        by: one of `BY`.
    """
    grid = hexagonal_grid(columns, 1.0)
    if by == "ring":
        return _rings(columns)
    each = {"cell": np.arange(len(grid.column)), "column": grid.column, "row": grid.row}
    return np.asarray(each[by], np.int64)


def axis_names(columns: Sequence[int], by: str) -> tuple[str, ...]:
    """Name of the axis of each group."""
    return tuple(f"{FIELD}.{by} {n}" for n in range(int(groups(columns, by).max()) + 1))


def joined(changes: Changes, columns: Sequence[int]) -> Changes:
    """Changes of a design, with the sizes of groups as one size for each cell.

    Args:
        changes: with `axis_names` among their names, or none of them.
        columns: cells of each column of the design.
    """
    sizes = {name: value for name, value in changes if name.startswith(f"{FIELD}.")}
    if not sizes:
        return changes
    by = next(iter(sizes)).removeprefix(f"{FIELD}.").split()[0]
    own = tuple(float(sizes[f"{FIELD}.{by} {n}"]) for n in groups(columns, by))
    return (*(change for change in changes if change[0] not in sizes), (FIELD, own))


def _rings(columns: Sequence[int]) -> Integers:
    """0 for cells that lack a neighbour, 1 for those beside them, and so on."""
    pairs = hexagonal_neighbours(columns)
    count = sum(columns)
    around = np.bincount(pairs.ravel(), minlength=count)
    ring = np.where(around < 6, 0, count)
    for _ in range(count):
        one, other = pairs.T
        nearer = ring.copy()
        np.minimum.at(nearer, one, ring[other] + 1)
        np.minimum.at(nearer, other, ring[one] + 1)
        if (nearer == ring).all():
            break
        ring = nearer
    return np.asarray(ring, np.int64)
