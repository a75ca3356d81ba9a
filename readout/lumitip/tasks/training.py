"""Training of a `Policy`: it learns to do what a teacher does who sees the true line ahead.

The policy steers itself, and the teacher says at each frame what it should have done (DAgger,
Ross et al. 2011, arXiv:1011.0686). Every fingertip has other optics, gains, dead cells and lag.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from lumitip import arguments
from lumitip.grid import Floats, Integers
from lumitip.layout import Layout
from lumitip.tasks.batch import TaskBatch
from lumitip.tasks.policy import FASTEST_MM_S, SCALE, Inputs, Memory, Policy, layers, within
from lumitip.tasks.task import KINDS, RATE_HZ, Settings, TaskError
from lumitip.twin import Model, Twin
from lumitip.values import shown

GAIN_PER_S, TURN_PER_S, AHEAD_S = 24.0, 12.0, 0.1
"""Of the teacher: `LineLaw` with the true line, which turns to where the line goes after a time."""
_STEEPEST, _FARTHEST_MM = 1.2, 9.0
_SLOWEST_MM_S = 50.0
_HIDDEN = (128, 64)
_SHAKE = np.array([10.0, 60.0, 1.5])  # spread of the teacher's commands in the first round
_GAP_MM, _EXPONENT, _ALPHA, _HOLE, _GAINS = 0.6, 0.7, 0.25, 0.06, 0.07
_MOST_DEAD, _LAG_S = 3, (0.02, 0.04)
_FAST, _SLOW = 2e-3, 2e-4  # learning rates


@dataclass(frozen=True)
class Schedule:
    """How long a training is."""

    rounds: int = 8
    fingertips: int = 24
    tasks: int = 24
    """Of each fingertip, at once."""
    frames: int = 130
    """Of each task in a round."""
    steps: int = 600
    """Of learning after a round; after the last one ten times as many."""
    batch: int = 1024
    """Frames in a step."""


def train(
    layout: Layout,
    kind: str,
    seed: int = 0,
    rate_hz: float = RATE_HZ,
    schedule: Schedule | None = None,
    say: Callable[[str], object] = print,
) -> Policy:
    """Train a policy. The same seed gives the same policy with the same numpy and its libraries.

    Args:
        layout: the cells.
        kind: `"cloth"` or `"cable"`.
        seed: of fingertips, curves and weights.
        rate_hz: frames and commands in a second.
        schedule: its length; the default takes minutes.
        say: called with a line after each round.

    Raises:
        LayoutError: if `layout` is no layout.
        TaskError: if the kind is unknown, the rate not above 0, or the seed no whole number from 0
            on.
    """
    arguments.layout(layout)
    if not isinstance(kind, str) or kind not in KINDS:
        raise TaskError(f"kind is {shown(kind)}; allowed are {', '.join(KINDS)}")
    seed = arguments.count(seed, "seed", 0, TaskError)
    rate_hz = arguments.number(rate_hz, "rate_hz", above=0.0, error=TaskError)
    schedule = Schedule() if schedule is None else schedule
    chance = np.random.default_rng((11, seed))
    lessons = [
        _Lesson(layout, kind, rate_hz, seed, number, schedule.tasks)
        for number in range(schedule.fingertips)
    ]
    network = _Network((Memory.size(len(layout)), *_HIDDEN, len(SCALE)), chance)
    seen: list[Inputs] = []
    wanted: list[Inputs] = []

    def policy() -> Policy:
        return Policy(kind, layout.design_hash, rate_hz, seed, network.weights, network.biases)

    for number in range(schedule.rounds):
        driver = policy() if number else None
        for lesson in lessons:
            inputs, outputs = lesson.drive(driver, schedule.frames)
            seen.append(inputs)
            wanted.append(outputs)
        last = number == schedule.rounds - 1
        misfit = network.learn(np.concatenate(seen), np.concatenate(wanted), schedule, last, chance)
        lost, ended = (sum(of) for of in zip(*(each.score() for each in lessons), strict=True))
        say(
            f"round {number + 1} of {schedule.rounds}: {lost} of {ended} curves lost, commands off "
            f"by {misfit:.3f} rms"
        )
    return policy()


class _Lesson:
    """Tasks of one fingertip, the teacher, and what a pupil would see."""

    def __init__(
        self, layout: Layout, kind: str, rate_hz: float, seed: int, number: int, tasks: int
    ) -> None:
        self._chance = np.random.default_rng((12, seed, number))
        settings = Settings(
            kind,
            rate_hz=rate_hz,
            dead_cells=min(number % (_MOST_DEAD + 1), len(layout) - 1),
            lag_s=self._chance.uniform(*_LAG_S),
        )
        self._tasks = TaskBatch(tasks, layout, settings, _fingertip(layout, self._chance))
        self._memory = Memory(tasks, len(layout))
        self._seeds = self._own_seeds(number)
        self._speed_mm_s = np.zeros(tasks)
        self._values = np.zeros((tasks, len(layout)))
        self._lost = self._ended = 0
        self._begin(np.arange(tasks))

    def drive(self, driver: Policy | None, frames: int) -> tuple[Inputs, Inputs]:
        """What a driver sees in some frames, by default a teacher who is shaken, and what the
        teacher would do, as shares of `SCALE`."""
        seen, wanted = [], []
        for _ in range(frames):
            inputs = self._memory.see(self._values, self._speed_mm_s)
            right = self._right()
            if driver is None:
                done = within(right + _SHAKE * self._chance.standard_normal(right.shape))
            else:
                done = driver(inputs)
            self._memory.act(done)
            seen.append(inputs)
            wanted.append((right / SCALE).astype(np.float32))
            self._values = self._tasks.step(done)
            if (over := np.flatnonzero(self._tasks.ended)).size:
                self._lost += int(self._tasks.lost.sum())
                self._ended += over.size
                self._begin(over)
        return np.concatenate(seen), np.concatenate(wanted)

    def score(self) -> tuple[int, int]:
        """Curves lost and ended since the last call."""
        lost, ended, self._lost, self._ended = self._lost, self._ended, 0, 0
        return lost, ended

    def _right(self) -> Floats:
        """The commands of the teacher, shape `(tasks, 3)`."""
        height_mm, angle = (np.asarray(of) for of in self._tasks.line())
        angle = np.clip(angle, -_STEEPEST, _STEEPEST)
        forward = self._speed_mm_s * np.cos(angle)
        near_mm = np.clip(height_mm, -_FARTHEST_MM, _FARTHEST_MM)
        lateral = GAIN_PER_S * near_mm + forward * np.tan(angle)
        ahead = self._tasks.direction_ahead(self._speed_mm_s * AHEAD_S)
        return within(np.stack([forward, lateral, TURN_PER_S * ahead], axis=1))

    def _begin(self, tasks: Integers) -> None:
        self._values = self._values.copy()
        self._values[tasks] = self._tasks.reset(tasks.tolist(), [next(self._seeds) for _ in tasks])
        self._speed_mm_s[tasks] = self._chance.uniform(_SLOWEST_MM_S, FASTEST_MM_S, len(tasks))
        self._memory.forget(tasks)

    @staticmethod
    def _own_seeds(number: int) -> Iterator[int]:
        """Seeds of curves that no other lesson has, and no test."""
        first = 1_000_000 * (number + 1)
        yield from range(first, first + 1_000_000)


def _fingertip(layout: Layout, chance: np.random.Generator) -> Twin:
    """A fingertip with its own optics and gains."""
    off = chance.uniform(-1.0, 1.0, 4)
    straight = Model.from_layout(layout)
    model = Model.from_layout(
        layout,
        gap_mm=straight.gap_mm + _GAP_MM * off[0],
        detector_exponent=max(layout.optics.detector_exponent + _EXPONENT * off[1], 0.0),
        alpha=straight.alpha + _ALPHA * off[2],
        hole_mm=layout.optics.hole_mm * (1.0 + _HOLE * off[3]),
    )
    gains = 1.0 + _GAINS * chance.standard_normal(len(layout))
    return Twin(layout, model, gains=np.maximum(gains, 0.5))


class _Network:
    """Layers that learn by Adam (Kingma and Ba 2015, arXiv:1412.6980)."""

    def __init__(self, sizes: tuple[int, ...], chance: np.random.Generator) -> None:
        self.weights = [
            (chance.standard_normal((ins, outs)) / np.sqrt(ins)).astype(np.float32)
            for ins, outs in pairwise(sizes)
        ]
        self.biases = [np.zeros(outs, np.float32) for outs in sizes[1:]]
        self._means = [np.zeros_like(each) for each in self._all]
        self._squares = [np.zeros_like(each) for each in self._all]
        self._count = 0

    @property
    def _all(self) -> list[Inputs]:
        return [*self.weights, *self.biases]

    def learn(
        self,
        inputs: Inputs,
        wanted: Inputs,
        schedule: Schedule,
        last: bool,
        chance: np.random.Generator,
    ) -> float:
        """Take the steps after a round; the rms misfit over the last hundred."""
        steps = schedule.steps * (10 if last else 1)
        squares = []
        for step in range(steps):
            # The last steps are ever smaller.
            rate = _FAST * (_SLOW / _FAST) ** (step / steps) if last else _FAST
            some = chance.integers(len(inputs), size=schedule.batch)
            squares.append(self._step(inputs[some], wanted[some], rate))
        return float(np.sqrt(np.mean(squares[-100:])))

    def _step(self, inputs: Inputs, wanted: Inputs, rate: float) -> float:
        found = layers(inputs, self.weights, self.biases)
        off = found[-1] - wanted
        steep = off / np.float32(len(inputs))
        of_weights, of_biases = [], []
        for number in reversed(range(len(self.weights))):
            of_weights.append(found[number].T @ steep)
            of_biases.append(steep.sum(axis=0))
            if number:
                steep = (steep @ self.weights[number].T) * (1.0 - found[number] ** 2)
        self._count += 1
        slopes = [*of_weights[::-1], *of_biases[::-1]]
        parts = zip(self._all, slopes, self._means, self._squares, strict=True)
        for part, slope, mean, square in parts:
            np.add(mean, 0.1 * (slope - mean), out=mean)
            np.add(square, 0.001 * (slope**2 - square), out=square)
            size = np.sqrt(square / (1.0 - 0.999**self._count)) + 1e-8
            np.subtract(part, rate * mean / (1.0 - 0.9**self._count) / size, out=part)
        return float((off**2).mean())
