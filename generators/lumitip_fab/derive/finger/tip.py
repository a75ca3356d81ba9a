"""The wedge on the back of the tip: its start, its edge and its angle, two of which make the third.

Side view, gripping face up:

                         start         tip edge
     ─────────────────────────────────┐ front of the plate
                                      │ edge
     back ────────────────┐ ╌╌╌╌╌╌╌ ╱─┘
     of the plate          ╲ angle ╱

The drawing in `docs/making.md` has the same names.
"""

import math

from lumitip_fab.config.automatic import AUTO
from lumitip_fab.config.load import Input
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.stack import is_flex
from lumitip_fab.derive.finger.tip_slots import derive_slots
from lumitip_fab.design import Board, Outline, Stack, Tip

START, EDGE, ANGLE = "tip.slant_start_mm", "tip.edge_mm", "tip.angle_deg"
LEAST_START_MM = 0.5  # that a parameter file allows
ANGLE_OFF_DEG = 0.05  # between a written angle and that of start and edge
_PER_MM = 1e4  # start and edge that follow are in steps of 0.0001 mm


def plate_mm(p: Parameters) -> float:
    """Thickness of the plate, with the pocket in it where it does not bend."""
    return p.stack.floor_mm + p.stack.pcb_mm * (not is_flex(p))


def wedge(config: Input) -> tuple[float, float]:
    """Start and edge of the wedge (mm). Of these two a written angle moves the one that the file
    leaves open; of both it moves the start nearer to the tip, else it leaves a thicker edge."""
    tip = config.parameters.tip
    start, edge = tip.slant_start_mm, tip.edge_mm
    if tip.angle_deg == AUTO:
        return start, edge
    plate, slope = plate_mm(config.parameters), math.tan(math.radians(float(tip.angle_deg)))
    open_edge = EDGE in config.automatic
    if START in config.automatic and slope > 0:
        run = max(_rounded_up((plate - edge) / slope), LEAST_START_MM)
        start = min(start, run) if open_edge else run
    if open_edge and start * slope < plate - edge:
        edge = _rounded_down(plate - start * slope)  # so that the start stays
    return start, edge


def derive_tip(
    config: Input, outline: Outline, board: Board, stack: Stack, faults: Diagnostics
) -> Tip:
    """The wedge, refused where it would cut into the pocket's floor, and where its angle is not
    the written one."""
    p, plate, (start, edge) = config.parameters, stack.plate_mm, wedge(config)
    written, fit = p.tip.angle_deg != AUTO, p.printer.fit_mm
    to_pocket = outline.tip_y_mm - board.pocket.y_max_mm
    # Where the fit widens the pocket, the wedge begins that much later, but at a written angle.
    room = 0.0 if written or not stack.sunk else max(fit, 0.0)
    later = min(max(start - to_pocket, 0.0), room)
    most = to_pocket if written else to_pocket + fit
    start_y = outline.tip_y_mm - start + later
    angle = math.degrees(math.atan2(plate - edge, outline.tip_y_mm - start_y))
    flat = p.tip.angle_deg == 0 and math.isclose(edge, plate)
    if stack.sunk and start > most + 1e-6 and not flat:
        if written and START in config.automatic:
            least = math.degrees(math.atan2(plate - edge, most))
            least = math.ceil(100 * least) / 100
            faults.add("wedge_in_pocket", start=start, edge=edge, least=least)
        else:
            faults.add("slant_in_pocket", to_pocket=most)
    if not flat and edge >= plate:
        faults.add("tip_edge_thick", plate=plate)
    elif written and abs(angle - float(p.tip.angle_deg)) > ANGLE_OFF_DEG:
        faults.add("tip_angle_differs", start=start, edge=edge, angle=angle, plate=plate)
    faults.unless(written or angle <= 45 + 1e-9, "wedge_steep", angle=angle, least=plate - edge)
    slope = math.tan(math.radians(angle))
    slots = derive_slots(config, outline, board, stack, (edge, slope))
    return Tip(start_y, edge, angle, slots)


def _rounded_down(value_mm: float) -> float:
    return math.floor(value_mm * _PER_MM + 1e-6) / _PER_MM


def _rounded_up(value_mm: float) -> float:
    return math.ceil(value_mm * _PER_MM - 1e-6) / _PER_MM
