"""The search: all designs if they are few, else NSGA-II, and descents from what it found."""

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.stats import qmc

from lumitip.errors import how_to_install
from lumitip_fab.errors import BuildError, InputError, Problem
from lumitip_fab.explore.evaluate import Journal, Record
from lumitip_fab.explore.pool import pool
from lumitip_fab.explore.vary import Changes
from lumitip_fab.pipeline.build import locked
from lumitip_fab.solve.goals import Task
from lumitip_fab.solve.judge import OBJECTIVES, Job, Reference, excesses, judge
from lumitip_fab.solve.judged import Judged, Point, front
from lumitip_fab.solve.ranges import is_number
from lumitip_fab.solve.refine import refine

FEWEST, POPULATION = 8, 24
"""Designs of a generation: of a short search, and of a long one."""
GENETIC = 0.45
"""Share of the designs before the descents, which begin where the genetic search is."""
_END = object()
_REFUSED = 10.0  # excess of a design that is refused
Progress = Callable[[int, int], object]


@dataclass(frozen=True)
class Search:
    """All designs of a search, in the order in which they were asked for."""

    base: Judged
    """With the fixed values."""
    designs: tuple[Judged, ...]
    complete: bool
    """Whether they are all combinations."""
    evaluated: int
    """How many were evaluated now; the others were known."""
    reference: Reference

    @property
    def front(self) -> tuple[Judged, ...]:
        """See `judged.front`."""
        return front(self.designs)


def search(
    task: Task, out: Path, designs: int, seed: int, scheduler: str | None, progress: Progress
) -> Search:
    """Search designs; what the folder's journal knows is not judged again.

    Args:
        task: goals, base and parameters.
        out: folder of the journal.
        designs: that are judged; a last generation is finished.
        seed: of the search.
        scheduler: address of a Dask scheduler; all cores of this machine by default.
        progress: called with how many are done, and of how many at most.

    Raises:
        InputError: if the base is refused.
        OutputError: if the folder cannot be used.
        BuildError: if workers fail, or pymoo is not installed.
    """
    complete = task.designs <= designs
    if not complete:
        _require_pymoo()
    reference = Reference.of(task)
    with locked(out), Journal(out) as journal, pool(judge, POPULATION, scheduler) as evaluated:
        most = min(designs, task.designs)
        judges = _Judges(task, reference, journal, evaluated)
        judges.progress = lambda: progress(min(len(judges.designs), most), most)
        base = judges.judged([()])[0]
        if base.refused:
            place = "base with [fixed]" if task.fixed else "base"
            raise InputError([Problem(place, 0, "", text) for text in base.refused])
        if complete:
            every = list(itertools.product(*(range(len(axis.values)) for axis in task.axes)))
            for begin in range(0, len(every), POPULATION):
                judges(every[begin : begin + POPULATION])
        else:
            generations = _generations(task, designs, seed, judges)
            _until(round(GENETIC * designs), generations, judges)
            refine(task, judges.designs, judges, designs)
            _until(designs, generations, judges)
    return Search(base, tuple(judges.designs.values()), complete, judges.evaluated, reference)


def _until(designs: int, generations: Iterator[None], judges: "_Judges") -> None:
    """Judge generations until there are so many designs; the last is finished."""
    while len(judges.designs) < designs and next(generations, _END) is not _END:
        pass


class _Judges:
    """Judges points of a search, each once."""

    def __init__(
        self,
        task: Task,
        reference: Reference,
        journal: Journal,
        evaluate: Callable[[Sequence[Job]], Iterator[Record]],
    ) -> None:
        self._task, self._reference = task, reference
        self._journal, self._evaluate = journal, evaluate
        self._records: dict[str, Record] = dict(journal.known)
        self.designs: dict[Point, Judged] = {}
        self.evaluated = 0
        self.progress: Callable[[], object] = lambda: None

    def __call__(self, points: Sequence[Point]) -> list[Judged]:
        """The designs at points."""
        new = [point for point in dict.fromkeys(points) if point not in self.designs]
        found = self.judged([_changes(self._task, point) for point in new])
        self.designs.update(zip(new, found, strict=True))
        self.progress()
        return [self.designs[point] for point in points]

    def judged(self, each: Sequence[Changes]) -> list[Judged]:
        """Designs by their changes."""
        jobs = [Job.of(self._task, changes, self._reference) for changes in each]
        missing = {job.key: job for job in jobs if job.key not in self._records}
        for record in self._evaluate(list(missing.values())):
            self._journal.add(record)
            self._records[record["key"]] = record
            self.evaluated += 1
        return [_judged(self._task, job, self._records[job.key]) for job in jobs]


def _require_pymoo() -> None:
    try:
        import pymoo.core.evaluator  # noqa: F401
    except ModuleNotFoundError as error:
        raise BuildError(f"the search needs pymoo: {how_to_install('fab,solve')}") from error


def _changes(task: Task, point: Point) -> Changes:
    return tuple((axis.field, axis.values[n]) for axis, n in zip(task.axes, point, strict=True))


def _judged(task: Task, job: Job, record: Record) -> Judged:
    figures = record.get("figures", {})
    beyond = excesses(figures, task.limits).values() if figures else (_REFUSED,)
    excess = sum(max(of, 0.0) for of in beyond)
    columns = job.config.parameters.grid.columns
    return Judged(job.changes, columns, figures, tuple(record.get("refused", ())), excess)


def _generations(
    task: Task, designs: int, seed: int, judges: Callable[[Sequence[Point]], list[Judged]]
) -> Iterator[None]:
    """Generations of NSGA-II; the first is spread evenly over the values."""
    from pymoo.core.evaluator import Evaluator
    from pymoo.core.mixed import MixedVariableGA
    from pymoo.core.population import Population
    from pymoo.core.problem import Problem as Multi
    from pymoo.core.variable import Choice, Integer
    from pymoo.operators.survival.rank_and_crowding import RankAndCrowding
    from pymoo.problems.static import StaticProblem

    sizes = [len(axis.values) for axis in task.axes]
    ordered = [all(map(is_number, axis.values)) for axis in task.axes]
    names = [str(n) for n in range(len(sizes))]
    variables = {
        name: Integer(bounds=(0, n - 1)) if is_ordered else Choice(options=list(range(n)))
        for name, n, is_ordered in zip(names, sizes, ordered, strict=True)
    }
    problem = Multi(vars=variables, n_obj=len(OBJECTIVES), n_ieq_constr=1)
    size = max(FEWEST, min(POPULATION, designs // 6))
    even = qmc.LatinHypercube(len(sizes), rng=np.random.default_rng(seed)).random(size)
    first = [{n: int(v) for n, v in zip(names, row * sizes, strict=True)} for row in even]
    algorithm = MixedVariableGA(
        pop_size=size,
        sampling=Population.new(X=np.array(first, dtype=object)),
        survival=RankAndCrowding(),
    )
    generations = 50 * (1 + designs // size)  # ends by the number of designs
    algorithm.setup(problem, termination=("n_gen", generations), seed=seed, verbose=False)
    while algorithm.has_next():
        asked = algorithm.ask()
        if asked is None or not len(asked):
            return
        found = judges([tuple(int(of[n]) for n in names) for of in asked.get("X")])
        worst = [1e6] * len(OBJECTIVES)
        values = np.array([one.objectives if one.figures else worst for one in found])
        beyond = np.array([[one.excess] for one in found])
        Evaluator().eval(StaticProblem(problem, F=values, G=beyond), asked)
        algorithm.tell(infills=asked)
        yield
