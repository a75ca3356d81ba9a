"""The smooth film of the moulds' floor as a drawing for a plotter, and on paper to cut it by."""

import io

import numpy as np
from ezdxf.layouts import Modelspace
from reportlab.lib.units import mm

from lumitip_fab.design import Design, Insert
from lumitip_fab.design.frames import sensor_to_page, translation
from lumitip_fab.mask.artwork import PAPERS_MM
from lumitip_fab.mask.drawings import dxf_file
from lumitip_fab.mask.pdf import centred_page
from lumitip_fab.pipeline.artefact import Artefact
from lumitip_fab.typeface import PLAIN

LAYERS = {"CUT": 1}
HAIR_MM = 0.1
TEXT_MM = 2.8
LINE_MM = 4.5
TEXT_GAP_MM = 6.0


def insert_files(design: Design, insert: Insert) -> tuple[Artefact, ...]:
    """The insert's outline: DXF in the sensor frame, alike for both fingers, and PDF."""
    level = translation(0.0, 0.0, design.stack.silicone_z_mm)
    measured = design.mask.measured_ruler_mm
    pages = []
    for paper, (width, height) in PAPERS_MM.items():
        to_page = translation(width / 2, height / 2, 0.0) @ sensor_to_page(measured)
        to_page = to_page @ translation(0.0, -insert.box.centre_mm[1], 0.0)
        to_sensor = level @ np.linalg.inv(to_page)
        path = f"mould/{insert.name}_{paper}.pdf"
        pages.append(Artefact(path, insert_page(insert, design, paper), to_sensor))
    return (Artefact(f"mould/{insert.name}.dxf", insert_drawing(insert), level), *pages)


def insert_drawing(insert: Insert) -> bytes:
    """The bytes of the DXF."""
    left, low, right, high = (round(edge, 6) for edge in insert.box.bounds_mm)

    def draw(space: Modelspace) -> None:
        corners = [(left, low), (right, low), (right, high), (left, high)]
        space.add_lwpolyline(corners, close=True, dxfattribs={"layer": "CUT"})

    return dxf_file(LAYERS, draw)


def insert_page(insert: Insert, design: Design, paper: str) -> bytes:
    """The bytes of the PDF: the outline 1:1 on the same printer as the masks, and what it is.

    Args:
        insert: to draw.
        design: for its title, and what the rulers of the mask's page measured.
        paper: `"a4"` or `"letter"`.
    """
    wide, long = insert.box.width_mm, insert.box.length_mm
    across, up = (100 / measured for measured in design.mask.measured_ruler_mm)
    title = design.title.on_pages()
    buffer = io.BytesIO()
    canvas = centred_page(buffer, paper, f"{design.title.name} {title.revision}: insert")
    canvas.scale(mm * across, mm * up)
    canvas.setLineWidth(HAIR_MM)
    canvas.rect(-wide / 2, -long / 2, wide, long, stroke=1, fill=0)
    canvas.setFont(PLAIN, TEXT_MM)
    texts = (
        f"{title.name} {title.revision} – film for the floor of both moulds: cut two",
        f"{insert.film}, {wide:.2f} x {long:.2f} mm: measure the line on this page",
        "Print at 100 % (actual size). Cut along the line or just inside it.",
    )
    for line, text in enumerate(texts):
        canvas.drawCentredString(0, -long / 2 - TEXT_GAP_MM - line * LINE_MM, text)
    canvas.showPage()
    canvas.save()
    return buffer.getvalue()
