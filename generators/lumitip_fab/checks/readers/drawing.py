"""Read a line drawing: what is drawn in each group, what is written, and the page."""

import math
import re
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree as XmlTree

import numpy as np
from reportlab.pdfbase.pdfmetrics import stringWidth

from lumitip_fab.checks.readers.solids import Vectors

_SVG = "{http://www.w3.org/2000/svg}"
_PATH = f"{_SVG}path"
_ANGLES = ("azimuth", "elevation")
_PAIR = re.compile(r"(-?\d*\.?\d+),(-?\d*\.?\d+)")


@dataclass(frozen=True, eq=False)
class Drawing:
    """Contents of the file, in mm of the page with y up."""

    size_mm: tuple[float, float]
    view: Vectors
    """The page's x and y in the finger's frame, as rows."""
    extent: Vectors
    """Lower left and upper right corner."""
    groups: dict[str, Vectors]
    """Points of each group by its id."""
    words: list[tuple[str, Vectors]]
    """Each line of words with its extent."""


def margin_mm(drawing: Drawing) -> float:
    """Least distance of anything drawn or written from the page's edge."""
    every = np.concatenate([*drawing.groups.values(), *(extent for _, extent in drawing.words)])
    (left, low), (right, high) = drawing.extent
    return float(min(*(every.min(axis=0) - (left, low)), *((right, high) - every.max(axis=0))))


def read_drawing(path: Path) -> Drawing:
    """A drawing's groups, words and page.

    Raises:
        OSError, XmlTree.ParseError, LookupError, ValueError: if it is missing, or no such drawing.
    """
    root = XmlTree.parse(path).getroot()
    left, top, width, height = (float(v) for v in root.attrib["viewBox"].split())
    for name, wide in (("width", width), ("height", height)):
        if not math.isclose(float(root.attrib[name].removesuffix("mm")), wide, abs_tol=0.01):
            raise ValueError(f"{name} {root.attrib[name]} for {wide:g} units is not 1:1 in mm")
    turn, lift = (math.radians(float(root.attrib[f"data-{a}-deg"])) for a in _ANGLES)
    right = (math.cos(turn), math.sin(turn), 0.0)
    up = (-math.sin(turn) * math.sin(lift), math.cos(turn) * math.sin(lift), math.cos(lift))
    groups = {
        group.attrib["id"]: np.concatenate([_points(p.attrib["d"]) for p in group.iter(_PATH)])
        for group in root.iter(f"{_SVG}g")
    }
    words = [(str(text.text), _extent(text)) for text in root.iter(f"{_SVG}text")]
    extent = np.array([(left, -top - height), (left + width, -top)])
    return Drawing((width, height), np.array([right, up]), extent, groups, words)


def _points(data: str) -> Vectors:
    return np.array(_PAIR.findall(data), dtype=np.float64).reshape(-1, 2) * (1.0, -1.0)


def _extent(text: XmlTree.Element) -> Vectors:
    x, y, size = float(text.attrib["x"]), -float(text.attrib["y"]), float(text.attrib["font-size"])
    font = "Helvetica-Bold" if text.get("font-weight") == "bold" else "Helvetica"
    width = stringWidth(str(text.text), font, size)
    start = x - width if text.attrib["text-anchor"] == "end" else x
    return np.array([(start, y - size / 4), (start + width, y + size)])
