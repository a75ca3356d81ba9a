"""The cells: the grid of `lumitip.grid`, refused where it has too few cells or too many."""

from dataclasses import dataclass

import numpy as np

from lumitip.grid import Floats, Integers, hexagonal_grid, hexagonal_neighbours
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.derive.faults import Faults

LEAST_CELLS = 3
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
    """The cells of the grid; none where there are too few or too many."""
    columns, pitch = p.grid.columns, p.grid.pitch_mm
    count = sum(columns)
    if count < LEAST_CELLS:
        faults.refuse("grid.columns", f"has {count} cells; at least {LEAST_CELLS} are needed")
    if count > MOST_CELLS:
        faults.refuse("grid.columns", f"has {count} cells; at most {MOST_CELLS} are allowed")
    web = pitch - p.mask.hole_mm
    if web < LEAST_WEB_MM:
        faults.refuse(
            "mask.hole_mm",
            f"is {p.mask.hole_mm:g}, which leaves {web:.2f} mm between apertures "
            f"{pitch:g} mm apart; at least {LEAST_WEB_MM} mm is needed, "
            f"so at most {max(pitch - LEAST_WEB_MM, 0):.2f} is allowed",
        )
    if not LEAST_CELLS <= count <= MOST_CELLS:
        nowhere, none = np.zeros(0), np.zeros(0, dtype=np.int64)
        return Cells(nowhere, nowhere, none, none, none.reshape(0, 2))
    grid = hexagonal_grid(columns, pitch)
    neighbours = hexagonal_neighbours(columns)
    # To a nanometre, as in `layout.json`, so that every artefact has the very same positions.
    x_mm, y_mm = (np.round(v, 6) + 0.0 for v in (grid.x_mm, grid.y_mm))
    return Cells(x_mm, y_mm, grid.column, grid.row, neighbours)
