"""A drawing, SVG or DXF, as a program that opens it shows it."""

import io
from collections.abc import Iterable, Iterator
from pathlib import Path
from xml.etree import ElementTree as XmlTree

import ezdxf
import numpy as np
from ezdxf import units
from ezdxf.addons.drawing import Frontend, RenderContext
from ezdxf.addons.drawing.config import Configuration, TextPolicy
from ezdxf.addons.drawing.recorder import (
    FilledPathsRecord,
    PathRecord,
    PointsRecord,
    Recorder,
    SolidLinesRecord,
)
from reportlab.graphics import renderPDF
from reportlab.pdfgen.canvas import FILL_EVEN_ODD, Canvas
from svglib.svglib import svg2rlg

from lumitip_fab.checks.readers import MALFORMED
from lumitip_fab.checks.readers.mask_page import MM, PageError, Points
from lumitip_fab.checks.readers.pixels import Picture, pictures_of

HAIR_MM = 0.1
_FILLED = ""
"""In place of the layer of what a DXF fills by itself."""
_FLAT_MM = 0.0005  # from a curve to its chords
_LARGEST_UNIT_MM = 1000.0  # curves in larger ones would have countless chords
_ROUND_MM = 5.0  # of bare paper round a DXF
_TAGS = frozenset(("svg", "title", "path", "g", "circle", "rect", "text"))
_PLACES = ("id", "d", "cx", "cy", "r", "x", "y", "width", "height", "viewBox", "transform")
_LOOK = ("fill", "fill-rule", "fill-opacity", "stroke", "stroke-width", "stroke-dasharray")
_LETTERS = ("font-family", "font-size", "font-weight", "text-anchor")
_ATTRIBUTES = frozenset((*_PLACES, *_LOOK, *_LETTERS))
"""Elements and attributes that svglib and every browser draw alike."""


def svg_picture(path: Path) -> Picture:
    """A drawing by svglib, on a page of its own size.

    Raises:
        PageError: if the file is missing or damaged, or has what not every program draws.
    """
    try:
        text = path.read_bytes()
        for element in XmlTree.fromstring(text).iter():
            name = str(element.tag).rpartition("}")[2]
            odd = [name] if name not in _TAGS else sorted(element.attrib.keys() - _ATTRIBUTES)
            if odd:
                raise PageError(f"{odd[0]} is not drawn alike by all programs")
        drawing = svg2rlg(io.BytesIO(text))
        (picture,) = pictures_of(renderPDF.drawToString(drawing), MM, "print")
    except FileNotFoundError as error:
        raise PageError("no such file") from error
    except (OSError, XmlTree.ParseError, *MALFORMED) as error:
        raise PageError(f"cannot be drawn: {error!r:.200}") from error
    return picture


def dxf_picture(path: Path, black: Iterable[str]) -> Picture:
    """A drawing by ezdxf in its unit, with bare paper round it: layers that are filled together by
    the even-odd rule, and the lines of all others; no texts.

    Args:
        path: the file.
        black: names of the layers that are filled.

    Raises:
        PageError: if the file is missing or damaged, or has a unit that is no length.
    """
    try:
        document = ezdxf.readfile(path)
        unit_mm = units.conversion_factor(document.units, units.MM)
        if unit_mm > _LARGEST_UNIT_MM:
            raise PageError(f"its unit is {unit_mm:g} mm")
        recorder = Recorder()
        config = Configuration(text_policy=TextPolicy.IGNORE)
        Frontend(RenderContext(document), recorder, config).draw_layout(document.modelspace())
        pdf = _page(list(_runs(recorder, unit_mm)), frozenset(black))
        (picture,) = pictures_of(pdf, MM, "print")
    except FileNotFoundError as error:
        raise PageError("no such file") from error
    except (OSError, ezdxf.DXFError, *MALFORMED) as error:
        raise PageError(f"cannot be drawn: {error!r:.200}") from error
    return picture


def _runs(recorder: Recorder, unit_mm: float) -> Iterator[tuple[str, Points]]:
    """Layer, or `_FILLED`, and points (mm) of all that ezdxf draws."""
    flat = _FLAT_MM / unit_mm
    for record, properties in recorder.player().recordings():
        layer = properties.layer
        if isinstance(record, PathRecord):
            runs = [(layer, record.path.flattening(flat))]
        elif isinstance(record, FilledPathsRecord):
            runs = [(_FILLED, path.flattening(flat)) for path in record.paths]
        elif isinstance(record, PointsRecord):
            points = record.points.vertices()
            runs = [(_FILLED if len(points) > 2 else layer, points)]
        elif isinstance(record, SolidLinesRecord):
            ends = record.lines.vertices()
            runs = [(layer, ends[at : at + 2]) for at in range(0, len(ends), 2)]
        else:
            raise PageError("it has a picture, which may hide apertures")
        for name, points in runs:
            yield name, np.array([(p.x, p.y) for p in points]) * unit_mm


def _page(runs: list[tuple[str, Points]], black: frozenset[str]) -> bytes:
    """A page of them with bare paper round them."""
    every = np.concatenate([points for _, points in runs])
    low = every.min(axis=0) - _ROUND_MM
    size = (every.max(axis=0) + _ROUND_MM - low) / MM
    buffer = io.BytesIO()
    canvas = Canvas(buffer, pagesize=size.tolist())
    together, lines, filled = (canvas.beginPath() for _ in range(3))
    for layer, points in runs:
        path = filled if layer == _FILLED else together if layer in black else lines
        first, *others = ((points - low) / MM).tolist()
        path.moveTo(*first)
        for point in others:
            path.lineTo(*point)
    canvas.setLineWidth(HAIR_MM / MM)
    canvas.drawPath(together, stroke=0, fill=1, fillMode=FILL_EVEN_ODD)
    canvas.drawPath(filled, stroke=0, fill=1)
    canvas.drawPath(lines, stroke=1, fill=0)
    canvas.save()
    return buffer.getvalue()
