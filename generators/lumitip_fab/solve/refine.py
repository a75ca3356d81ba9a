"""Refinement of a search by gradients: SLSQP of SciPy from several of its designs.

Parameters that are numbers are continuous here, but judged at the nearest value of their range, and
a derivative is the difference to the next value: every design is one that the search could choose.
Names and grids stay those of the start.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
from scipy.optimize import minimize

from lumitip.grid import Floats, Integers
from lumitip_fab.solve.goals import Limits, Task
from lumitip_fab.solve.judge import excesses
from lumitip_fab.solve.judged import Judged, Point, front
from lumitip_fab.solve.ranges import is_number

_ITERATIONS = 8
_LEAST_GAIN = 1e-3
"""Of the error, in an iteration; with less the refinement of a start ends."""
_REFUSED = 10.0
"""Error of a design that is refused, in that of the start; and its excess over each limit."""
Judges = Callable[[Sequence[Point]], list[Judged]]


class _EnoughError(Exception):
    """No more designs may be judged."""


def refine(task: Task, designs: Mapping[Point, Judged], judges: Judges, most: int) -> None:
    """Judge designs along the gradients of the error.

    Args:
        task: with axes and limits.
        designs: that are judged; `judges` adds to them.
        judges: gives the designs at points.
        most: number of designs at which the refinement ends.
    """
    numbers = [all(map(is_number, a.values)) and len(a.values) > 1 for a in task.axes]
    moving = np.flatnonzero(numbers)
    if not moving.size:
        return
    tops = np.array([len(task.axes[n].values) - 1 for n in moving])
    try:
        for start, limits in _starts(task, designs, {int(n) for n in moving}):
            _Descent(start, moving, tops, limits, designs, judges, most).run()
    except _EnoughError:
        return


def _starts(
    task: Task, designs: Mapping[Point, Judged], moving: set[int]
) -> Iterator[tuple[Point, Limits]]:
    """Points to start from, with the limits that hold there.

    First the best design of each combination of names and grids; then those of the front, none of
    which may get dearer or need more current.
    """
    best: dict[Point, tuple[tuple[float, float], Point]] = {}
    for point, one in designs.items():
        if one.figures:
            kind = tuple(value for n, value in enumerate(point) if n not in moving)
            rank = one.excess, one.figures["error"]
            if kind not in best or rank < best[kind][0]:
                best[kind] = rank, point
    for _, point in sorted(best.values()):
        yield point, task.limits
    points = {one.changes: point for point, one in designs.items()}
    for one in front(designs.values()):
        own = {name: one.figures[name] for name in ("cost", "current_ma")}
        held = {name: most for name, most in own.items() if most > 0}  # a share of 0 is none
        yield points[one.changes], task.limits.model_copy(update=held)


class _Descent:
    """The descent of the error from one start; all moving parameters are from 0 to 1."""

    def __init__(
        self,
        start: Point,
        moving: Integers,
        tops: Integers,
        limits: Limits,
        designs: Mapping[Point, Judged],
        judges: Judges,
        most: int,
    ) -> None:
        self._start, self._moving, self._tops, self._limits = start, moving, tops, limits
        self._designs, self._judges, self._most = designs, judges, most

    def run(self) -> None:
        """Descend; the designs on the way are the result.

        Raises:
            _EnoughError: when the next design would be one too many.
        """
        keeps = {
            "type": "ineq",
            "fun": lambda place: self._values(place)[1:],
            "jac": lambda place: self._slopes(place)[1:],
        }
        limited = len(excesses(next(iter(self._judged([self._start]))).figures, self._limits))
        minimize(
            lambda place: self._values(place)[0],
            np.array([self._start[n] for n in self._moving]) / self._tops,
            jac=lambda place: self._slopes(place)[0],
            bounds=[(0.0, 1.0)] * len(self._moving),
            method="SLSQP",
            constraints=[keeps] if limited else [],
            options={"maxiter": _ITERATIONS, "ftol": _LEAST_GAIN},
        )

    def _point(self, place: Floats) -> Point:
        """The point nearest to a place."""
        point = list(self._start)
        steps = np.clip(np.rint(place * self._tops), 0, self._tops)
        for n, step in zip(self._moving, steps, strict=True):
            point[n] = int(step)
        return tuple(point)

    def _values(self, place: Floats) -> Floats:
        return self._figures(self._judged([self._point(place)])[0])

    def _slopes(self, place: Floats) -> Floats:
        """Derivatives of the values, shape `(values, moving parameters)`; judged together."""
        here = self._point(place)
        ways = [1 if here[n] < top else -1 for n, top in zip(self._moving, self._tops, strict=True)]
        beside = [
            (*here[:n], here[n] + way, *here[n + 1 :])
            for n, way in zip(self._moving, ways, strict=True)
        ]
        own, *others = map(self._figures, self._judged([here, *beside]))
        rises = [
            (other - own) * way * top
            for other, way, top in zip(others, ways, self._tops, strict=True)
        ]
        return np.stack(rises, axis=1)

    def _figures(self, one: Judged) -> Floats:
        """The error, and how far each limit is kept; below 0 beyond it."""
        if not one.figures:
            start = self._designs[self._start].figures
            named = excesses(start, self._limits)
            return np.array([_REFUSED * start["error"], *[-_REFUSED] * len(named)])
        over = excesses(one.figures, self._limits).values()
        return np.array([one.figures["error"], *(-share for share in over)])

    def _judged(self, points: Sequence[Point]) -> list[Judged]:
        new = {point for point in points if point not in self._designs}
        if len(self._designs) + len(new) > self._most:
            raise _EnoughError
        return self._judges(points)
