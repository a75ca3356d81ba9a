"""Frames of known poses, as the twin reads them."""

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from numpy.typing import NDArray

from lumitip import Layout
from lumitip.estimation import PoseEstimator
from lumitip.links.twin import published_layout
from lumitip.twin import Cable, HalfPlane, Model, Twin

Floats = NDArray[np.float64]
Pose = tuple[float, float]
Frames = Callable[..., Iterator[tuple[Pose, Floats]]]


@pytest.fixture(scope="session")
def cells() -> Layout:
    """The published layout."""
    return published_layout()


@pytest.fixture(scope="session")
def estimator(cells: Layout) -> PoseEstimator:
    """With the optics of the layout."""
    return PoseEstimator(cells)


@pytest.fixture(scope="session")
def twin(cells: Layout) -> Twin:
    """With the same optics."""
    return Twin(cells)


@pytest.fixture(scope="session")
def wrong_twins(cells: Layout) -> list[Twin]:
    """Fingertips of other optics and gains than the estimator expects."""
    made = []
    for seed in range(8):
        chance = np.random.default_rng(seed)
        model = Model.from_layout(
            cells,
            gap_mm=3.0 + chance.uniform(-0.5, 0.5),
            detector_exponent=2.0 + chance.uniform(-0.6, 0.6),
            alpha=0.6 + chance.uniform(-0.2, 0.2),
            hole_mm=2.5 * (1.0 + chance.uniform(-0.05, 0.05)),
        )
        gains = 1.0 + 0.06 * chance.standard_normal(len(cells))
        made.append(Twin(cells, model, gains=gains))
    return made


@pytest.fixture(scope="session")
def frames() -> Frames:
    """`frames(kind, twins, count)`: poses (offset, angle) and noisy frames in whole counts."""

    def made(
        kind: str, twins: list[Twin], count: int, noise: float = 1.5
    ) -> Iterator[tuple[Pose, Floats]]:
        chance = np.random.default_rng(count)
        for number in range(count):
            twin = twins[number * len(twins) // count]
            pose = (chance.uniform(-6.0, 6.0), chance.uniform(-34.0, 34.0))
            shape = HalfPlane if kind == "edge" else Cable
            values = twin.values(shape(offset_mm=pose[0], angle_deg=pose[1]))
            values = values + noise * chance.standard_normal(values.size)
            yield pose, np.floor(np.clip(values, 0.0, 255.0))

    return made
