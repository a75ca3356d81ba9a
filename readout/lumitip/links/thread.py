"""The thread of a link, and its reconnection."""

import logging
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator

from lumitip import errors
from lumitip.links.base import Deliver, LinkEvent, Report

_log = logging.getLogger(__name__)
_FIRST_S, _LAST_S = 0.1, 5.0


class UnexpectedError(errors.LinkError):
    """A bug of lumitip or of a library."""

    def __init__(self, problem: Exception) -> None:
        super().__init__(f"unexpected {type(problem).__name__}: {problem}. Please report it")
        self.__cause__ = problem


FATAL = (
    errors.WrongDesign,
    errors.MtuTooSmall,
    errors.MissingExtra,
    UnexpectedError,
    errors.DeviceFailed,
    errors.AccessRefused,
)
"""Errors that a new attempt cannot solve."""

Session = Callable[[Callable[[str], None]], None]
"""Connects, calls its argument with a text for the user, and reads until the link stops; raises
`LinkError` if it cannot connect or the connection is lost."""


def delays_s() -> Iterator[float]:
    """Endless waiting times between attempts (s)."""
    delay_s = _FIRST_S
    while True:
        yield delay_s
        delay_s = min(2.0 * delay_s, _LAST_S)


def keep_connected(session: Session, report: Report, stopping: threading.Event) -> None:
    """Run one session after another until `stopping` is set.

    The link fails if the first session does not connect: its name or port is probably wrong.
    """
    delays = delays_s()
    connected = up = False

    def now_connected(detail: str) -> None:
        nonlocal connected, up, delays
        connected, up, delays = True, True, delays_s()
        report(LinkEvent("connected", detail))

    while not stopping.is_set():
        try:
            session(now_connected)
        except Exception as problem:  # noqa: BLE001 - reported, not lost with the thread
            error = problem if isinstance(problem, errors.LinkError) else UnexpectedError(problem)
            if stopping.is_set():
                _log.debug("while stopping: %s", error)
                return
            if not connected or isinstance(error, FATAL):
                report(LinkEvent("failed", str(error), error))
                return
            if up:
                report(LinkEvent("lost", str(error), error))
            else:
                _log.debug("not connected again: %s", error)
            up = False
            stopping.wait(next(delays))


class ThreadedLink(ABC):
    """A `Link` that runs `_run` on its own thread."""

    _name = "lumitip-link"
    """Name of the thread."""

    def __init__(self) -> None:
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self, deliver: Deliver, report: Report) -> None:
        """See `Link`."""
        self._thread = threading.Thread(
            target=self._guarded, args=(deliver, report), name=self._name, daemon=True
        )
        self._thread.start()

    def stop(self) -> None:
        """See `Link`."""
        self._stopping.set()
        if self._thread and self._thread is not threading.current_thread():
            self._thread.join()

    @abstractmethod
    def _run(self, deliver: Deliver, report: Report) -> None:
        """Deliver and report until `_stopping` is set; an exception ends the link."""

    def _guarded(self, deliver: Deliver, report: Report) -> None:
        try:
            self._run(deliver, report)
        except Exception as problem:  # noqa: BLE001 - reported, not lost with the thread
            if isinstance(problem, errors.LumitipError):
                error = (
                    problem
                    if isinstance(problem, errors.LinkError)
                    else errors.LinkError(str(problem))
                )
            else:
                error = UnexpectedError(problem)
            if self._stopping.is_set():
                _log.debug("while stopping: %s", error)
            else:
                report(LinkEvent("failed", str(error), error))
