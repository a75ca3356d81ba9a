"""The print on the film, and whether a page takes it."""

from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.boards import Plan
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.cells import LEAST_WEB_MM
from lumitip_fab.design import Box, Mask, Outline

PAGE_MM = (210.0, 279.4)  # what A4 and US Letter have in common
PAGE_MARGIN_MM = 8.0  # most printers reach 5 mm from the edge; registration marks reach 2 mm out
BESIDE_MM = 15.0  # the upright ruler with its figures, left and, for balance, right
ABOVE_AND_BELOW_MM = 50.0  # heading, level ruler and notes
RULER_MM = 110.0  # 100 mm with its figures
LEAST_REACH_MM = 2.0  # of a flap onto the back, to hold there
MARK_SHARE = (0.42, 0.72)  # of the tip flap's length: clear of its black band and of the name
MARK_MM = 4.0
MARK_INSET_MM = 0.5  # from the tip flap's side
FLAP_TAPER = 0.18  # of the tip flap's side: a little over 10°


def derive_mask(config: Input, outline: Outline, plan: Plan, faults: Diagnostics) -> Mask:
    """The mask, refused where apertures meet the connector's window or the page is too small."""
    p = config.parameters
    film = config.parts.mask.film
    lowest = min(y for _, y in plan.receiver.cells) - p.mask.hole_mm / 2
    window = max(plan.receiver.window.y_max_mm, plan.emitter.window.y_max_mm)
    faults.refuse_unless(
        lowest - window >= LEAST_WEB_MM,
        "mask.hole_mm",
        f"is {p.mask.hole_mm:g}, which leaves {lowest - window:.2f} mm between the last "
        f"row and the connector's window; at least {LEAST_WEB_MM} mm is needed",
    )
    side = p.stack.floor_mm + p.stack.pcb_mm + p.stack.silicone_mm
    reach = p.mask.flap_mm + p.mask.allowance_mm - side
    faults.refuse_unless(
        reach >= LEAST_REACH_MM,
        "mask.flap_mm",
        f"is {p.mask.flap_mm:g}, which reaches {max(reach, 0):.2f} mm onto the back of a finger "
        f"{side:g} mm thick; at least {side - p.mask.allowance_mm + LEAST_REACH_MM:.2f} is needed",
    )
    sheet = _sheet(outline, p.mask.allowance_mm + p.mask.flap_mm)
    needed = (
        max(sheet.width_mm + 2 * BESIDE_MM, RULER_MM),
        max(sheet.length_mm, RULER_MM) + ABOVE_AND_BELOW_MM,
    )
    page = tuple(
        side * 100 / measured + 2 * PAGE_MARGIN_MM
        for side, measured in zip(needed, p.mask.measured_ruler_mm, strict=True)
    )
    faults.refuse_unless(
        page[0] <= PAGE_MM[0] and page[1] <= PAGE_MM[1],
        "mask.flap_mm",
        f"is {p.mask.flap_mm:g}; the mask of this finger with its rulers needs a page of "
        f"{page[0]:.0f} x {page[1]:.0f} mm; A4 and US Letter have {PAGE_MM[0]:.0f} x "
        f"{PAGE_MM[1]:.0f} mm",
    )
    return Mask(
        hole_mm=p.mask.hole_mm,
        hole_shape=p.mask.hole_shape,
        allowance_mm=p.mask.allowance_mm,
        flap_mm=p.mask.flap_mm,
        film=config.title("mask.film"),
        soften_c=film.soften_c,
        measured_ruler_mm=p.mask.measured_ruler_mm,
        registration=tuple(
            (x, y)
            for y in (sheet.y_max_mm, sheet.y_min_mm)
            for x in (sheet.x_min_mm, sheet.x_max_mm)
        ),
        mark=_mark(outline, p.mask.allowance_mm, p.mask.flap_mm),
    )


def _sheet(outline: Outline, around_mm: float) -> Box:
    """The film that is needed: the outline with its flaps. Its corners are always free."""
    half = float(abs(outline.polygon()[:, 0]).max())
    return Box(-half, half, outline.end_y_mm, outline.tip_y_mm).grown(around_mm)


def _mark(outline: Outline, allowance_mm: float, flap_mm: float) -> Box:
    """On the tip flap, left of the middle, so that its place also distinguishes left from right."""
    fold = outline.tip_y_mm + allowance_mm
    bottom, top = (fold + share * flap_mm for share in MARK_SHARE)
    height = min(top - bottom, MARK_MM)
    half = outline.tip_width_mm / 2
    left = -max(half - MARK_INSET_MM - FLAP_TAPER * flap_mm, half / 2)
    return Box(left, left + 0.7 * height, bottom, bottom + height)
