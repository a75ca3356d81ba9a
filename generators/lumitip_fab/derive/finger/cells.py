"""The cells of the grid, and the orientation of LEDs and photodetectors at them."""

import math
from dataclasses import dataclass

import numpy as np

from lumitip.grid import Floats, Integers, column_pitch_mm, hexagonal_grid, hexagonal_neighbours
from lumitip_fab.catalogue.electronics import Chip
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.stack import is_flex

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
        faults.add("few_cells", count=count, least_cells=LEAST_CELLS)
    if count > MOST_CELLS:
        faults.add("many_cells", count=count, most_cells=MOST_CELLS)
    if p.mask.cell_holes_mm and len(p.mask.cell_holes_mm) != count:
        faults.add("cell_holes", holes=len(p.mask.cell_holes_mm), count=count)
    else:
        _refuse_close_apertures(p, faults)
    if not LEAST_CELLS <= count <= MOST_CELLS:
        nowhere, none = np.zeros(0), np.zeros(0, dtype=np.int64)
        return Cells(nowhere, nowhere, none, none, none.reshape(0, 2))
    grid = hexagonal_grid(columns, pitch)
    neighbours = hexagonal_neighbours(columns)
    # To a nanometre, as in `layout.json`, so that every artefact has the very same positions.
    x_mm, y_mm = (np.round(v, 6) + 0.0 for v in (grid.x_mm, grid.y_mm))
    return Cells(x_mm, y_mm, grid.column, grid.row, neighbours)


def least_web_mm(p: Parameters) -> float:
    """The narrowest web between the apertures of neighbouring cells."""
    sizes, pairs = p.mask.holes_mm(sum(p.grid.columns)), hexagonal_neighbours(p.grid.columns)
    apart = [p.grid.pitch_mm - (sizes[a] + sizes[b]) / 2.0 for a, b in pairs.tolist()]
    return min(apart, default=p.grid.pitch_mm)


def holes_meet(p: Parameters) -> bool:
    """Whether apertures of cells that are no neighbours come too close, by the circles round them:
    between small ones, two wide ones may."""
    grid = hexagonal_grid(p.grid.columns, p.grid.pitch_mm)
    centres = np.stack([grid.x_mm, grid.y_mm])
    apart = np.linalg.norm(centres[:, :, None] - centres[:, None], axis=0)
    round_ = p.mask.hole_shape == "circle" or p.mask.route == "cut"
    reach = np.array(p.mask.holes_mm(sum(p.grid.columns))) / (2.0 if round_ else math.sqrt(3.0))
    near = apart - reach - reach[:, None] < LEAST_WEB_MM
    return bool((near & (apart > 1.1 * p.grid.pitch_mm)).any())


def _refuse_close_apertures(p: Parameters, faults: Diagnostics) -> None:
    web = least_web_mm(p)
    if web >= LEAST_WEB_MM:
        if p.mask.cell_holes_mm and holes_meet(p):
            faults.add("apertures_meet", least_web_mm=LEAST_WEB_MM)
        return
    pitch = p.grid.pitch_mm
    faults.add(
        "apertures_close",
        p.mask.holes_field,
        holes=p.mask.holes_text,
        web=web,
        pitch=pitch,
        least_web_mm=LEAST_WEB_MM,
        most=max(pitch - LEAST_WEB_MM, 0),
        mean=p.mask.mean_text,
    )


GROUND_LINES = 1
BENDING_LANE_USE = 0.9
"""Share of the lane between two columns that tracks can fill where a board bends."""


def bending_lines(p: Parameters) -> int:
    """Tracks beside a column where a board bends: those of its cells, and ground.

    There are no vias, so they share the front with the cells. None on a rigid board, and none
    beside a column alone, which has the margins of the board.
    """
    columns = p.grid.columns
    return max(columns) + GROUND_LINES if is_flex(p) and len(columns) > 1 else 0


def lane_mm(p: Parameters, detector: Chip) -> float:
    """Width between two columns of detectors that are turned along them."""
    return column_pitch_mm(p.grid.pitch_mm) - min(detector.over_pads_mm)


def refuse_lines(p: Parameters, detector: Chip, faults: Diagnostics) -> None:
    """Refuse columns whose tracks have no room beside them on the front of a flexible board."""
    lines, lane = bending_lines(p), lane_mm(p, detector)
    step = p.board.track_mm + p.board.copper_gap_mm
    if not lines or lines * step <= BENDING_LANE_USE * lane:
        return
    most = max(math.floor(BENDING_LANE_USE * lane / step) - GROUND_LINES, 0)
    least_mm = (lines * step / BENDING_LANE_USE + min(detector.over_pads_mm)) * 2 / math.sqrt(3)
    faults.add(
        "column_lines",
        most=most,
        least=math.ceil(least_mm * 100 - 1e-06) / 100,
        cells=max(p.grid.columns),
    )


TRACK_SPACE_MM = 1.5  # between columns, for tracks; with less, parts are turned along y


def derive_turned(
    p: Parameters, field: str, name: str, chip: Chip, lines: int, faults: Diagnostics
) -> bool:
    """Whether parts are turned along y; refused where they fit neither way.

    Pad patterns keep a straight lane between columns and between rows, so that tracks pass: room
    for `lines` of them on one side, from `bending_lines`.
    """
    along, across = chip.over_pads_mm
    pitch, columns = p.grid.pitch_mm, column_pitch_mm(p.grid.pitch_mm)
    gap = p.board.clearance_mm
    flat = columns >= along + gap and pitch >= across + gap
    turned = columns >= across + gap and pitch >= along + gap
    if not (flat or turned):
        least = max(along + gap, (across + gap) * pitch / columns)
        faults.add(
            "pitch_small",
            field=field,
            name=name,
            along=along,
            across=across,
            gap=gap,
            least=least,
            pitch=pitch,
        )
    space = max(TRACK_SPACE_MM, lines * (p.board.track_mm + p.board.copper_gap_mm))
    roomy = columns >= along + space
    return turned and not (flat and roomy)
