"""Making a link again when it is cut, ever less often."""

import logging
import threading
from collections.abc import Callable, Iterator

from lumitip.errors import LinkError, MissingExtra, MtuTooSmall, WrongDesign
from lumitip.links.base import LinkEvent, Report

_log = logging.getLogger(__name__)
_FIRST_S, _LAST_S = 0.1, 5.0


class UnexpectedError(LinkError):
    """A fault of lumitip or of a library it uses, not of the link."""

    def __init__(self, problem: Exception) -> None:
        super().__init__(f"unexpected {type(problem).__name__}: {problem}; please report it")
        self.__cause__ = problem


FATAL = (WrongDesign, MtuTooSmall, MissingExtra, UnexpectedError)
"""What no further attempt can mend."""

Session = Callable[[Callable[[str], None]], None]
"""Connects, calls its argument with what people should read once connected, and reads until it is
told to stop; raises `LinkError` if the link cannot be made or is cut."""


def delays_s() -> Iterator[float]:
    """Waiting times between attempts (s), without end."""
    delay_s = _FIRST_S
    while True:
        yield delay_s
        delay_s = min(2.0 * delay_s, _LAST_S)


def keep_connected(session: Session, report: Report, stopping: threading.Event) -> None:
    """Run sessions one after the other until `stopping` is set.

    The first must connect: if it fails the link is given up, since a wrong name or port does not
    mend itself.
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
        except Exception as problem:  # noqa: BLE001 - a thread must not die without a word
            error = problem if isinstance(problem, LinkError) else UnexpectedError(problem)
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
