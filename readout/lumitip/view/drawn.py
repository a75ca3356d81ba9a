"""Lines of a contact as they are drawn in Rerun, Foxglove and RViz, and the colours of drawings."""

import numpy as np

from lumitip.grid import Floats
from lumitip.processing import Contact
from lumitip.processing.contact import Point

PUBLISHED, ESTIMATE = (86, 180, 233), (232, 89, 12)
"""Colours of the published method and of the estimate: red, green and blue, 0 to 255."""
MISSING = (204, 26, 26)
"""Colour of a cell without a value."""


def borders(contact: Contact, reach_mm: float) -> list[Floats]:
    """The fitted lines of a contact as pairs of points, each of shape `(2, 2)` (mm).

    Args:
        contact: of a frame.
        reach_mm: length of the lines to each side.
    """
    if contact.shape == "edge" and contact.line:
        return [_through(contact.line.point_mm, contact.line.angle_deg, reach_mm)]
    if contact.shape == "corner" and contact.corner:
        vertex = np.array(contact.corner.vertex_mm)
        ways = (reach_mm * _direction(angle) for angle in contact.corner.directions_deg)
        return [np.array((vertex, vertex + way)) for way in ways]
    if contact.shape == "cable" and contact.cable:
        angle, half = contact.cable.angle_deg, contact.cable.width_mm / 2.0
        axis = _through(contact.cable.axis_point_mm, angle, reach_mm)
        across = half * _direction(angle + 90.0)
        return [axis + across, axis - across]
    return []


def _through(point_mm: Point, angle_deg: float, reach_mm: float) -> Floats:
    way = reach_mm * _direction(angle_deg)
    return np.array((np.array(point_mm) - way, np.array(point_mm) + way))


def _direction(angle_deg: float) -> Floats:
    return np.array((np.cos(np.deg2rad(angle_deg)), np.sin(np.deg2rad(angle_deg))))
