"""Letters, lines and distances of the manual's PDF."""

from reportlab.lib import colors
from reportlab.lib.enums import TA_RIGHT
from reportlab.lib.styles import ParagraphStyle
from reportlab.platypus import TableStyle

from lumitip_fab.typeface import BOLD, PLAIN

BODY = ParagraphStyle(
    "body",
    fontName=PLAIN,
    fontSize=9.2,
    leading=13.6,
    spaceAfter=5,
    bulletFontName=PLAIN,
    bulletFontSize=9.2,
)
ITEM = ParagraphStyle("item", BODY, leftIndent=16, spaceAfter=3)
CELL = ParagraphStyle("cell", BODY, fontSize=7.6, leading=10.6, spaceAfter=0)
FIGURE = ParagraphStyle("figure", CELL, alignment=TA_RIGHT)
_GREY = colors.HexColor("#5a6b7a")
SMALL = ParagraphStyle("small", BODY, fontSize=7.1, alignment=1, textColor=_GREY)
HEADS = {
    level: ParagraphStyle(
        f"h{level}",
        BODY,
        fontName=BOLD,
        fontSize=size,
        leading=size * 1.25,
        spaceBefore=before,
        spaceAfter=6,
        keepWithNext=1,
    )
    for level, (size, before) in {1: (17, 0), 2: (13, 14), 3: (10.5, 10), 4: (9, 8)}.items()
}
LINES = TableStyle(
    [
        ("GRID", (0, 0), (-1, -1), 0.4, colors.HexColor("#cfd6dc")),
        ("BACKGROUND", (0, 0), (-1, 0), colors.HexColor("#f4f6f8")),
        ("VALIGN", (0, 0), (-1, -1), "TOP"),
        ("FONTNAME", (0, 0), (-1, -1), PLAIN),
        ("TOPPADDING", (0, 0), (-1, -1), 2),
        ("BOTTOMPADDING", (0, 0), (-1, -1), 2),
    ]
)
NEAR_LINES = TableStyle(
    [("TOPPADDING", (0, 0), (-1, -1), 0.6), ("BOTTOMPADDING", (0, 0), (-1, -1), 0.8)], parent=LINES
)
"""Tables of a step that would otherwise run on over a page."""
BESIDE = TableStyle(
    [
        ("ALIGN", (0, 0), (-1, -1), "CENTER"),
        ("VALIGN", (0, 0), (-1, -1), "BOTTOM"),
        ("FONTNAME", (0, 0), (-1, -1), PLAIN),
    ]
)
