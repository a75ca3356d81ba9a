"""A board's picture as SVG and as PNG."""

import io
from typing import Any
from xml.sax.saxutils import escape, quoteattr

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Polygon

from lumitip_fab.boards.picture.paint import Painted

MARGIN_MM = 1.0
_DECIMALS = 3
_DOTS_PER_MM = 32


def svg_picture(seen: tuple[Painted, ...], title: str) -> bytes:
    """The picture as SVG in mm, on no ground.

    Args:
        seen: what is seen, from below to above.
        title: what it shows.
    """
    left, low, right, high = _bounds(seen)
    box = f"{left:g} {-high:g} {right - left:g} {high - low:g}"
    size = f'width="{right - left:g}mm" height="{high - low:g}mm"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" {size}>'
    drawn = "\n".join(
        f'<path id={quoteattr(p.name)} fill="{p.colour}" fill-rule="evenodd" d="{_path(p)}"/>'
        for p in seen
    )
    return f"{head}\n<title>{escape(title)}</title>\n{drawn}\n</svg>\n".encode()


def png_picture(seen: tuple[Painted, ...]) -> bytes:
    """The picture as PNG on no ground, 32 dots per mm."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import PathPatch

    left, low, right, high = _bounds(seen)
    inches = (right - left) / 25.4, (high - low) / 25.4
    figure = Figure(figsize=inches, dpi=_DOTS_PER_MM * 25.4)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set(xlim=(left, right), ylim=(low, high))
    for each in seen:
        for polygon in _polygons(each):
            # Unlike add_patch this fits no limits to each of a thousand pieces.
            axes.add_artist(PathPatch(_outline(polygon), facecolor=each.colour, linewidth=0))
    file = io.BytesIO()
    figure.savefig(file, format="png", transparent=True, metadata={"Software": None})
    return file.getvalue()


def _bounds(seen: tuple[Painted, ...]) -> tuple[float, float, float, float]:
    left, low, right, high = seen[0].area.bounds
    return left - MARGIN_MM, low - MARGIN_MM, right + MARGIN_MM, high + MARGIN_MM


def _polygons(each: Painted) -> list[Polygon]:
    return [p for p in shapely.get_parts(each.area) if p.geom_type == "Polygon"]


def _rings(polygon: Polygon) -> list[NDArray[np.float64]]:
    return [shapely.get_coordinates(r) for r in (polygon.exterior, *polygon.interiors)]


def _path(each: Painted) -> str:
    """All rings, y down."""
    told = []
    for polygon in _polygons(each):
        for ring in _rings(polygon):
            corners = (f"{_short(x)} {_short(-y)}" for x, y in ring[:-1])
            told.append("M" + "L".join(corners) + "Z")
    return "".join(told)


def _short(value: float) -> str:
    return f"{round(value, _DECIMALS) + 0.0:g}"


def _outline(polygon: Polygon) -> Any:
    """A polygon as matplotlib fills it: holes run the other way round."""
    from matplotlib.path import Path

    rings = [Path(ring, closed=True) for ring in _rings(shapely.orient_polygons(polygon))]
    return Path.make_compound_path(*rings)
