"""Pictures of a board's side: an SVG of areas in mm, and a PNG in the same colours."""

import re
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree as XmlTree

import numpy as np
import PIL.Image
import shapely
from numpy.typing import NDArray
from PIL import ImageColor

from lumitip_fab.checks.readers import MALFORMED
from lumitip_fab.errors import OutputError

NOTHING = "nothing"
EDGE = "edge"
OTHER = "another colour"
_SVG = "{http://www.w3.org/2000/svg}"
_FORM = {f"{_SVG}svg": 3, f"{_SVG}title": 0, f"{_SVG}path": 4}
"""Elements, and how many attributes each has: nothing turns, hides or covers an area."""
_RING = re.compile(r"M([-\d. eL]+)Z")
_STRETCHED = 0.01  # one way more than the other, at most: sizes are whole pixels
Places = NDArray[np.float64]
Names = NDArray[np.str_]


@dataclass(frozen=True, eq=False)
class BoardDrawing:
    """Areas of the SVG from below to above."""

    size_mm: tuple[float, float]
    middle_mm: tuple[float, float]
    """Of the drawing, y down."""
    colours: dict[str, tuple[int, ...]]
    """Red, green and blue of each area."""
    rings: dict[str, list[shapely.Polygon]]
    """Of each area; where an odd number of them lie is inside."""

    def names(self, at_mm: Places) -> Names:
        """The area that is seen at places from the drawing's middle, shape `(n, 2)`."""
        x, y = (at_mm + self.middle_mm).T
        found = np.full(len(x), NOTHING, dtype=object)
        for name, rings in self.rings.items():
            odd = np.zeros(len(x), dtype=bool)
            for ring in rings:
                left, top, right, bottom = ring.bounds
                near = np.flatnonzero((x > left) & (x < right) & (y > top) & (y < bottom))
                if len(near):
                    odd[near] ^= shapely.contains_xy(ring, x[near], y[near])
            found[odd] = name
        return found.astype(str)


def read_drawing(path: Path) -> BoardDrawing:
    """The SVG of a side.

    Raises:
        OutputError: if it is missing, damaged, not in mm, or has anything but areas.
    """
    try:
        root = XmlTree.parse(path).getroot()
        if any(_FORM.get(str(each.tag)) != len(each.attrib) for each in root.iter()):
            raise ValueError("it has more than areas")
        left, top, width, height = map(float, root.attrib["viewBox"].split())
        sides = root.attrib["width"], root.attrib["height"]
        if sides != (f"{width:g}mm", f"{height:g}mm"):
            raise ValueError(f"it is {' x '.join(sides)}, not {width:g} x {height:g} mm")
        paths = [each.attrib for each in root.iter(f"{_SVG}path")]
        areas = {each["id"]: each for each in paths}
        if len(areas) < len(paths) or min(width, height) <= 0:
            raise ValueError("it has an area twice, or no size")
        if any(area["fill-rule"] != "evenodd" for area in areas.values()):
            raise ValueError("it has an area that is filled otherwise")
        return BoardDrawing(
            (width, height),
            (left + width / 2, top + height / 2),
            {name: _colour(area["fill"]) for name, area in areas.items()},
            {name: _rings(area["d"]) for name, area in areas.items()},
        )
    except (OSError, XmlTree.ParseError, *MALFORMED) as error:
        raise OutputError(f"cannot be read: {error!s:.120}") from error


def _colour(fill: str) -> tuple[int, ...]:
    rgb = ImageColor.getrgb(fill)
    if len(rgb) != 3:
        raise ValueError("an area is not opaque")
    return rgb


def _rings(path: str) -> list[shapely.Polygon]:
    if _RING.sub("", path):
        raise ValueError("an area has more than straight rings")
    corners = (np.array(ring.replace("L", " ").split(), float) for ring in _RING.findall(path))
    return [shapely.Polygon(each.reshape(-1, 2)) for each in corners]


def png_names(path: Path, drawing: BoardDrawing, at_mm: Places) -> Names:
    """The area whose colour the PNG has at places from its middle, shape `(n, 2)`; `EDGE` where
    the pixels round it differ.

    Raises:
        OutputError: if it is missing or damaged.
    """
    try:
        with PIL.Image.open(path) as shown:
            per_mm = np.array(shown.size) / drawing.size_mm
            if min(shown.size) < 3 or abs(per_mm[0] / per_mm[1] - 1) > _STRETCHED:
                raise ValueError(f"{shown.size[0]} x {shown.size[1]} pixels are not its shape")
            seen = np.asarray(shown.convert("RGBA"), dtype=np.int16)
    except (OSError, SyntaxError, PIL.Image.DecompressionBombError, *MALFORMED) as error:
        raise OutputError(f"cannot be read: {error!s:.120}") from error
    size = np.array(seen.shape[1::-1])
    column, row = np.floor(at_mm * size / drawing.size_mm + size / 2).astype(int).T
    column, row = np.clip(column, 1, size[0] - 2), np.clip(row, 1, size[1] - 2)
    round_it = np.stack([seen[row + i, column + k] for i in (-1, 0, 1) for k in (-1, 0, 1)])
    colour = seen[row, column]
    found = np.full(len(at_mm), OTHER, dtype=object)
    for name, rgb in drawing.colours.items():
        found[(colour == (*rgb, 255)).all(axis=1)] = name
    found[colour[:, 3] == 0] = NOTHING
    found[np.ptp(round_it, axis=0).max(axis=1) > 0] = EDGE
    return found.astype(str)
