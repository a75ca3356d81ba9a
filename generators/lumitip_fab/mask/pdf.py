"""The mask on paper: one page, vector, 1:1 but for the stretch that the printer needs."""

import io

import numpy as np
from reportlab.lib.units import mm
from reportlab.pdfgen.canvas import FILL_EVEN_ODD, FILL_NON_ZERO, Canvas
from reportlab.pdfgen.pathobject import PDFPathObject

from lumitip_fab.design import Mask, Title
from lumitip_fab.design.frames import Matrix, sensor_to_page, translation
from lumitip_fab.mask.artwork import LINE_MM, PAPERS_MM, RULER_MM, Artwork, Path, arrange
from lumitip_fab.typeface import BOLD, PLAIN, load_typeface

HAIR_MM = 0.1
GREY = 0.55  # of fold lines: visible on black, and light enough to tell from a cut
TEXT_MM = 2.8
NUMBER_MM = 1.8


def pdf_page(artwork: Artwork, mask: Mask, title: Title, paper: str) -> bytes:
    """The bytes of the PDF.

    Args:
        artwork: what to draw.
        mask: for the rulers' readings and the registration marks.
        title: of the design.
        paper: `"a4"` or `"letter"`.
    """
    stretch = [100 / measured for measured in mask.measured_ruler_mm]
    buffer = io.BytesIO()
    canvas = centred_page(
        buffer, paper, f"{title.name} {title.revision}: {artwork.name.lower()} mask"
    )
    canvas.setSubject("Print at 100 %, mirrored on purpose: the inside of the film")
    canvas.scale(mm * stretch[0], mm * stretch[1])
    places = arrange(mask)
    canvas.saveState()
    canvas.transform(-1, 0, 0, 1, *places.artwork)
    _artwork(canvas, artwork)
    _registration(canvas, mask)
    canvas.restoreState()
    _ruler(canvas, places.level_ruler, upright=False)
    _ruler(canvas, places.upright_ruler, upright=True)
    _texts(canvas, artwork, mask, title, paper)
    canvas.showPage()
    canvas.save()
    return buffer.getvalue()


def coupon_page(mask: Mask, title: Title, paper: str) -> bytes:
    """The bytes of the PDF of the coupon: the black of the masks without holes, 1:1.

    Args:
        mask: for the coupon's size.
        title: of the design.
        paper: `"a4"` or `"letter"`.
    """
    wide, long = mask.coupon.width_mm, mask.coupon.length_mm
    buffer = io.BytesIO()
    canvas = centred_page(buffer, paper, f"{title.name} {title.revision}: coupon")
    canvas.scale(mm, mm)
    canvas.setFillGray(0)
    canvas.rect(-wide / 2, -long / 2, wide, long, stroke=0, fill=1)
    canvas.setFont(PLAIN, TEXT_MM)
    texts = (
        "Coupon: print it on the same film as the masks, with the same ink and as often over it.",
        "Cut it out. lumitip doctor URL --opacity measures how much light passes.",
    )
    for line, text in enumerate(texts):
        canvas.drawCentredString(0, -long / 2 - (2 + line) * LINE_MM, text)
    canvas.showPage()
    canvas.save()
    return buffer.getvalue()


def centred_page(buffer: io.BytesIO, paper: str, title: str) -> Canvas:
    """A page with the origin in its middle."""
    width, height = PAPERS_MM[paper]
    load_typeface()
    canvas = Canvas(
        buffer,
        pagesize=(width * mm, height * mm),
        invariant=1,
        pageCompression=0,
        initialFontName=PLAIN,
    )
    canvas.setTitle(title)
    canvas.setAuthor("lumitip-fab")
    canvas.setCreator("lumitip-fab")
    canvas.translate(width * mm / 2, height * mm / 2)
    return canvas


def pdf_to_sensor(mask: Mask, paper: str) -> Matrix:
    """From mm on the page, origin at its lower left, to the sensor frame."""
    width, height = PAPERS_MM[paper]
    x, y = arrange(mask).artwork
    stretched = sensor_to_page(mask.measured_ruler_mm)
    to_page = translation(width / 2, height / 2, 0) @ stretched @ translation(-x, y, 0)
    return np.asarray(np.linalg.inv(to_page))


def _artwork(canvas: Canvas, artwork: Artwork) -> None:
    """Everything on the film, in the sensor frame."""
    canvas.setFillGray(0)
    _fill(canvas, (artwork.black, artwork.window, *artwork.apertures), FILL_EVEN_ODD)
    bands = [Path(f.band[0], tuple((p,) for p in f.band[1:])) for f in artwork.flaps]
    _fill(canvas, tuple(bands), FILL_NON_ZERO)
    _fill(canvas, (artwork.mark,), FILL_NON_ZERO)
    canvas.setFont(BOLD, artwork.name_mm)
    canvas.drawString(*artwork.name_at, artwork.name)
    canvas.setFont(PLAIN, NUMBER_MM)
    for flap in artwork.flaps:
        x, y = flap.label
        canvas.drawCentredString(x, y - NUMBER_MM / 3, str(flap.number))
    canvas.setLineWidth(HAIR_MM)
    canvas.setStrokeGray(0)
    outline = canvas.beginPath()
    _trace(outline, artwork.cut)
    canvas.drawPath(outline, stroke=1, fill=0)
    canvas.setStrokeGray(GREY)
    canvas.setLineWidth(1.5 * HAIR_MM)
    canvas.setDash(1.0, 0.8)
    for flap in artwork.flaps:
        (x, y), (to_x, to_y) = flap.fold
        canvas.line(x, y, to_x, to_y)
    canvas.setDash()


def _registration(canvas: Canvas, mask: Mask) -> None:
    canvas.setStrokeGray(0)
    canvas.setLineWidth(HAIR_MM)
    for x, y in mask.registration:
        canvas.circle(x, y, 1.2, stroke=1, fill=0)
        canvas.line(x - 2, y, x + 2, y)
        canvas.line(x, y - 2, x, y + 2)


def _ruler(canvas: Canvas, start: tuple[float, float], upright: bool) -> None:
    """100 mm in one path of ticks on a base line; figures on the far side."""
    canvas.setFillGray(0)
    canvas.setStrokeGray(0)
    canvas.setLineWidth(HAIR_MM)
    canvas.setFont(PLAIN, 2.4)
    canvas.saveState()
    canvas.translate(*start)
    if upright:
        canvas.rotate(90)
    path = canvas.beginPath()
    path.moveTo(0, 0)
    path.lineTo(RULER_MM, 0)
    for tick in range(int(RULER_MM) + 1):
        path.moveTo(tick, 0)
        path.lineTo(tick, 3.2 if tick % 10 == 0 else 2.4 if tick % 5 == 0 else 1.6)
    canvas.drawPath(path, stroke=1, fill=0)
    for tick in range(0, int(RULER_MM) + 1, 10):
        # Past the ticks of the upright ruler, which is to the left of its base line.
        canvas.drawCentredString(tick, 4.0 if upright else -3.2, str(tick))
    canvas.restoreState()


def _texts(canvas: Canvas, artwork: Artwork, mask: Mask, title: Title, paper: str) -> None:
    places = arrange(mask)
    across, up = mask.measured_ruler_mm
    name = "US Letter" if paper == "letter" else "A4"
    canvas.setFont(BOLD, 1.4 * TEXT_MM)
    x, y = places.heading
    heading = f"{title.on_pages().name} {title.revision} – {artwork.name.lower()} mask"
    canvas.drawCentredString(x, y, heading)
    canvas.setFont(PLAIN, TEXT_MM)
    caption = f"{name}, print at 100 % (actual size), on the inside of the film"
    canvas.drawCentredString(x, y - 1.2 * LINE_MM, caption)
    notes = (
        "Measure both rulers on a paper print. Not 100.0 mm? Put the readings into",
        "mask.measured_ruler_mm (horizontal, vertical) and build again. "
        f"This page is made for {across:g} and {up:g}.",
        "Solid line: cut. Grey dashes: fold, towards the print, in the order of the numbers.",
        "Seen from the unprinted side, the letter F and the finger's name read right.",
    )
    x, y = places.notes
    for line, text in enumerate(notes):
        canvas.drawCentredString(x, y - line * LINE_MM, text)


def _fill(canvas: Canvas, paths: tuple[Path, ...], rule: int) -> None:
    path = canvas.beginPath()
    for closed in paths:
        _trace(path, closed)
    canvas.drawPath(path, stroke=0, fill=1, fillMode=rule)


def _trace(pen: PDFPathObject, path: Path) -> None:
    pen.moveTo(*path.start)
    for segment in path.segments:
        if len(segment) == 1:
            pen.lineTo(*segment[0])
        else:
            pen.curveTo(*(value for point in segment for value in point))
    pen.close()
