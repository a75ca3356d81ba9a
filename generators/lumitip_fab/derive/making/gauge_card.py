"""The gauge card: its window round all cells, its frame beside them, its rails round the finger.

Where a frame has no room on the faces, or the plate bends, there is none.
"""

import math

import numpy as np

from lumitip.twin.optics import GAP_MM
from lumitip_fab.config.load import Input
from lumitip_fab.derive.finger.cells import Cells
from lumitip_fab.derive.finger.outline import BETWEEN
from lumitip_fab.derive.finger.strength import Body
from lumitip_fab.design import Box, Finger, GaugeCard, Mould, Printing, Target
from lumitip_fab.design.gauge_card import NAME

BLADE_MM = 0.8  # opaque in black, and stiff across the window
EDGE_DEG = 12.0  # across rows and columns, so that the edge passes cells at many distances
STRIP_DEG = 102.0
STRIP_SHARE = 0.5  # of the pitch: next to it cells are free
RAIL_MM = 3.0
PLATE_MM = 1.0  # of a plate's side, that rails and stop reach beyond the silicone
WALL_MM = 2.0
SIDE_PLAY_MM = 0.2
TIP_PLAY_MM = 0.1  # the card is pushed against the tip
LIGHT_MM = 2.0  # from holes to the frame, which would reflect light
SEAT_MM = 3.0  # width of the frame on a face, at least
BAR_MM = 6.0  # of the frame at the gripper end, with its letter
LETTER_SHARE = 0.6  # of that
LETTER_DEPTH_MM = 0.4
TIP_INSET_MM = 1.0  # from the corners of the tip edge, where flaps of the film overlap
LEAST_STOP_MM = 8.0


def derive_gauge_cards(
    config: Input,
    body: Body,
    fingers: tuple[Finger, Finger],
    cells: Cells,
    mould: Mould,
    printing: Printing,
) -> tuple[GaugeCard, ...]:
    """The gauge card; none of compliant fingers, and none where it has no room."""
    outline, layer = body.outline, printing.layer_mm
    _, hole = config.parameters.mask.extremes_mm
    window = _window(cells, hole / math.sqrt(3) + LIGHT_MM)
    flat = (outline.end_y_mm + mould.end_round_mm, outline.tip_y_mm - mould.taper_length_mm)
    cables_y = max(finger.window.y_max_mm for finger in fingers)
    low_y = max(window.y_min_mm - BAR_MM, flat[0], cables_y)
    sides = map(outline.half_width_at, np.linspace(low_y, window.y_max_mm, 50))
    seats = (
        min(sides) - window.x_max_mm,
        window.y_min_mm - low_y,
        flat[1] - window.y_max_mm,
    )
    skin = mould.wall_gap_mm + body.stack.film_mm + printing.fit_mm
    wall = max(WALL_MM, printing.min_wall_mm)
    half, stop_y = outline.tip_width_mm / 2 - TIP_INSET_MM, outline.tip_y_mm + skin + TIP_PLAY_MM
    gap, blade = _layers(GAP_MM, layer), _layers(BLADE_MM, layer)
    reach = max(RAIL_MM, PLATE_MM - body.stack.face_z_mm)
    letter = LETTER_SHARE * (window.y_min_mm - low_y)
    low = round(gap - blade, 6)
    pitch = config.parameters.grid.pitch_mm
    width = round(max(STRIP_SHARE * pitch, 2 * printing.min_wall_mm), 6)
    shoulder = max(outline.polygon().tolist())
    card = GaugeCard(
        name=NAME,
        gap_mm=gap,
        blade_mm=blade,
        rail_mm=round(math.ceil(reach / layer - 1e-9) * layer, 6),
        wall_mm=wall,
        rail_gap_mm=skin + SIDE_PLAY_MM,
        rail_y_max_mm=shoulder[1],
        stop=Box(-half, half, stop_y, stop_y + wall),
        window=window,
        low_y_mm=low_y,
        edge=Target("edge on the receiver", "receiver", "edge", 0.0, EDGE_DEG, 0.0, low, gap),
        strip=Target("strip on the receiver", "receiver", "strip", 0.0, STRIP_DEG, width, low, gap),
        letter_mm=letter if BETWEEN * letter >= printing.min_wall_mm else 0.0,
        letter_depth_mm=_layers(LETTER_DEPTH_MM, layer),
    )
    wide, long = 2 * (shoulder[0] + card.rail_gap_mm + wall), card.high_y_mm - low_y
    fits_bed = wide <= printing.bed_mm[0] and long <= printing.bed_mm[1]
    fits = min(seats) >= SEAT_MM and 2 * half >= LEAST_STOP_MM and fits_bed
    return (card,) if fits and not body.interfaces else ()


def _window(cells: Cells, beside_mm: float) -> Box:
    """Round the cells of both fingers, which are mirrored."""
    half = float(np.abs(cells.x_mm).max()) + beside_mm
    return Box(
        -half, half, float(cells.y_mm.min()) - beside_mm, float(cells.y_mm.max()) + beside_mm
    )


def _layers(height_mm: float, layer_mm: float) -> float:
    """The nearest height of whole layers, one at least."""
    return round(max(round(height_mm / layer_mm), 1) * layer_mm, 6)
