"""The print on the film, and whether a page takes it."""

from lumitip_fab.derive.boards import Plan
from lumitip_fab.derive.cells import LEAST_WEB_MM
from lumitip_fab.derive.faults import Faults
from lumitip_fab.design import Mask, Outline
from lumitip_fab.load import Input

PAGE_MM = (210.0, 279.4)  # what A4 and US Letter have in common
PAGE_MARGIN_MM = 5.0


def derive_mask(given: Input, outline: Outline, plan: Plan, faults: Faults) -> Mask:
    """The mask, refused where apertures meet the connector's window or the page is too small."""
    p = given.parameters
    film = given.catalogue.films[p.mask.film]
    lowest = min(y for _, y in plan.receiver.cells) - p.mask.hole_mm / 2
    window = max(plan.receiver.window.y_max_mm, plan.emitter.window.y_max_mm)
    faults.refuse_unless(
        lowest - window >= LEAST_WEB_MM,
        "mask.hole_mm",
        f"{p.mask.hole_mm:g} given, which leaves {lowest - window:.2f} mm of web between the last "
        f"row and the connector's window; at least {LEAST_WEB_MM} mm is needed",
    )
    around = 2 * (p.mask.allowance_mm + p.mask.flap_mm + PAGE_MARGIN_MM)
    widest = 2 * float(abs(outline.polygon()[:, 0]).max())
    stretch = [100 / measured for measured in p.mask.measured_ruler_mm]
    sheet = ((widest + around) * stretch[0], (outline.length_mm + around) * stretch[1])
    faults.refuse_unless(
        sheet[0] <= PAGE_MM[0] and sheet[1] <= PAGE_MM[1],
        "mask.flap_mm",
        f"{p.mask.flap_mm:g} given, the mask of this finger needs a sheet of {sheet[0]:.0f} x "
        f"{sheet[1]:.0f} mm; A4 and US Letter take {PAGE_MM[0]:.0f} x {PAGE_MM[1]:.0f} mm",
    )
    return Mask(
        hole_mm=p.mask.hole_mm,
        hole_shape=p.mask.hole_shape,
        allowance_mm=p.mask.allowance_mm,
        flap_mm=p.mask.flap_mm,
        film=p.mask.film,
        soften_c=film.soften_c,
        measured_ruler_mm=p.mask.measured_ruler_mm,
    )
