"""Apertures of groups of cells, which a search varies together.

`[vary]` has `mask.cell_holes_mm = { from, to, step, by = "ring" }`; each ring of the grid is then
an axis of its own, and a design has one size for each cell.
"""

from collections.abc import Mapping, Sequence, Set
from typing import Any

import numpy as np

from lumitip.grid import Integers, hexagonal_grid, hexagonal_neighbours
from lumitip_fab.config.load import Input
from lumitip_fab.config.messages import brief
from lumitip_fab.errors import Problem
from lumitip_fab.explore.vary import Axis, Changes, changed, not_allowed
from lumitip_fab.solve.ranges import as_numbers_of, values_of

FIELD, HOLE = "mask.cell_holes_mm", "mask.hole_mm"
BY = ("cell", "column", "ring", "row")
"""Groups that have one size. Rings are counted from the border."""


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


def grouped(
    base: Input, spec: Mapping[str, Any], clash: Set[str]
) -> tuple[list[Axis], list[Problem]]:
    """An axis for each group of cells with apertures of one size.

    Args:
        base: the file, with its fixed values.
        spec: a range, and `by`.
        clash: fields that vary too, and must not.
    """
    values = values_of({key: of for key, of in spec.items() if key != "by"})
    texts = [f"has a size for each cell, so {field} cannot vary too" for field in sorted(clash)]
    by = str(spec.get("by", ""))
    if by not in BY:
        texts.append(f"has by = {brief(by)}; one of {', '.join(map(brief, BY))} is needed")
    if isinstance(values, str):
        texts.append(values)
    if texts or isinstance(values, str):
        return [], [Problem("", 0, FIELD, text) for text in texts]
    sizes = as_numbers_of(base, HOLE, values)
    names = axis_names(base.parameters.grid.columns, by)
    alike = changed(base, ((FIELD, ()),))
    return [Axis(name, sizes) for name in names], not_allowed(alike, Axis(HOLE, sizes))
