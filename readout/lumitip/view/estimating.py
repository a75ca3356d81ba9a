"""`Estimates`: the pose in the newest frame, while a browser asks; see `pose_process`.

After an estimate the process rests for as long as it took, so it uses half a core at most.
"""

import json
import subprocess
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from typing import Any

from lumitip import arguments, child_process
from lumitip.errors import ViewError
from lumitip.estimation.estimator import DIAMETER_MM, LEAST_DIAMETER_MM
from lumitip.frame import Frame
from lumitip.layout import Layout
from lumitip.links.url import Url
from lumitip.twin.optics import GAP_MM
from lumitip.twin.scene import MOST_DIAMETER_MM

MOST_HZ = 30.0
"""Largest rate of estimates: more are not readable."""


@dataclass(frozen=True)
class Expected:
    """The fingertip and cables that the estimates expect."""

    gap_mm: float = GAP_MM
    diameter_mm: float = DIAMETER_MM

    def __post_init__(self) -> None:
        arguments.number(self.gap_mm, "gap", 0.5, 20.0, error=ViewError)
        arguments.number(
            self.diameter_mm, "diameter", LEAST_DIAMETER_MM, MOST_DIAMETER_MM, error=ViewError
        )

    @classmethod
    def of(
        cls, url: str, gap_mm: float | None = None, diameter_mm: float | None = None
    ) -> "Expected":
        """Of an address: a twin:// has its own gap and diameter, others the default.

        Raises:
            ViewError: if a number is out of range.
        """
        options = Url.parse(url).options if url.lower().startswith("twin:") else {}
        gap_mm = float(options.get("gap", GAP_MM)) if gap_mm is None else gap_mm
        default_mm = max(float(options.get("diameter", DIAMETER_MM)), LEAST_DIAMETER_MM)
        return cls(gap_mm, default_mm if diameter_mm is None else diameter_mm)


EXPECTED = Expected()


@dataclass(frozen=True, eq=False)
class Estimated:
    """The estimate of one frame."""

    frame: Frame
    number: int
    """Number of frames that were read up to this one."""
    shown: dict[str, Any]
    """See `lumitip.view.pose.described`."""


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
        self._layout = json.loads(layout.to_json())
        self._expected = expected
        self._asked: tuple[Frame, int] | None = None
        self._changed: Callable[[], None] = lambda: None
        self._wake = threading.Event()
        self._stopping = threading.Event()
        self._lock = threading.Lock()
        self._process: subprocess.Popen[str] | None = None
        self._thread = threading.Thread(target=self._guarded, name="lumitip-estimates", daemon=True)

    def start(self, changed: Callable[[], None]) -> None:
        """Start the thread; `changed` is called on it after each estimate."""
        self._changed = changed
        self._thread.start()

    def expect(self, diameter_mm: float) -> None:
        """Expect cables of another diameter from the next frame on."""
        diameter_mm = max(diameter_mm, LEAST_DIAMETER_MM)
        self._expected = replace(self._expected, diameter_mm=diameter_mm)

    def ask(self, frame: Frame, number: int) -> None:
        """Estimate the pose in a frame, unless a newer one is asked for before."""
        self._asked = frame, number
        self._wake.set()

    def close(self) -> None:
        """End process and thread."""
        with self._lock:
            self._stopping.set()
            if self._process:
                self._process.kill()
        self._wake.set()
        if self._thread.is_alive():
            self._thread.join()

    def _guarded(self) -> None:
        self._wake.wait()  # without a browser there is no process
        try:
            with self._lock:
                if self._stopping.is_set():
                    return
                self._process = child_process.start("lumitip.view.pose_process")
            try:
                self._run(self._process)
            finally:
                _end(self._process)
        except (ViewError, OSError, ValueError) as error:
            if not self._stopping.is_set():
                self.state, self.detail = "failed", str(error)
                self._changed()

    def _run(self, process: "subprocess.Popen[str]") -> None:
        prepared = self._prepare(process)
        while not self._stopping.is_set():
            self._wake.wait()
            self._wake.clear()
            asked, last = self._asked, self.newest
            if asked is None or (last and last.frame is asked[0]):
                continue
            if self._expected != prepared:
                prepared = self._prepare(process)
            begun = time.monotonic()
            self.newest = Estimated(*asked, _asked(process, asked[0].values.tolist()))
            self._changed()
            took_s = time.monotonic() - begun
            self._stopping.wait(max(1.0 / MOST_HZ - took_s, took_s))

    def _prepare(self, process: "subprocess.Popen[str]") -> Expected:
        """Have the process compute its tables; returns what it expects then."""
        self.state, expected = "preparing", self._expected
        _asked(process, {"layout": self._layout, **asdict(expected)})
        self.state = "ready"
        return expected


def _end(process: "subprocess.Popen[str]") -> None:
    process.kill()
    process.wait()
    for pipe in (process.stdin, process.stdout):
        with suppress(OSError):  # a line that was not read
            if pipe:
                pipe.close()


def _asked(process: "subprocess.Popen[str]", question: object) -> dict[str, Any]:
    """The answer of the process to a line.

    Raises:
        ViewError: if it answers that it failed, or has ended.
    """
    assert process.stdin
    assert process.stdout
    try:
        process.stdin.write(json.dumps(question) + "\n")
        process.stdin.flush()
        line = process.stdout.readline()
    except BrokenPipeError:
        line = ""
    if not line:
        raise ViewError(f"the process of the estimates has ended, exit code {process.wait()}")
    answer: dict[str, Any] = json.loads(line)
    if "failed" in answer:
        raise ViewError(answer["failed"])
    return answer
