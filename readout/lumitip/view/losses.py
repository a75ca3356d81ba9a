"""`Losses`: what was lost in the last seconds, in one sentence: how much, where, and what to do."""

import math
import time
from collections import deque
from dataclasses import dataclass
from typing import Any

from lumitip.session.stats import Stats

HELD_S = 10.0
"""Time for which a loss is reported (s)."""
RENEWED_S = 2.0
"""Shortest time between two sentences (s): quicker ones are not readable."""
_CAUSES = {
    "link": ("lost on the way", "Bring the fingertip closer, or use another cable."),
    "crc": ("damaged on arrival", "Use another cable, or keep it away from motors."),
    "length": ("cut off on arrival", "Check the cable, and that the firmware is of this layout."),
    "queue": ("not read in time", "Close other programs, or lower the rate."),
    "page": ("not drawn by this page", "Recordings have them. Close other tabs."),
}
_OF_REPLAYS = {
    "link": ("missing in the recording", ""),
    "page": ("not drawn by this page", "Close other tabs, or lower the speed."),
}

_NONE = "No frame was lost since this page connected."


@dataclass
class _Loss:
    at_s: float
    cause: str
    frames: int
    hidden: bool
    """Whether it was found after more than `HELD_S` in which the page drew nothing."""


class Losses:
    """Losses since a page connected, for one browser.

    Args:
        replayed: whether the frames are of a recording.
    """

    def __init__(self, replayed: bool = False) -> None:
        self._causes = _CAUSES | _OF_REPLAYS if replayed else _CAUSES
        self._before: dict[str, int] | None = None
        self._first: dict[str, int] = {}
        self._recent: deque[_Loss] = deque()
        self._before_s = math.inf
        self._shown = {"text": _NONE, "fresh": False}
        self._shown_at_s = -RENEWED_S

    def status(self, stats: Stats, skipped: int, now_s: float | None = None) -> dict[str, Any]:
        """The sentence, and whether something was lost in the last `HELD_S`.

        Args:
            stats: of the fingertip.
            skipped: frames that this page did not get.
            now_s: time (s); default: now.
        """
        now_s = time.monotonic() if now_s is None else now_s
        counts = {**(stats.dropped or {}), "queue": stats.overflowed, "page": skipped}
        if self._before is None:
            self._before = self._first = counts
        for cause, count in counts.items():
            new = count - self._before.get(cause, 0)
            if new > 0:
                hidden = now_s - self._before_s > HELD_S
                self._recent.append(_Loss(now_s, cause, new, hidden))
        self._before, self._before_s = counts, now_s
        while self._recent and now_s - self._recent[0].at_s > HELD_S:
            self._recent.popleft()
        if now_s - self._shown_at_s >= RENEWED_S:
            shown = self._sentence(stats)
            if shown != self._shown:
                self._shown, self._shown_at_s = shown, now_s
        return self._shown

    def _sentence(self, stats: Stats) -> dict[str, Any]:
        if self._recent:
            seen = [loss for loss in self._recent if not loss.hidden]
            by_cause: dict[str, int] = {}
            for loss in seen or self._recent:
                by_cause[loss.cause] = by_cause.get(loss.cause, 0) + loss.frames
            cause = max(by_cause, key=by_cause.__getitem__)
            what, remedy = self._causes[cause]
            number = _frames(by_cause[cause])
            if not seen:
                return {"text": f"{number} {what} while the page was hidden.", "fresh": False}
            text = f"{number} {what} in the last {HELD_S:.0f} s. {remedy}"
            return {"text": text.strip(), "fresh": True}
        assert self._before is not None
        lost = sum(self._before.values()) - sum(self._first.values())
        if lost:
            text = f"{_frames(lost)} lost or not drawn since this page connected, none just now."
        elif stats.dropped is None:
            text = "This device does not number its frames, so losses on the way are not known."
        else:
            text = _NONE
        return {"text": text, "fresh": False}


def _frames(number: int) -> str:
    return f"{number:,} frames were".replace(",", "\u202f") if number != 1 else "1 frame was"
