"""The thread that a link runs on."""

import logging
import threading
from abc import ABC, abstractmethod

from lumitip.errors import LinkError, LumitipError
from lumitip.links.base import Deliver, LinkEvent, Report
from lumitip.links.retry import UnexpectedError

_log = logging.getLogger(__name__)


class ThreadedLink(ABC):
    """Start and stop of a `Link`; what it does in between is `_run`."""

    _name = "lumitip-link"
    """Of the thread, for whoever debugs."""

    def __init__(self) -> None:
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self, deliver: Deliver, report: Report) -> None:
        """Begin; see `Link`."""
        self._thread = threading.Thread(
            target=self._guarded, args=(deliver, report), name=self._name, daemon=True
        )
        self._thread.start()

    def stop(self) -> None:
        """End; see `Link`."""
        self._stopping.set()
        if self._thread and self._thread is not threading.current_thread():
            self._thread.join()

    @abstractmethod
    def _run(self, deliver: Deliver, report: Report) -> None:
        """Deliver and report until `_stopping` is set; what it raises ends the link."""

    def _guarded(self, deliver: Deliver, report: Report) -> None:
        try:
            self._run(deliver, report)
        except Exception as problem:  # noqa: BLE001 - a thread must not die without a word
            error = _as_link_error(problem)
            if self._stopping.is_set():
                _log.debug("while stopping: %s", error)
            else:
                report(LinkEvent("failed", str(error), error))


def _as_link_error(problem: Exception) -> LinkError:
    if isinstance(problem, LinkError):
        return problem
    return (
        LinkError(str(problem)) if isinstance(problem, LumitipError) else UnexpectedError(problem)
    )
