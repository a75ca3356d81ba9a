"""Frames of known poses from right and wrong fingertips, and the methods to compare.

A wrong fingertip differs from the expected one: gap ± 0.5 mm, detector exponent ± 0.6, scattered
share ± 0.2, hole ± 5 %, and 6 % of spread in the cells' gains.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lumitip.estimation import PoseEstimator
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.processing import Processor
from lumitip.twin import Cable, HalfPlane, Model, Scene, Twin

OFFSET_MM, ANGLE_DEG = 6.0, 34.0
GROSS_MM, GROSS_DEG = 2.0, 10.0
NOISE, GAINS = 1.5, 0.06
Line = tuple[float, float]
Method = Callable[[Floats, str], Line | None]


@dataclass(frozen=True)
class Trial:
    """A frame with its true pose."""

    pose: Line
    values: Floats


def scene(kind: str, pose: Line) -> Scene:
    """An object at an offset (mm) and angle (degrees)."""
    shape = HalfPlane if kind == "edge" else Cable
    return shape(offset_mm=pose[0], angle_deg=pose[1])


def wrong_model(
    layout: Layout, chance: np.random.Generator, gaps_mm: tuple[float, float] = (2.5, 3.5)
) -> Model:
    """Optics that differ from the expected ones."""
    return Model.from_layout(
        layout,
        gap_mm=chance.uniform(*gaps_mm),
        detector_exponent=layout.optics.detector_exponent + chance.uniform(-0.6, 0.6),
        alpha=0.6 + chance.uniform(-0.2, 0.2),
        hole_mm=layout.optics.hole_mm * (1.0 + chance.uniform(-0.05, 0.05)),
    )


def wrong_twin(layout: Layout, seed: int, gaps_mm: tuple[float, float] = (2.5, 3.5)) -> Twin:
    """A finger pair with wrong optics and gains."""
    chance = np.random.default_rng((1, seed))
    gains = 1.0 + GAINS * chance.standard_normal(len(layout))
    return Twin(layout, wrong_model(layout, chance, gaps_mm), gains=np.maximum(gains, 0.5))


def frames(twins: list[Twin], kind: str, count: int, seed: int) -> list[Trial]:
    """Frames of random poses, in whole counts."""
    chance = np.random.default_rng(seed)
    trials = []
    for number in range(count):
        twin = twins[number * len(twins) // count]
        pose = (chance.uniform(-OFFSET_MM, OFFSET_MM), chance.uniform(-ANGLE_DEG, ANGLE_DEG))
        trials.append(Trial(pose, read(twin, scene(kind, pose), chance)))
    return trials


def read(twin: Twin, of: Scene, chance: np.random.Generator) -> Floats:
    """Values with noise, in whole counts."""
    noisy = twin.values(of) + NOISE * chance.standard_normal(len(twin.layout))
    return np.floor(np.clip(noisy, 0.0, 255.0))


def published(layout: Layout) -> Method:
    """Threshold, markers, line: the method of the publication."""
    process = Processor(layout)

    def method(values: Floats, kind: str) -> Line | None:
        contact = process(values)
        if kind == "edge":
            line = contact.line
            return across(line.point_mm, line.angle_deg) if line else None
        cable = contact.cable
        return across(cable.axis_point_mm, cable.angle_deg) if cable else None

    def across(point_mm: tuple[float, float], angle_deg: float) -> Line:
        (x_mm, y_mm), turn = point_mm, np.radians(angle_deg)
        return float(y_mm * np.cos(turn) - x_mm * np.sin(turn)), angle_deg

    return method


def estimated(estimator: PoseEstimator) -> Method:
    """The estimator with the kind of object known."""

    def method(values: Floats, kind: str) -> Line | None:
        found = estimator(values, kind)
        return None if np.isnan(found.offset_mm) else (found.offset_mm, found.angle_deg)

    return method


def misses(method: Method, trials: list[Trial], kind: str) -> Floats:
    """Errors of offset (mm) and angle (degrees) for each frame, shape `(n, 2)`."""
    rows = []
    for trial in trials:
        found = method(trial.values, kind) or (np.inf, np.inf)
        turn = found[1] - trial.pose[1]
        if abs(turn) > 90.0:  # the same line reversed
            found, turn = (-found[0], found[1]), (turn + 90.0) % 180.0 - 90.0
        rows.append((abs(found[0] - trial.pose[0]), abs(turn)))
    return np.array(rows)


def gross(missed: Floats) -> np.ndarray:
    """Mask of the frames with a gross error, shape `(n,)`."""
    return np.asarray((missed[:, 0] > GROSS_MM) | (missed[:, 1] > GROSS_DEG))
