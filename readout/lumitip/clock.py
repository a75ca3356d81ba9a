"""Device time to host time: a line below all arrivals, since a packet can be late but not early.

The line under the points that leaves the least area to them is the edge of their lower convex
hull above their mean: Moon, Skelly and Towsley, "Estimation and removal of clock skew from network
delay measurements", INFOCOM 1999. Bunched and late arrivals then move nothing.
"""

from collections import deque
from itertools import pairwise

Point = tuple[float, float]

_BUCKET_S = 1.0  # of each second only the least late arrival counts
_WINDOW = 120  # buckets: long enough for a steady rate, short enough to follow a warming crystal
_LEAST_SPAN_S = 10.0  # before that both clocks are taken to run alike: 100 ppm are then 1 ms
_MOST_SKEW = 2e-3  # crystals stay far below; more is noise


class DeviceClock:
    """Fits a device's clock to the host's as packets arrive. Not thread-safe."""

    def __init__(self) -> None:
        self._lowest: deque[Point] = deque(maxlen=_WINDOW)
        self._bucket = 0
        self._from = 0.0
        self._offset = 0.0
        self._skew = 0.0

    @property
    def skew_ppm(self) -> float:
        """By how much the host's clock outruns the device's (parts per million)."""
        return self._skew * 1e6

    def add(self, t_device: float, t_host: float) -> None:
        """Take the arrival of a frame into account.

        Args:
            t_device: when the cells were read, device time (s), unwrapped.
            t_host: when they arrived, host time (s).
        """
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


def _slope_below(points: list[Point]) -> float:
    """Slope of the lower hull's edge at the mean abscissa; points ascend in x."""
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
