"""The cells of the grid, and the orientation of LEDs and photodetectors at them."""

from dataclasses import dataclass

import numpy as np

from lumitip.grid import Floats, Integers, column_pitch_mm, hexagonal_grid, hexagonal_neighbours
from lumitip_fab.catalogue.electronics import Chip
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.derive.diagnostics import Diagnostics

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


def derive_cells(p: Parameters, faults: Diagnostics) -> Cells:
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


TRACK_SPACE_MM = 1.5  # between columns, for tracks; with less, parts are turned along y


def derive_turned(p: Parameters, field: str, name: str, chip: Chip, faults: Diagnostics) -> bool:
    """Whether parts are turned along y; refused where they fit neither way.

    Pad patterns keep a straight lane between columns and between rows, so that tracks pass.
    """
    along, across = chip.over_pads_mm
    pitch, columns = p.grid.pitch_mm, column_pitch_mm(p.grid.pitch_mm)
    gap = p.board.clearance_mm
    flat = columns >= along + gap and pitch >= across + gap
    turned = columns >= across + gap and pitch >= along + gap
    if not (flat or turned):
        least = max(along + gap, (across + gap) * pitch / columns)
        faults.refuse(
            field,
            f"is {name!r}, {along:g} mm over its pads and {across:g} mm wide; with "
            f"{gap:g} mm of clearance it needs a pitch of at least {least:.2f} mm, but "
            f"grid.pitch_mm is {pitch:g}",
        )
    roomy = columns >= along + TRACK_SPACE_MM
    return turned and not (flat and roomy)
