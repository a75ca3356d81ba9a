"""Links that are made again: ever less often, and never without a word."""

import threading
from itertools import islice

import pytest

from lumitip.errors import LinkError, MtuTooSmall, NotConnected
from lumitip.links.base import LinkEvent
from lumitip.links.thread import delays_s, keep_connected


class Sessions:
    """Sessions that end as they are told; stops after the last."""

    def __init__(self, *ends: Exception | str) -> None:
        self.ends = list(ends)
        self.stopping = threading.Event()
        self.waited: list[float] = []
        self.events: list[LinkEvent] = []
        self.stopping.wait = self._wait  # type: ignore[method-assign]

    def __call__(self, connected) -> None:
        end = self.ends.pop(0)
        if not self.ends:
            self.stopping.set()
        if isinstance(end, str):
            connected(end)
            end = NotConnected("cut")
        raise end

    def _wait(self, delay_s: float) -> bool:
        self.waited.append(delay_s)
        return False

    def run(self) -> list[str]:
        keep_connected(self, self.events.append, self.stopping)
        return [event.kind for event in self.events]


def test_attempts_become_rarer_up_to_five_seconds() -> None:
    assert list(islice(delays_s(), 9)) == pytest.approx(
        [0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 5.0, 5.0, 5.0]
    )


def test_a_cut_is_told_once_and_the_delay_begins_anew_when_connected() -> None:
    gone = NotConnected("still gone")
    sessions = Sessions("first", gone, gone, "second", gone, gone)
    assert sessions.run() == ["connected", "lost", "connected", "lost"]
    assert sessions.waited == pytest.approx([0.1, 0.2, 0.4, 0.1, 0.2])


def test_the_first_attempt_must_succeed() -> None:
    sessions = Sessions(NotConnected("no such thing"), "never")
    assert sessions.run() == ["failed"]
    assert isinstance(sessions.events[0].error, NotConnected)


@pytest.mark.parametrize("error", [MtuTooSmall(23, 51), ZeroDivisionError("a bug")])
def test_what_no_attempt_can_mend_ends_it(error: Exception) -> None:
    sessions = Sessions("first", error, "never")
    assert sessions.run() == ["connected", "lost", "failed"]
    told = sessions.events[-1].error
    assert isinstance(told, LinkError)
    assert told is error or told.__cause__ is error
