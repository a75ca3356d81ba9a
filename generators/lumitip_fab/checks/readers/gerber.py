"""Gerber and drill files as areas and holes."""

import math
import re
import warnings
from collections.abc import Iterable
from functools import lru_cache
from typing import Any

import shapely
from gerbonara import graphic_primitives as gp
from gerbonara.excellon import ExcellonFile
from gerbonara.rs274x import GerberFile
from gerbonara.utils import MM
from shapely import LineString, Polygon, affinity, box
from shapely import Point as Dot
from shapely.geometry.base import BaseGeometry

Hole = tuple[float, float, float]
"""x, y, diameter (mm)."""
_REPEATED = re.compile(r"[%*]SR(?!\*|X1Y1(?!\d))")
_STEPS = 32  # chords of a quarter circle


@lru_cache(maxsize=64)
def gerber_area(text: str) -> BaseGeometry:
    """Area that a Gerber file paints, in mm; clear objects erase what is below them.

    The same text is read once a process: orders for several fabs share layers.

    Raises:
        ValueError: if it is cut short, or not understood in every command.
    """
    dark: BaseGeometry = Polygon()
    run: list[BaseGeometry] = []
    adding = True
    if _REPEATED.search(text):
        raise ValueError("a part of it is repeated, which this reader does not follow")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            layer = GerberFile.from_string(text)
        except Warning as warning:
            raise ValueError(str(warning)) from warning
    for drawn in layer.objects:
        for primitive in drawn.to_primitives(MM):
            if primitive.polarity_dark != adding:
                dark, run, adding = _merged(dark, run, adding), [], primitive.polarity_dark
            run.append(_shape(primitive))
    return _merged(dark, run, adding)


def drilled(text: str) -> list[Hole]:
    """The holes of an Excellon file, in mm."""
    return [
        (MM(o.x, o.unit), MM(o.y, o.unit), MM(o.aperture.diameter, o.aperture.unit))
        for o in ExcellonFile.from_string(text).objects
    ]


def _merged(dark: BaseGeometry, run: Iterable[BaseGeometry], adding: bool) -> BaseGeometry:
    area = shapely.union_all(list(run))
    return dark.union(area) if adding else dark.difference(area)


def _shape(p: Any) -> BaseGeometry:
    if isinstance(p, gp.Circle):
        return Dot(p.x, p.y).buffer(p.r, quad_segs=_STEPS)
    if isinstance(p, gp.Rectangle):
        flat = box(p.x - p.w / 2, p.y - p.h / 2, p.x + p.w / 2, p.y + p.h / 2)
        return affinity.rotate(flat, math.degrees(p.rotation), origin=(p.x, p.y))
    if isinstance(p, gp.Line):
        return LineString([(p.x1, p.y1), (p.x2, p.y2)]).buffer(p.width / 2, quad_segs=_STEPS)
    if isinstance(p, gp.Arc):
        points = _bow((p.x1, p.y1), (p.x2, p.y2), (p.cx, p.cy), p.clockwise)
        return LineString(points).buffer(p.width / 2, quad_segs=_STEPS)
    if isinstance(p, gp.ArcPoly):
        corners = [
            point
            for start, end, (clockwise, centre) in p.segments
            for point in ([start] if clockwise is None else _bow(start, end, centre, clockwise))
        ]
        return Polygon(corners).buffer(0)
    raise ValueError(f"the Gerber file holds a {type(p).__name__}, which this reader does not know")


def _bow(start: Any, end: Any, centre: Any, clockwise: bool) -> list[tuple[float, float]]:
    radius = math.dist(start, centre)
    first, last = (math.atan2(p[1] - centre[1], p[0] - centre[0]) for p in (start, end))
    sweep = (first - last if clockwise else last - first) % math.tau or math.tau
    steps = max(2, math.ceil(sweep / (math.pi / 2) * _STEPS))
    turn = -sweep if clockwise else sweep
    angles = [first + turn * i / steps for i in range(steps + 1)]
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]
