"""The mask, and whether page, printer and plotter make it."""

from collections.abc import Sequence

from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.boards import Plan
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.cells import LEAST_WEB_MM, least_web_mm
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
    faults.unless(
        p.mask.route == "tpu" or film.opaque == opaque,
        "film_kind",
        kind="opaque" if film.opaque else "clear",
        needed="an opaque" if opaque else "a clear",
        films=", ".join((n for n, f in config.catalogue.films.items() if f.opaque == opaque)),
    )
    holes = p.mask.holes_mm(len(plan.receiver.cells))
    lowest = min(y - hole / 2 for (_, y), hole in zip(plan.receiver.cells, holes, strict=True))
    window = max(plan.receiver.window.y_max_mm, plan.emitter.window.y_max_mm)
    faults.unless(
        lowest - window >= LEAST_WEB_MM,
        "aperture_near_window",
        p.mask.holes_field,
        holes=p.mask.holes_text,
        least_web_mm=LEAST_WEB_MM,
        web_mm=lowest - window,
    )
    side = p.stack.floor_mm + p.stack.pcb_mm + p.stack.silicone_mm
    reach = p.mask.flap_mm + p.mask.allowance_mm - side
    faults.unless(
        reach >= LEAST_REACH_MM,
        "flap_short",
        side=side,
        least=side - p.mask.allowance_mm + LEAST_REACH_MM,
        reach_mm=max(reach, 0),
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
    faults.unless(
        page[0] <= PAGE_MM[0] and page[1] <= PAGE_MM[1],
        "page_small",
        wide_mm=page[0],
        long_mm=page[1],
        page_x=PAGE_MM[0],
        page_y=PAGE_MM[1],
    )
    mark = _mark(outline, p.mask.allowance_mm, p.mask.flap_mm)
    printed = _sheet_of(config, mark)
    if p.mask.route == "tpu":
        _refuse_sheet(config, printed, lowest - window, sheet, faults)
    return Mask(
        route=p.mask.route,
        holes_mm=holes,
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
        hole_loss_mm=config.parts.mask.filament.hole_loss_mm,
        fold_mm=round(FOLD_LINES * printer.line_mm, 6) if mask.layers > 1 else 0.0,
        letter=mask.layers > 1 and STROKE * mark.length_mm >= printer.line_mm,
    )


def _refuse_sheet(
    config: Input, printed: Sheet, to_window_mm: float, around: Box, faults: Diagnostics
) -> None:
    """Refuse a printed sheet with webs or holes narrower than a line, one that is larger than the
    bed, and a filament that does not bend."""
    p, line, bed = config.parameters, printed.line_mm, config.parts.printer.profile.bed_mm
    loss = printed.hole_loss_mm
    web = min(least_web_mm(p), to_window_mm + loss / 2) - loss
    narrowest, _ = p.mask.extremes_mm
    faults.unless(
        web >= line - 1e-9,
        "sheet_web",
        p.mask.holes_field,
        holes=p.mask.holes_text,
        drawn=f" and drawn {loss:g} mm wider" if loss else "",
        web=web,
        line=line,
        most=max(p.grid.pitch_mm - least_web_mm(p) - line + web, 0),
        mean=p.mask.mean_text,
    )
    faults.unless(
        narrowest >= line - 1e-9,
        "sheet_hole",
        p.mask.holes_field,
        holes=p.mask.holes_text,
        line=line,
    )
    faults.unless(
        printed.thickness_mm >= LEAST_SHEET_MM - 1e-9,
        "sheet_thin",
        printed=printed,
        least_sheet_mm=LEAST_SHEET_MM,
    )
    # A flap turns about the middle of the layer that the groove leaves.
    inside = printed.thickness_mm - printed.layer_mm / 2
    faults.unless(
        p.mask.allowance_mm >= inside + FOLD_OFF_MM - 1e-9,
        "sheet_fold",
        printed=printed,
        inside=inside,
        fold_off_mm=FOLD_OFF_MM,
        least=inside + FOLD_OFF_MM,
    )
    faults.unless(
        around.width_mm <= bed[0] and around.length_mm <= bed[1],
        "sheet_beyond_bed",
        around=around,
        bed_x=bed[0],
        bed_y=bed[1],
    )
    faults.unless(config.parts.mask.filament.rigid_parts is not None, "sheet_stiff")


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
