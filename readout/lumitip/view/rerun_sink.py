"""`RerunSink`: the data of the live view for the Rerun viewer or a file.

For each finger the entities `cells`, `markers`, `centre`, `border`, `mean` and `shape`, on the
timelines `seq` and `time` (UTC). y is negated, because Rerun's y points down.
"""

from pathlib import Path
from typing import Any

import numpy as np

from lumitip.errors import MissingExtra
from lumitip.frame import Frame
from lumitip.grid import Floats
from lumitip.processing import Contact
from lumitip.processing.contact import Point
from lumitip.view.finger import Finger

MOST_HZ = 60.0
"""Largest rate of frames sent: more are not visible, and slow down the reading thread."""
_TURN = np.array([1.0, -1.0])


class RerunSink:
    """Sends frames to Rerun. Thread-safe.

    Args:
        path: of an `.rrd` file; default: open the viewer.

    Raises:
        MissingExtra: if `rerun-sdk` is not installed.
    """

    def __init__(self, path: Path | None = None) -> None:
        try:
            import rerun
        except ModuleNotFoundError as error:
            raise MissingExtra("rerun", "--rerun") from error
        self._rerun: Any = rerun
        self._stream: Any = rerun.RecordingStream("lumitip")
        if path is None:
            self._stream.spawn()
        else:
            self._stream.save(path)
        self._last: dict[str, tuple[float, str]] = {}

    def take(self, finger: Finger, frame: Frame) -> None:
        """Send a frame, limited to `MOST_HZ` per finger."""
        name = finger.tip.device_id
        last_t, last_shape = self._last.get(name, (-np.inf, ""))
        if 0 <= frame.t - last_t < 1 / MOST_HZ:
            return
        contact = finger.contact(frame)
        self._last[name] = frame.t, contact.shape
        self._stream.set_time("seq", sequence=frame.seq)
        self._stream.set_time("time", timestamp=frame.t_wall)
        layout = finger.tip.layout
        cells_mm = np.column_stack((layout.x_mm, layout.y_mm))
        grey = np.nan_to_num(frame.values).clip(0, 255).astype(np.uint8)
        self._points(
            [name, "cells"],
            cells_mm,
            colors=np.repeat(grey[:, None], 3, axis=1),
            radii=0.45 * layout.pitch_mm,
        )
        self._contact(name, contact, float(np.ptp(cells_mm, axis=0).max()))
        self._log([name, "mean"], self._rerun.Scalars(float(np.nanmean(frame.values))))
        if contact.shape != last_shape:
            self._log([name, "shape"], self._rerun.TextLog(contact.shape))

    def close(self) -> None:
        """Write buffered data."""
        self._stream.flush()
        self._stream.disconnect()

    def _contact(self, name: str, contact: Contact, reach_mm: float) -> None:
        markers = np.empty((0, 2)) if contact.markers_mm is None else contact.markers_mm
        centre = [contact.centre_mm] if contact.centre_mm else []
        self._points([name, "markers"], markers, colors=[255, 255, 255], draw_order=50.0)
        self._points(
            [name, "centre"], np.reshape(centre, (-1, 2)), colors=[232, 89, 12], draw_order=60.0
        )
        strips = [strip * _TURN for strip in borders(contact, reach_mm)]
        self._log(
            [name, "border"],
            self._rerun.LineStrips2D(strips, colors=[86, 180, 233], draw_order=40.0),
        )

    def _points(self, path: list[str], points_mm: Floats, **how: Any) -> None:
        self._log(path, self._rerun.Points2D(points_mm * _TURN, **how))

    def _log(self, path: list[str], what: Any) -> None:
        self._stream.log(path, what)


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
