"""The cells: the grid of `lumitip.grid`, refused where it cannot be one."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from lumitip.grid import Floats, Integers, hexagonal_grid, hexagonal_neighbours
from lumitip_fab.derive.faults import Faults
from lumitip_fab.parameters import Parameters
from lumitip_fab.wording import brief

MOST_CELLS = 4096
LEAST_WEB_MM = 0.4


@dataclass(frozen=True)
class Cells:
    """Cells in frame order, in the receiver's sensor frame; arrays of shape `(cells,)`."""

    x_mm: Floats
    y_mm: Floats
    column: Integers
    row: Integers
    neighbours: Integers
    """Pairs, shape `(pairs, 2)`."""

    def __len__(self) -> int:
        return int(self.x_mm.size)


def derive_cells(p: Parameters, faults: Faults) -> Cells:
    """The cells of the grid; none where its columns are refused."""
    columns, pitch = p.grid.columns, p.grid.pitch_mm
    uneven = _not_by_one(columns)
    if uneven:
        left, right = uneven
        faults.refuse(
            "grid.columns",
            f"{brief(columns)} given, columns {left} and {right} (of 0 to {len(columns) - 1}) have "
            f"{columns[left]} and {columns[right]} cells; neighbouring columns must differ by one",
        )
    if sum(columns) > MOST_CELLS:
        faults.refuse(
            "grid.columns", f"{sum(columns)} cells given, at most {MOST_CELLS} are allowed"
        )
    web = pitch - p.mask.hole_mm
    if web < LEAST_WEB_MM:
        faults.refuse(
            "mask.hole_mm",
            f"{p.mask.hole_mm:g} given, which leaves {web:.2f} mm of web between apertures "
            f"{pitch:g} mm apart; at least {LEAST_WEB_MM} mm is needed: "
            f"at most {max(pitch - LEAST_WEB_MM, 0):.2f} is allowed",
        )
    if uneven or sum(columns) > MOST_CELLS:
        nowhere, none = np.zeros(0), np.zeros(0, dtype=np.int64)
        return Cells(nowhere, nowhere, none, none, none.reshape(0, 2))
    grid = hexagonal_grid(columns, pitch)
    neighbours = hexagonal_neighbours(columns)
    # To a nanometre, as in `layout.json`, so that every artefact has the very same positions.
    x_mm, y_mm = (np.round(v, 6) + 0.0 for v in (grid.x_mm, grid.y_mm))
    return Cells(x_mm, y_mm, grid.column, grid.row, neighbours)


def _not_by_one(columns: Sequence[int]) -> tuple[int, int] | None:
    steps = enumerate(pairwise(columns))
    return next(((i, i + 1) for i, (a, b) in steps if abs(a - b) != 1), None)
