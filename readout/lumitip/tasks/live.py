"""`LiveTask`: a task in real time behind a link, like a robot with a fingertip.

    world = LiveTask(Task(layout, Settings("cable")), "twin://trace-cable")
    with world.open() as tip, world.shown(tip, port=8642):
        before_s = tip.wait_latest(2.0).t
        for frame in tip.frames(timeout=2.0):
            if frame is not tip.latest():
                continue  # a newer one is here already
            world.command(tracer(estimator(frame.values), frame.t - before_s))
            before_s = frame.t
    print(world.metrics())

Frames are packets of version 2 with raw codes. They come at the rate of the task, with or without
commands: a slow program misses frames, and the finger keeps its last command.
"""

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from lumitip import arguments
from lumitip.calibration import Calibration
from lumitip.control import Command
from lumitip.fingertip import Fingertip
from lumitip.frame import Values
from lumitip.layout import Layout
from lumitip.links.base import Arrival, Deliver, LinkEvent, Report
from lumitip.links.thread import ThreadedLink
from lumitip.protocol.packet import Packet, design_code
from lumitip.session.hub import Hub
from lumitip.tasks.task import Metrics, Task, TaskError, checked

_MOST_S = 120.0
_BUFFER = 4096


class LiveTask(ThreadedLink):
    """A link whose fingertip follows commands until its task ends."""

    _name = "lumitip-task"

    def __init__(self, task: Task, url: str, seed: int = 0, patience_s: float = 0.0) -> None:
        """A task that has not started.

        Args:
            task: its latency is in addition to that of the program and the link.
            url: its name.
            seed: of the curve.
            patience_s: how long the simulation waits for a late command (s). With 0 a slow program
                misses frames; else a busy computer slows the simulation down.

        Raises:
            TaskError: if an argument is invalid.
        """
        super().__init__()
        self.layout: Layout = arguments.instance(task, Task, "task", TaskError).layout
        self._patience_s = arguments.number(patience_s, "patience_s", 0.0, error=TaskError)
        self.device_id = url.replace("://", ":")
        self.url = url
        self.period_s = 1.0 / task.settings.rate_hz
        """Period of the frames (s)."""
        empty: Values = task.twin.empty.astype(np.float32)
        self.calibration = Calibration(self.device_id, task.layout.design_hash, empty)
        """The twin's empty grasp."""
        self._task = task
        self._task.reset(seed)
        self._command = Command()
        self._commanded = threading.Event()

    def open(self) -> Fingertip:
        """Start in real time; returns the fingertip that reads it."""
        hub = Hub(self, any_design=False, on_event=None)
        return Fingertip(hub, _BUFFER, calibrated=True, timeout_s=10.0)

    def command(self, command: Command) -> None:
        """Set the command; it holds until the next one. May be called from any thread.

        Raises:
            TaskError: if it is no command, or a velocity is not finite.
        """
        self._command = checked(command)
        self._commanded.set()

    def metrics(self) -> Metrics:
        """Errors so far, against the true line."""
        return self._task.metrics()

    @contextmanager
    def shown(self, tip: Fingertip, port: int | None) -> Iterator[None]:
        """Show the fingertip of `open` in the live view; port 0 is any free one, `None` no view."""
        if port is None:
            yield
            return
        from lumitip.view.finger import Finger
        from lumitip.view.registry import FingerRegistry
        from lumitip.view.server import ViewServer

        registry = FingerRegistry((), Path("recordings"))
        registry.add(Finger(self.url, tip))
        try:
            with ViewServer(registry, port=port) as server:
                print(f"live view at {server.url}", flush=True)
                yield
        finally:
            registry.close()

    def _run(self, deliver: Deliver, report: Report) -> None:
        self._packet(0)  # builds the tables before time runs
        report(LinkEvent("connected", f"{self.url} is simulated"))
        due_s, ended, number = time.monotonic(), False, 0
        while not ended and number * self.period_s < _MOST_S:
            due_s += self.period_s
            if self._stopping.wait(max(0.0, due_s - time.monotonic())):
                return
            if number:
                if self._patience_s and not self._commanded.is_set():
                    self._commanded.wait(self._patience_s)
                    due_s = time.monotonic()
                self._commanded.clear()
                ended = self._task.step(self._command)[1]
            deliver(Arrival(time.monotonic(), self._packet(number)))
            number += 1
        reason = self._task.metrics().reason or "time is up"
        report(LinkEvent("ended", f"the task ended: {reason}"))

    def _packet(self, number: int) -> Packet:
        t = number * self.period_s
        twin = self._task.twin
        codes = twin.codes(twin.light(self._task.scene())[None], np.array([t]))
        return Packet(
            design=design_code(self.layout.design_hash),
            sequence=number % 2**16,
            bits=twin.bits,
            time_us=round(t * 1e6) % 2**32,
            period_us=min(round(self.period_s * 1e6), 2**16 - 1),
            values=codes,
        )
