"""What goes through the printed holes of screws, bolts and nuts: room round the fastener itself.

The widths that a hole was drawn with are no part of this: they are derived, and a wrong one is to
be found. Holes are as ISO 273 has them, from fine to coarse, about the axis of what goes through.
"""

from lumitip_fab.checks.printed import farthest
from lumitip_fab.checks.solids import Vectors
from lumitip_fab.design import Fastener

ROUND_MM = 0.05  # chords of a mesh, and an axis that is a little off
HEAD_MM = (0.1, 0.8)  # round a countersunk head
NUT_MM = (0.05, 0.45)  # round a nut, across flats: it goes in, and does not turn
Figures = tuple[float, float, float, str]
"""Measured clearance, least, most (mm), and what it is of."""


def round_thread(found_mm: Vectors, of: Fastener, fit_mm: float) -> Figures:
    """Clearance of a thread, less the printer's fit on both sides."""
    fine, coarse = of.hole_mm
    low, high = fine - of.thread_mm - ROUND_MM, coarse - of.thread_mm + ROUND_MM
    clear = found_mm - of.thread_mm - 2 * fit_mm
    return farthest(clear, (low + high) / 2), low, high, f"round {of.name} of {of.thread_mm:g} mm"


def round_head(found_mm: Vectors, of: Fastener) -> Figures:
    """Clearance of a countersunk head, whose countersink no fit changes."""
    clear = farthest(found_mm - of.countersunk_mm, sum(HEAD_MM) / 2)
    return clear, *HEAD_MM, f"round heads of {of.countersunk_mm:g} mm, {of.name}"


def round_nut(found_mm: Vectors, of: Fastener, fit_mm: float) -> Figures:
    """Clearance of a nut across flats, less the printer's fit on both sides."""
    clear = farthest(found_mm - of.nut_mm - 2 * fit_mm, sum(NUT_MM) / 2)
    return clear, *NUT_MM, f"round nuts of {of.nut_mm:g} mm across flats, {of.name}"
