"""`FingertipGroup`: several fingertips read together, their frames aligned in time.

with FingertipGroup.open({"left": "ble://A1", "right": "ble://A2"}, layout=path) as group:
    moment = group.read()
    moment["left"].values
"""

import math
import time
from collections import deque
from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType, TracebackType
from typing import Unpack

from lumitip.arguments import seconds
from lumitip.errors import ArgumentError, LinkTimeout
from lumitip.fingertip import Fingertip
from lumitip.frame import Frame
from lumitip.layout import Layout
from lumitip.links.base import Calibrated
from lumitip.links.url import redacted
from lumitip.options import OpenOptions, check_options
from lumitip.values import shown


@dataclass(frozen=True, eq=False)
class Moment:
    """One frame of each fingertip, closest in time. Immutable."""

    frames: Mapping[str, Frame]
    """By name."""
    recorded: bool = False
    """Whether all are of recordings: then `Frame.t_wall` says how close they are."""

    def __getitem__(self, name: str) -> Frame:
        return self.frames[name]

    def __repr__(self) -> str:
        return f"<Moment {self.t:.6f} s of {', '.join(self.frames)}, spread {self.spread_s:.6f} s>"

    @property
    def t(self) -> float:
        """The middle of their times (s); of recordings, by the clock of the first."""
        first, times = next(iter(self.frames.values())), self._times
        return (min(times) + max(times)) / 2.0 + (first.t - times[0])

    @property
    def spread_s(self) -> float:
        """Largest difference of their times (s): about one period of the slowest at most."""
        return max(self._times) - min(self._times)

    @property
    def _times(self) -> list[float]:
        return [_time_of(frame, self.recorded) for frame in self.frames.values()]


def _time_of(frame: Frame, recorded: bool) -> float:
    """The time by which frames of several fingertips are compared (s). `Frame.t` of a recording is
    by the clock of its computer, and late by the delay of its first frame."""
    return frame.t_wall if recorded else frame.t


class FingertipGroup:
    """Several open fingertips; made by `FingertipGroup.open`. Recordings are aligned by
    `Frame.t_wall`, also those of two computers; all others by `Frame.t`.

    Call `read` and `moments` from one thread at a time; `wait_latest` from any.
    """

    def __init__(self, tips: Mapping[str, Fingertip]) -> None:
        self.tips = MappingProxyType(dict(tips))
        """The fingertips by name."""
        self._waiting: dict[str, deque[Frame]] = {name: deque() for name in tips}
        self._recorded = all(isinstance(t._hub.link, Calibrated) for t in tips.values())

    @classmethod
    def open(
        cls,
        urls: Mapping[str, str],
        layout: Layout | str | Path | Mapping[str, Layout | str | Path] | None = None,
        **options: Unpack[OpenOptions],
    ) -> "FingertipGroup":
        """Connect to all fingertips, or to none. From any thread.

        Args:
            urls: addresses by name.
            layout: one for all, or by name.
            options: of `Fingertip.open`, for all.

        Raises:
            ArgumentError: if there is no address, or a layout of another name.
            LumitipError: as `Fingertip.open`, from the first that fails; the others are closed.
        """
        check_options(options)
        if not isinstance(urls, Mapping) or not urls:
            raise ArgumentError(
                f"urls is {redacted(shown(urls))}; names and addresses of at least one fingertip "
                "are needed, such as {'left': 'ble://A1'}"
            )
        if isinstance(layout, Mapping) and (unknown := sorted(set(layout) - set(urls), key=str)):
            names = ", ".join(map(str, urls))
            raise ArgumentError(f"layout has {shown(unknown[0])}; the fingertips are {names}")
        with ExitStack() as stack:
            tips = {}
            for name, url in urls.items():
                own = layout.get(name) if isinstance(layout, Mapping) else layout
                tips[name] = stack.enter_context(Fingertip.open(url, own, **options))
            stack.pop_all()
            return cls(tips)

    def read(self, timeout: float | None = 1.0) -> Moment:
        """The next moment with a new frame of every fingertip, within `timeout` (s); `None` waits
        without limit. The slowest sets the rate; extra frames of the others are skipped.

        Raises:
            LinkTimeout: if a fingertip sent no frame in time; the message names it.
            LinkError: if the link of a fingertip has failed.
        """
        within_s = seconds(timeout)
        until = math.inf if within_s is None else time.monotonic() + within_s
        for name in self.tips:
            self._fill(name, 1, until)
        # The latest of the first frames: no earlier moment has a frame of each.
        t = max(self._time(waiting[0]) for waiting in self._waiting.values())
        for name, waiting in self._waiting.items():
            while self._time(waiting[0]) < t:
                self._fill(name, 2, until)
                if self._time(waiting[1]) - t >= t - self._time(waiting[0]):
                    break
                waiting.popleft()
        taken = {name: waiting.popleft() for name, waiting in self._waiting.items()}
        return Moment(MappingProxyType(taken), self._recorded)

    def moments(self, timeout: float | None = 1.0) -> Iterator[Moment]:
        """Repeat `read`."""
        while True:
            yield self.read(timeout)

    def wait_latest(self, timeout_s: float | None = 1.0) -> Moment:
        """The newest frame of each fingertip, once each is newer than the last that this thread
        got; waits up to `timeout_s` (s), `None` without limit. The first frames of a thread are as
        of `Fingertip.wait_latest`. For control loops: nothing queues.

        Raises:
            LinkTimeout: if a fingertip sent no newer frame in time; the message names it.
            LinkError: if the link of a fingertip has failed.
        """
        within_s = seconds(timeout_s, "timeout_s")
        until = math.inf if within_s is None else time.monotonic() + within_s
        for tip in self.tips.values():  # before the wait for one of them takes the time of others
            tip._pass_over(within_s)
        frames = {}
        for name, tip in self.tips.items():
            left_s = None if within_s is None else max(0.0, until - time.monotonic())
            try:
                frames[name] = tip.wait_latest(left_s)
            except LinkTimeout as error:
                raise LinkTimeout(f"{name}: {error}") from error
        # While the last was waited for, the others may have sent again.
        newest = {name: self.tips[name].latest() or frame for name, frame in frames.items()}
        return Moment(MappingProxyType(newest), self._recorded)

    def close(self) -> None:
        """Disconnect all. From any thread; may be repeated."""
        for tip in self.tips.values():
            tip.close()

    def _time(self, frame: Frame) -> float:
        return _time_of(frame, self._recorded)

    def _fill(self, name: str, number: int, until: float) -> None:
        waiting = self._waiting[name]
        while len(waiting) < number:
            try:
                waiting.append(self.tips[name].read(max(0.0, until - time.monotonic())))
            except LinkTimeout as error:
                # Frames of the others wait for the next call.
                raise LinkTimeout(f"{name}: {error}") from error

    def __repr__(self) -> str:
        tips = ", ".join(f"{name}: {tip!r}" for name, tip in self.tips.items())
        return f"<FingertipGroup of {tips}>"

    def __enter__(self) -> "FingertipGroup":
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        self.close()
