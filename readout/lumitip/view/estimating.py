"""`Estimates`: the pose in the newest frame, on a thread of its own while a browser asks.

The thread never estimates more than `MOST_HZ` times a second, and rests at least as long as an
estimate took: it leaves the other half of the time to the threads that read.
"""

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from lumitip.errors import LumitipError
from lumitip.estimation import PoseEstimator
from lumitip.estimation.estimator import DIAMETER_MM
from lumitip.frame import Frame
from lumitip.layout import Layout
from lumitip.twin.optics import GAP_MM
from lumitip.view.pose import described, reach_of

MOST_HZ = 30.0
"""Largest rate of estimates: more are not readable."""
_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Expected:
    """The fingertip and cables that the estimates expect."""

    gap_mm: float = GAP_MM
    diameter_mm: float = DIAMETER_MM


EXPECTED = Expected()


@dataclass(frozen=True, eq=False)
class Estimated:
    """The estimate of one frame."""

    frame: Frame
    number: int
    """Number of frames that were read up to this one."""
    shown: dict[str, Any]
    """See `described`."""


class Estimates:
    """Estimates for all browsers of a finger. Thread-safe.

    Args:
        layout: the cells.
        expected: see `PoseEstimator`.
    """

    def __init__(self, layout: Layout, expected: Expected = EXPECTED) -> None:
        self.newest: Estimated | None = None
        self.state = "preparing"
        """`"preparing"`, `"ready"` or `"failed"`."""
        self.detail = ""
        """Why there are none."""
        self._layout = layout
        self._expected = expected
        self._asked: tuple[Frame, int] | None = None
        self._changed: Callable[[], None] = lambda: None
        self._wake = threading.Event()
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._guarded, name="lumitip-estimates", daemon=True)

    def start(self, changed: Callable[[], None]) -> None:
        """Start the thread; `changed` is called on it after each estimate."""
        self._changed = changed
        self._thread.start()

    def ask(self, frame: Frame, number: int) -> None:
        """Estimate the pose in a frame, unless a newer one is asked for before."""
        self._asked = frame, number
        self._wake.set()

    def close(self) -> None:
        """End the thread; one that still computes tables ends later by itself."""
        self._stopping.set()
        self._wake.set()
        if self._thread.is_alive() and self.state != "preparing":
            self._thread.join()

    def _guarded(self) -> None:
        try:
            self._run()
        except LumitipError as error:
            self._fail(str(error))
        except Exception as error:  # noqa: BLE001 - shown, not lost with the thread
            _log.exception("the estimates have stopped")
            self._fail(f"unexpected {type(error).__name__}: {error}")

    def _fail(self, why: str) -> None:
        self.state, self.detail = "failed", why
        self._changed()

    def _run(self) -> None:
        self._wake.wait()  # without a browser no tables are computed
        if self._stopping.is_set():
            return
        estimator = PoseEstimator(
            self._layout,
            gap_mm=self._expected.gap_mm,
            diameter_mm=self._expected.diameter_mm,
            tracking=True,
        ).prepare()
        reach_mm = reach_of(self._layout)
        self.state = "ready"
        angle_deg: float | None = None
        while not self._stopping.is_set():
            self._wake.wait()
            self._wake.clear()
            asked, last = self._asked, self.newest
            if asked is None or (last and last.frame is asked[0]):
                continue
            begun = time.monotonic()
            shown = described(estimator(asked[0].values), reach_mm, angle_deg)
            angle_deg = shown["angle_deg"]
            self.newest = Estimated(*asked, shown)
            self._changed()
            took_s = time.monotonic() - begun
            self._stopping.wait(max(1.0 / MOST_HZ - took_s, took_s))
