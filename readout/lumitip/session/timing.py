"""Host time of frames from the device clock, and the order of packets."""

from collections import deque
from dataclasses import dataclass
from itertools import pairwise

from lumitip.protocol.packet import Packet

Point = tuple[float, float]

_BUCKET_S = 1.0  # only the shortest delay of each second is used
_WINDOW = 120  # buckets: long enough for a stable rate, short enough to follow a warming crystal
_LEAST_SPAN_S = 10.0  # before it the skew is taken as 0: 100 ppm make 1 ms
_MOST_SKEW = 2e-3  # far above that of crystals
_LEAST_RATE = 0.8
_FAST_RATE = 0.25  # the same once times lead by more than `_MOST_LEAD_S`
_MOST_LEAD_S = 0.05
_LEAST_STEP_S = 1e-6  # seconds since 1970 as a float resolve no less


class DeviceClock:
    """Fits the device clock to the host clock. Not thread-safe."""

    def __init__(self) -> None:
        self._lowest: deque[Point] = deque(maxlen=_WINDOW)
        self._bucket = 0
        self._from = 0.0
        self._offset = 0.0
        self._skew = 0.0

    @property
    def skew_ppm(self) -> float:
        """Rate of the host clock relative to the device clock, minus 1 (ppm)."""
        return self._skew * 1e6

    def add(self, t_device: float, t_host: float) -> None:
        """Add a frame: device time of reading (s), unwrapped, and host time of arrival (s)."""
        if not self._lowest:
            self._from = t_device
        x, y = t_device - self._from, t_host - t_device
        bucket = int(x // _BUCKET_S)
        if not self._lowest or bucket != self._bucket:
            self._bucket = bucket
            self._lowest.append((x, y))
        elif y < self._lowest[-1][1]:
            self._lowest[-1] = (x, y)
        else:
            return
        self._fit()

    def host(self, t_device: float) -> float:
        """Host time (s) of a device time (s)."""
        return t_device + self._offset + self._skew * (t_device - self._from)

    def _fit(self) -> None:
        points = list(self._lowest)
        skew = 0.0
        if points[-1][0] - points[0][0] >= _LEAST_SPAN_S:
            skew = _slope_below(points)
        self._skew = min(max(skew, -_MOST_SKEW), _MOST_SKEW)
        self._offset = min(y - self._skew * x for x, y in points)


class SteadyTime:
    """Makes fitted times increase, at 0.8 times the pace of the device at least, or at a quarter of
    it while they lead the fit by more than 50 ms. Not thread-safe.

    The fit steps back when a frame arrives with a shorter delay than all before, as after a link
    has stalled; the times approach it gradually, and are later than it meanwhile. After a stall
    before the first frame they lead by a quarter of it, since the frames that waited come at once.
    """

    def __init__(self) -> None:
        self._last: float | None = None
        self._t_device: float | None = None

    def restarted(self) -> None:
        """Note that the device clock has begun anew."""
        self._t_device = None

    def next(self, t: float, t_device: float | None) -> float:
        """The time of the next frame (s).

        Args:
            t: its fitted time (s).
            t_device: device clock (s), unwrapped; `None` without one: times increase at least.
        """
        if self._last is not None:
            step_s = 0.0
            if t_device is not None and self._t_device is not None:
                step_s = t_device - self._t_device
            rate = _LEAST_RATE if self._last + step_s - t < _MOST_LEAD_S else _FAST_RATE
            t = max(t, self._last + max(rate * step_s, _LEAST_STEP_S))
        self._last, self._t_device = t, t_device
        return t


def _slope_below(points: list[Point]) -> float:
    """Slope of the lower convex hull at the mean x; points ascend in x."""
    hull: list[Point] = []
    for point in points:
        while len(hull) > 1 and _turns_down(hull[-2], hull[-1], point):
            hull.pop()
        hull.append(point)
    mean = sum(x for x, _ in points) / len(points)
    for (x0, y0), (x1, y1) in pairwise(hull):
        if x0 <= mean <= x1:
            return (y1 - y0) / (x1 - x0)
    return 0.0


def _turns_down(a: Point, b: Point, c: Point) -> bool:
    return (b[1] - a[1]) * (c[0] - a[0]) >= (c[1] - a[1]) * (b[0] - a[0])


_SEQUENCES = 1 << 16
_TIMES = 1 << 32  # 71.6 minutes of microseconds
_LATE_US = 1_000_000  # longest delay of a packet that others overtake
_AHEAD_US = 10_000_000  # longest stall of a link
# After a reconnection the device clock must have gone on for as long as the host's, less this. The
# first packet may be that much older on arrival than the last one before: it was read while the
# link connected, or waited behind other data. Below 3 s, so that a device that was off for a few
# seconds is noticed. The share is for the skew: crystals are within 0.01 %, ceramic resonators and
# trimmed oscillators of controllers within 1 %.
_BEHIND_US = 2_000_000
_BEHIND_SHARE = 0.01


@dataclass(frozen=True)
class Place:
    """Position of a packet in the sequence."""

    seq: int
    """Number of its first new frame, continued over wraps and restarts."""
    time_us: int
    """Device time of that frame, unwrapped (us)."""
    repeated: int
    """Frames at its start that are repeated or too late."""
    lost: int | None
    """Frames missing just before it; `None` after a restart."""
    restarted: bool = False
    """Whether the device has restarted, and its clock with it."""


class Timeline:
    """Puts packets in order. Not thread-safe."""

    def __init__(self) -> None:
        self._seq = -1  # of the last frame, continued over restarts
        self._sequence = 0  # of the same frame, counted by the device, unwrapped
        self._time_us = 0
        self._t_host: float | None = None
        self._fresh = False

    def reconnected(self) -> None:
        """Note a reconnection: older packets can no longer arrive."""
        self._fresh = True

    def place(self, packet: Packet, t_host: float) -> Place:
        """Position of the next packet.

        If only one of its number and its time continues, or its time is far behind after a
        reconnection, the device has restarted.
        """
        if self._t_host is None:
            return self._keep(packet, t_host, Place(0, packet.time_us, 0, 0), packet.sequence)
        waited_us = (t_host - self._t_host) * 1e6
        time_us = _nearest(packet.time_us, _TIMES, self._time_us + waited_us)
        step_us = time_us - self._time_us
        steps = step_us / packet.period_us if packet.period_us else 1
        sequence = _nearest(packet.sequence, _SEQUENCES, self._sequence + steps)
        step = sequence - self._sequence
        oldest_us = 0 if self._fresh else -_LATE_US
        least_us = (1.0 - _BEHIND_SHARE) * waited_us - _BEHIND_US if self._fresh else 0.0
        goes_on = step > 0 and step_us > 0 and least_us <= step_us <= waited_us + _AHEAD_US
        if goes_on:
            place = Place(self._seq + step, time_us, 0, step - 1)
        elif step <= 0 and oldest_us <= step_us <= 0:
            repeated = min(1 - step, packet.frames)
            place = Place(self._seq + 1, time_us + repeated * packet.period_us, repeated, 0)
        else:
            place = Place(self._seq + 1, packet.time_us, 0, None, restarted=True)
            sequence = packet.sequence
        return self._keep(packet, t_host, place, sequence)

    def _keep(self, packet: Packet, t_host: float, place: Place, sequence: int) -> Place:
        new = packet.frames - place.repeated
        if new:
            self._seq = place.seq + new - 1
            self._sequence = sequence + packet.frames - 1
            self._time_us = place.time_us + (new - 1) * packet.period_us
            self._t_host = t_host
            self._fresh = False
        return place


def _nearest(value: int, modulus: int, expected: float) -> int:
    """The number nearest to `expected` that is `value` modulo `modulus`."""
    return value + modulus * round((expected - value) / modulus)
