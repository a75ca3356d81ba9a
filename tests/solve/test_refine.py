"""Descents from judged designs, on errors that are computed here: a bowl for each grid."""

from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from goals_file import write_goals
from lumitip_fab.solve.goals import Task, read_goals
from lumitip_fab.solve.judge import excesses
from lumitip_fab.solve.judged import Judged, Point, front
from lumitip_fab.solve.refine import refine

GOALS = """\
[goals]
edge_mm = 0.1
[limits]
cost = {cost}
[vary]
grid.columns = [[5, 4, 5, 4, 5, 4, 5], [4, 5, 4, 5, 4, 5, 4]]
{vary}
"""
NUMBERS = """\
mask.hole_mm = { from = 2.0, to = 5.0, step = 0.1 }
stack.silicone_mm = { from = 1.4, to = 2.5, step = 0.1 }
"""
DEEPER = 0.2
"""How much smaller errors of the second grid are."""
MakeTask = Callable[..., Task]


class Bowl:
    """Judges whose error is least at 3.3 mm and 2.1 mm; a larger hole is dearer."""

    def __init__(
        self, task: Task, refused_from_mm: float = 9.0, price: float = 1.0, least: float = 1.0
    ) -> None:
        self._task, self._refused_from_mm, self._price = task, refused_from_mm, price
        self._least = least
        self.designs: dict[Point, Judged] = {}

    def __call__(self, points: Sequence[Point]) -> list[Judged]:
        for point in points:
            self.designs.setdefault(point, self._judged(point))
        return [self.designs[point] for point in points]

    def _judged(self, point: Point) -> Judged:
        changes = tuple((a.field, a.values[n]) for a, n in zip(self._task.axes, point, strict=True))
        values = dict(changes)
        hole_mm, silicone_mm = values["mask.hole_mm"], values["stack.silicone_mm"]
        columns = values["grid.columns"]
        if hole_mm >= self._refused_from_mm:
            return Judged(changes, columns, {}, ("too large",), 10.0)
        error = 1.0 + (hole_mm - 3.3) ** 2 + 3.0 * (silicone_mm - 2.1) ** 2
        error = self._least * (error - DEEPER * (columns[0] == 4))
        cost = self._price * (40.0 + hole_mm)
        figures = {"error": error, "cost": cost, "current_ma": 10.0}
        excess = sum(max(share, 0.0) for share in excesses(figures, self._task.limits).values())
        return Judged(changes, columns, figures, (), excess)


@pytest.fixture
def make(tmp_path: Path) -> MakeTask:
    def task(cost: float = 60.0, vary: str = NUMBERS) -> Task:
        return read_goals(write_goals(tmp_path, GOALS, cost=cost, vary=vary))

    return task


def _refined(bowl: Bowl, task: Task, most: int = 120) -> dict[str, object]:
    """Changes of the best design, from one bad design of each grid."""
    bowl([(0, 1, 1), (1, 28, 10)])
    refine(task, bowl.designs, bowl, most)
    assert len(bowl.designs) <= most
    return dict(front(bowl.designs.values())[0].changes)


def test_it_descends_from_the_best_of_each_grid(make: MakeTask) -> None:
    task = make()
    bowl = Bowl(task)
    best = _refined(bowl, task)
    assert best["grid.columns"] == (4, 5, 4, 5, 4, 5, 4)
    for columns, least in ((5, 1.0), (4, 1.0 - DEEPER)):
        errors = [d.figures["error"] for d in bowl.designs.values() if d.columns[0] == columns]
        assert min(errors) == pytest.approx(least, abs=0.03)


def test_it_ends_on_a_limit(make: MakeTask) -> None:
    task = make(cost=42.55)
    assert _refined(Bowl(task), task)["mask.hole_mm"] == pytest.approx(2.5, abs=0.051)


@pytest.mark.parametrize("least", [1.0, 20.0])
def test_refused_designs_do_not_stop_it(make: MakeTask, least: float) -> None:
    task = make()
    bowl = Bowl(task, refused_from_mm=3.0, least=least)
    bowl([(0, 1, 1)])
    refine(task, bowl.designs, bowl, 60)
    assert front(bowl.designs.values())[0].figures["error"] < 1.5 * least


def test_designs_that_cost_nothing_have_no_limit_of_their_own(make: MakeTask) -> None:
    task = make()
    bowl = Bowl(task, price=0.0)
    assert _refined(bowl, task)["mask.hole_mm"] == pytest.approx(3.3, abs=0.051)


def test_no_design_too_many_and_none_twice(make: MakeTask) -> None:
    task = make()
    bowl = Bowl(task)
    _refined(bowl, task, most=7)
    assert 2 < len(bowl.designs) <= 7
    again = Bowl(task)
    _refined(again, task, most=7)
    assert list(again.designs) == list(bowl.designs)


def test_names_alone_have_no_gradient(make: MakeTask) -> None:
    task = make(vary='mask.hole_shape = ["hexagon", "circle"]')

    def judges(_: Sequence[Point]) -> list[Judged]:
        raise AssertionError("nothing is to be judged")

    refine(task, {}, judges, 10)
