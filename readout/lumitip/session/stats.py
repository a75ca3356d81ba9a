"""`Stats`: counts of frames, rate and jitter of a link."""

import threading
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import astuple, dataclass

import numpy as np

from lumitip.frame import Frame

CAUSES = ("link", "queue", "crc", "length")
_RECENT = 512  # frames for rate and jitter


@dataclass(frozen=True, eq=False, repr=False)
class Dropped(Mapping[str, int]):
    """Frames lost, by cause. Immutable; equal to a `dict` of the same counts."""

    link: int = 0
    """On the way."""
    queue: int = 0
    """Not read in time."""
    crc: int = 0
    """Damaged."""
    length: int = 0
    """Truncated."""

    def __getitem__(self, cause: str) -> int:
        if cause not in CAUSES:
            raise KeyError(cause)
        number: int = getattr(self, cause)
        return number

    def __iter__(self) -> Iterator[str]:
        return iter(CAUSES)

    def __len__(self) -> int:
        return len(CAUSES)

    def __hash__(self) -> int:
        return hash(astuple(self))

    def __repr__(self) -> str:
        return repr(dict(self))


@dataclass(frozen=True)
class Stats:
    """Statistics since the link was opened. Immutable; can be compared, copied and pickled."""

    received: int
    """New frames received."""
    dropped: Dropped | None
    """Frames lost, by cause: `"link"` on the way, `"crc"` damaged, `"length"` truncated, `"queue"`
    not read in time. `None` for a legacy device: unknown."""
    overflowed: int
    """Frames not read in time: `dropped["queue"]`, also known for a legacy device."""
    unreadable: int
    """Packets that could not be decoded."""
    repeated: int
    """Frames received again or too late, and ignored."""
    reconnects: int
    """Number of reconnections."""
    restarts: int
    """Number of restarts of the device."""
    rate_hz: float | None
    """Frames per second of the last 512; `None` before the second."""
    jitter_ms: float | None
    """Standard deviation of the delay from reading the cells to arrival (ms) of the same frames;
    `None` for a legacy device."""


class Counter:
    """Counts for `Stats`. Thread-safe."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._count = dict.fromkeys(("received", "repeated", "reconnects", "restarts"), 0)
        self._dropped = dict.fromkeys(CAUSES, 0)
        self._unreadable = 0
        self._recent: deque[tuple[float, float]] = deque(maxlen=_RECENT)
        self._legacy = False

    def frames(self, frames: list[Frame]) -> None:
        """Count new frames."""
        with self._lock:
            self._count["received"] += len(frames)
            self._recent.extend((f.t, f.t_host) for f in frames)
            self._legacy = bool(frames) and frames[-1].t_device is None

    def add(self, name: str, number: int = 1) -> None:
        """Count `"repeated"`, `"reconnects"` or `"restarts"`."""
        with self._lock:
            self._count[name] += number

    def lost(self, cause: str, frames: int) -> None:
        """Count lost frames."""
        with self._lock:
            self._dropped[cause] += frames

    def unreadable(self, packets: int) -> None:
        """Count packets that could not be decoded."""
        with self._lock:
            self._unreadable += packets

    def snapshot(self) -> Stats:
        """The current statistics."""
        with self._lock:
            recent = np.array(self._recent).reshape(-1, 2)
            span_s = float(recent[-1, 0] - recent[0, 0]) if len(recent) > 1 else 0.0
            return Stats(
                **self._count,
                dropped=None if self._legacy else Dropped(**self._dropped),
                overflowed=self._dropped["queue"],
                unreadable=self._unreadable,
                rate_hz=(len(recent) - 1) / span_s if span_s > 0 else None,
                jitter_ms=_jitter_ms(recent) if span_s > 0 and not self._legacy else None,
            )


def _jitter_ms(recent: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> float:
    return float(np.std(recent[:, 1] - recent[:, 0]) * 1e3)
