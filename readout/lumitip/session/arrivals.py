"""`ArrivalTime`: times of frames of a device without a clock, from their arrivals."""

_BUNCH_S = 0.005  # frames that arrive closer belong to one bunch
_MOST_PERIOD_S = 0.1
_MOST_LAG_S = 0.5  # longest stall whose frames keep their distance
_LEARNED = 16.0  # frames that the mean period is about the mean of
_PULL = 0.25  # share of its distance to the arrivals that a bunch moves towards them


class ArrivalTime:
    """Spaces the frames that arrive in one bunch by the mean period. Not thread-safe.

    Nothing says whether frames were late or lost before a bunch. So they are taken for late: times
    are up to 0.5 s before the arrival, and that is over some ten frames later. Frames that come ten
    times a second or slower have the time of their arrival.
    """

    def __init__(self) -> None:
        self._t: float | None = None
        self._arrived = 0.0
        self._begun = 0.0  # first arrival of this bunch
        self._before_s: float | None = None  # from the first arrival of the bunch before to it
        self._frames = 0  # of this bunch
        self._period_s: float | None = None

    def reconnected(self) -> None:
        """Note a reconnection: the frames before were lost, none is late."""
        self._t = None

    def next(self, t_host: float) -> float:
        """The time of the next frame (s): at most a period after its arrival `t_host` (s)."""
        if self._t is None:
            self._begun, self._before_s, self._frames = t_host, None, 0
            t = t_host
        else:
            pull_s = 0.0
            if t_host - self._arrived > _BUNCH_S:
                pull_s = _PULL * (self._arrived - self._t)
                self._learn()
                self._begun, self._before_s, self._frames = t_host, t_host - self._begun, 0
            t = t_host
            if self._period_s is not None and self._period_s < _MOST_PERIOD_S:
                t = max(self._t + self._period_s + pull_s, t_host - _MOST_LAG_S)
                t = min(t, t_host + self._period_s)
        self._frames += 1
        self._t, self._arrived = t, t_host
        return t

    def _learn(self) -> None:
        """Correct the mean period by the bunch that is over."""
        if self._before_s is None:
            return
        period_s = self._before_s / self._frames
        if self._period_s is not None:
            # Lost frames make a long period: limited, it counts little.
            more_s = min(period_s, 2.0 * self._period_s) - self._period_s
            period_s = self._period_s + more_s * self._frames / (_LEARNED + self._frames)
        self._period_s = min(period_s, _MOST_PERIOD_S)
