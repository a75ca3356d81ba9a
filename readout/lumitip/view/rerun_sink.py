"""`RerunSink`: the data of the live view for the Rerun viewer or a file.

For each finger the entities `cells`, `markers`, `centre`, `border`, `mean` and `shape`, below its
device's name, on the timelines `seq` and `time` (UTC). Of fingers with the same name all but the
first have a number, as in `Lumitip 2`. y is negated, because Rerun's y points down.
"""

import threading
from itertools import chain, count
from pathlib import Path
from typing import Any

import numpy as np

from lumitip.errors import MissingExtra, ViewError
from lumitip.frame import Frame
from lumitip.grid import Floats
from lumitip.processing import Contact
from lumitip.view.drawn import PUBLISHED, borders
from lumitip.view.finger import Finger

MOST_HZ = 60.0
"""Largest rate of frames sent: more are not visible, and slow down the reading thread."""
_TURN = np.array([1.0, -1.0])


def _refuse(path: Path) -> None:
    """Refuse a file that the Rerun viewer would not open, or that would be overwritten."""
    if path.suffix != ".rrd":
        raise ViewError(
            f"--rerun is {path}; the name of the file must end in .rrd. Without a file, write "
            "--rerun after the addresses: it opens the viewer"
        )
    if path.exists():
        raise ViewError(f"--rerun {path}: the file exists. Choose another name")
    if not path.parent.is_dir():
        raise ViewError(f"--rerun {path}: there is no folder {path.parent}. Create it first")


class RerunSink:
    """Sends frames to Rerun. Thread-safe.

    Args:
        path: of an `.rrd` file, which must not exist yet; default: open the viewer.

    Raises:
        MissingExtra: if `rerun-sdk` is not installed.
        ViewError: if the file exists or cannot be written.
    """

    def __init__(self, path: Path | None = None) -> None:
        if path is not None:
            _refuse(path)
        try:
            import rerun
        except ModuleNotFoundError as error:
            raise MissingExtra("rerun", "--rerun") from error
        self._rerun: Any = rerun
        self._stream: Any = rerun.RecordingStream("lumitip")
        if path is None:
            self._stream.spawn()
        else:
            try:
                self._stream.save(path)
            except RuntimeError as error:
                raise ViewError(f"--rerun {path}: cannot be written: {error}") from error
        self._last: dict[str, tuple[float, str]] = {}
        self._names: dict[Finger, str] = {}
        self._naming = threading.Lock()

    def take(self, finger: Finger, frame: Frame) -> None:
        """Send a frame, limited to `MOST_HZ` per finger."""
        name = self._name(finger)
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

    def _name(self, finger: Finger) -> str:
        with self._naming:
            if finger not in self._names:
                device, taken = finger.tip.device_id, set(self._names.values())
                others = (f"{device} {number}" for number in count(2))
                self._names[finger] = next(n for n in chain([device], others) if n not in taken)
            return self._names[finger]

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
            self._rerun.LineStrips2D(strips, colors=PUBLISHED, draw_order=40.0),
        )

    def _points(self, path: list[str], points_mm: Floats, **how: Any) -> None:
        self._log(path, self._rerun.Points2D(points_mm * _TURN, **how))

    def _log(self, path: list[str], what: Any) -> None:
        self._stream.log(path, what)
