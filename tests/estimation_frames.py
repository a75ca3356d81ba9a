"""What the tests of the estimation share: how far an estimator misses frames of known pose."""

from collections.abc import Callable, Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from lumitip.estimation import PoseEstimator

Floats = NDArray[np.float64]
Pose = tuple[float, float]
Frames = Callable[..., Iterator[tuple[Pose, Floats]]]


def misses(
    estimator: PoseEstimator, frames: Iterable[tuple[Pose, Floats]], kind: str | None
) -> Floats:
    """Offset (mm) and angle (degrees) that each frame is missed by, shape `(n, 2)`."""
    rows = []
    for (offset_mm, angle_deg), values in frames:
        told = estimator(values, kind)
        turn = told.angle_deg - angle_deg
        offset = -told.offset_mm if abs(turn) > 90.0 else told.offset_mm
        rows.append((abs(offset - offset_mm), abs((turn + 90.0) % 180.0 - 90.0)))
    return np.array(rows)
