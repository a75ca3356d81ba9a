"""The mask, and whether page, printer and plotter make it."""

from collections.abc import Sequence

from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.boards import Plan
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.cells import LEAST_WEB_MM
from lumitip_fab.design import Box, Mask, Outline, Point, Sheet
from lumitip_fab.design.making import FOLD_OFF_MM

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
STROKE = 0.17  # of a letter's height
LEAST_SHEET_MM = 0.2
"""A printed sheet, one layer of the usual height: a thinner one tears as it leaves the bed."""
FOLD_LINES = 2  # width of a sheet's groove: the print is closed beside it, and it bends by 90°


def derive_mask(config: Input, outline: Outline, plan: Plan, faults: Diagnostics) -> Mask:
    """The mask, refused where apertures meet the connector's window or the page is too small."""
    p = config.parameters
    film = config.parts.mask.film
    opaque = p.mask.route == "cut"
    faults.refuse_unless(
        p.mask.route == "tpu" or film.opaque == opaque,
        "mask.film",
        f"is {p.mask.film!r}, which is {'opaque' if film.opaque else 'clear'}; with mask.route = "
        f"{p.mask.route!r} {'an opaque' if opaque else 'a clear'} film is needed: "
        f"{', '.join(n for n, f in config.catalogue.films.items() if f.opaque == opaque)}",
    )
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
    mark = _mark(outline, p.mask.allowance_mm, p.mask.flap_mm)
    printed = _sheet_of(config, mark)
    if p.mask.route == "tpu":
        _refuse_sheet(config, printed, lowest - window, sheet, faults)
    return Mask(
        route=p.mask.route,
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
        mark=mark,
        sheet=printed,
        coupon=_coupon(plan.receiver.cells, p.grid.pitch_mm),
    )


def _sheet_of(config: Input, mark: Box) -> Sheet:
    mask, printer = config.parameters.mask, config.parts.printer.profile
    return Sheet(
        filament=config.title("mask.filament"),
        layers=mask.layers,
        layer_mm=printer.layer_mm,
        line_mm=printer.line_mm,
        hole_mm=round(mask.hole_mm + config.parts.mask.filament.hole_loss_mm, 6),
        fold_mm=round(FOLD_LINES * printer.line_mm, 6) if mask.layers > 1 else 0.0,
        letter=mask.layers > 1 and STROKE * mark.length_mm >= printer.line_mm,
    )


def _refuse_sheet(
    config: Input, printed: Sheet, to_window_mm: float, around: Box, faults: Diagnostics
) -> None:
    """Refuse a printed sheet with webs or holes narrower than a line, one that is larger than the
    bed, and a filament that does not bend."""
    p, line, bed = config.parameters, printed.line_mm, config.parts.printer.profile.bed_mm
    loss = printed.hole_mm - p.mask.hole_mm
    web = min(p.grid.pitch_mm - p.mask.hole_mm, to_window_mm + loss / 2) - loss
    faults.refuse_unless(
        web >= line - 1e-9,
        "mask.hole_mm",
        f"is {p.mask.hole_mm:g}, drawn as {printed.hole_mm:g}, which leaves webs of {web:.2f} mm "
        f"in the printed sheet; at least one printed line of {line:g} is needed, so at most "
        f"{max(p.mask.hole_mm - line + web, 0):.2f} is allowed",
    )
    faults.refuse_unless(
        p.mask.hole_mm >= line - 1e-9,
        "mask.hole_mm",
        f"is {p.mask.hole_mm:g}; at least one printed line of {line:g} is needed, or the holes of "
        "the printed sheet close",
    )
    faults.refuse_unless(
        printed.thickness_mm >= LEAST_SHEET_MM - 1e-9,
        "mask.layers",
        f"is {printed.layers}; a layer of {p.printer.profile!r} is {printed.layer_mm:g} mm, and a "
        f"printed sheet of {printed.thickness_mm:g} mm tears; at least {LEAST_SHEET_MM:g} mm is "
        "needed",
    )
    # A flap turns about the middle of the layer that the groove leaves.
    inside = printed.thickness_mm - printed.layer_mm / 2
    faults.refuse_unless(
        p.mask.allowance_mm >= inside + FOLD_OFF_MM - 1e-9,
        "mask.allowance_mm",
        f"is {p.mask.allowance_mm:g}; folded, a sheet of {printed.thickness_mm:g} mm reaches "
        f"{inside:g} mm inside its fold, and folds lie up to {FOLD_OFF_MM:g} mm off the outline: "
        f"at least {inside + FOLD_OFF_MM:.2f} is needed, or the flaps do not close",
    )
    faults.refuse_unless(
        around.width_mm <= bed[0] and around.length_mm <= bed[1],
        "printer.profile",
        f"is {p.printer.profile!r}, with a bed of {bed[0]:g} x {bed[1]:g} mm; a mask of "
        f"{around.width_mm:.0f} x {around.length_mm:.0f} mm does not fit",
    )
    faults.refuse_unless(
        config.parts.mask.filament.rigid_parts is not None,
        "mask.filament",
        f"is {p.mask.filament!r}, which does not bend; a filament with rigid_parts in "
        "parts/filaments.toml is needed",
    )


def _sheet(outline: Outline, around_mm: float) -> Box:
    """The film that is needed: the outline with its flaps. Its corners are always free."""
    half = float(abs(outline.polygon()[:, 0]).max())
    return Box(-half, half, outline.end_y_mm, outline.tip_y_mm).grown(around_mm)


def _coupon(cells: Sequence[Point], pitch_mm: float) -> Box:
    """All cells, and a pitch more on each side: their light comes through nothing else."""
    xs, ys = zip(*cells, strict=True)
    return Box(min(xs), max(xs), min(ys), max(ys)).grown(pitch_mm)


def _mark(outline: Outline, allowance_mm: float, flap_mm: float) -> Box:
    """On the tip flap, left of the middle, so that its place also distinguishes left from right."""
    fold = outline.tip_y_mm + allowance_mm
    bottom, top = (fold + share * flap_mm for share in MARK_SHARE)
    height = min(top - bottom, MARK_MM)
    half = outline.tip_width_mm / 2
    left = -max(half - MARK_INSET_MM - FLAP_TAPER * flap_mm, half / 2)
    return Box(left, left + 0.7 * height, bottom, bottom + height)
