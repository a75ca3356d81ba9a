"""Markers for RViz: cells as grey tiles, and over them the lines of contact and estimate."""

import math
from collections.abc import Sequence

import numpy as np
from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

from lumitip import Frame, Layout
from lumitip.view.drawn import MISSING

_METRE = 1e-3
_SIZE = 0.7  # of a cell, in pitches
_HIGH_MM, _LINE_MM = 0.2, 0.3
_LIFETIME_NS = 500_000_000  # RViz shows a marker no longer: a link that is cut shows nothing
_OVER_MM = 0.4  # of lines over the face, so that no cell hides them


def cells(frame: Frame, layout: Layout, header: Header) -> Marker:
    """All cells as one marker; a cell without a value is red."""
    marker = _marker(header, "cells", Marker.CUBE_LIST)
    marker.scale.x = marker.scale.y = _SIZE * layout.pitch_mm * _METRE
    marker.scale.z = _HIGH_MM * _METRE
    marker.points = _points(np.column_stack([layout.x_mm, layout.y_mm]), 0.0)
    marker.colors = [_grey(value) for value in frame.values.tolist()]
    return marker


def lines(
    drawn: Sequence[np.ndarray], colour: Sequence[float], namespace: str, header: Header
) -> Marker:
    """Lines as one marker; without lines it deletes those of the frame before.

    Args:
        drawn: both ends of each line, shape `(2, 2)` (mm).
        colour: red, green and blue, 0 to 255.
        namespace: of the marker.
        header: of the frame.
    """
    marker = _marker(header, namespace, Marker.LINE_LIST)
    marker.action = Marker.ADD if len(drawn) else Marker.DELETE
    marker.scale.x = _LINE_MM * _METRE
    marker.color = _colour(colour)
    marker.points = [point for line in drawn for point in _points(np.asarray(line), _OVER_MM)]
    return marker


def none() -> MarkerArray:
    """Deletes all markers."""
    return MarkerArray(markers=[Marker(action=Marker.DELETEALL)])


def _marker(header: Header, namespace: str, kind: int) -> Marker:
    marker = Marker(header=header, ns=namespace, id=0, type=kind, action=Marker.ADD)
    marker.pose.orientation.w = 1.0
    marker.lifetime.nanosec = _LIFETIME_NS
    return marker


def _points(places_mm: np.ndarray, z_mm: float) -> list[Point]:
    return [Point(x=x * _METRE, y=y * _METRE, z=z_mm * _METRE) for x, y in places_mm.tolist()]


def _grey(value: float) -> ColorRGBA:
    if not math.isfinite(value):
        return _colour(MISSING)
    return _colour([min(max(value, 0.0), 255.0)] * 3)


def _colour(values: Sequence[float]) -> ColorRGBA:
    red, green, blue = (value / 255.0 for value in values)
    return ColorRGBA(r=red, g=green, b=blue, a=1.0)
