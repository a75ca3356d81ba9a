"""Lines that a frame hardly shows: the mean of all poses that would read alike.

Between two rows of cells an edge moves without any cell seeing it. The best fit then lies anywhere
in between; the mean of the likelihood lies in the middle, and misses less.
"""

import numpy as np

from lumitip.estimation.fit import Fit
from lumitip.estimation.shapes import Shape
from lumitip.grid import Floats

OFFSET_SD_MM, ANGLE_SD_DEG = 0.1, 0.4
"""Standard deviations from which on the mean is taken."""
_POINTS = 13
_MOST = np.array([np.radians(5.0), 1.2])  # rad, mm


def likely(shape: Shape, found: Fit, deviations: Floats) -> Floats:
    """The pose with angle and offset of the likelihood's mean; all else stays.

    Args:
        shape: an edge.
        found: the best fit.
        deviations: of its angle (rad) and offset (mm).
    """
    frame, pose = found.frame, found.pose
    reach = np.minimum(3.0 * deviations, _MOST)
    line = np.linspace(-1.0, 1.0, _POINTS)
    steps = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2) * reach
    poses = pose[:2] + steps
    miss = (frame.light - pose[-2] + pose[-1] * shape.shares(poses, pose[2:-2])) * frame.scale
    miss[frame.full & (miss < 0.0)] = 0.0
    size = np.minimum(np.abs(miss), frame.huber)
    losses = (size * (2.0 * np.abs(miss) - size)).sum(axis=1)
    # A misfit that no pose explains must not make one of them look certain.
    spare = max(float(losses.min()) / frame.light.size, 1.0)
    weights = np.exp(-0.5 * (losses - losses.min()) / spare)
    moved = pose.copy()
    moved[:2] += weights @ steps / weights.sum()
    return moved
