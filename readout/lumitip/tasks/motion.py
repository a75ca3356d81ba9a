"""Motion of fingers in the plane of an object, for one finger or arrays of them."""

import math

import numpy as np

from lumitip.grid import Floats
from lumitip.twin.lines import Numbers


def advance(
    pose: Floats, velocity: Floats, asked: Floats, dt_s: float, lag_s: float
) -> tuple[Floats, Floats]:
    """Pose and velocity a time later, with the lag of the actuator; velocities are exact.

    Args:
        pose: x, y (mm) and heading (rad), shape `(..., 3)`.
        velocity: forward, lateral (mm/s) and turning (rad/s), of the same shape.
        asked: the commanded velocity, of the same shape.
        dt_s: the time (s).
        lag_s: time constant of the velocity (s).
    """
    kept = math.exp(-dt_s / lag_s) if lag_s else 0.0
    moved = asked * dt_s + (velocity - asked) * lag_s * (1.0 - kept)
    middle = pose[..., 2] + 0.5 * moved[..., 2]
    cos, sin = np.cos(middle), np.sin(middle)
    step = np.stack(
        [
            moved[..., 0] * cos - moved[..., 1] * sin,
            moved[..., 0] * sin + moved[..., 1] * cos,
            moved[..., 2],
        ],
        axis=-1,
    )
    return pose + step, asked + (velocity - asked) * kept


def in_sensor(x_mm: Numbers, y_mm: Numbers, pose: Floats) -> tuple[Numbers, Numbers]:
    """Places in the sensor frame of fingers (mm).

    Args:
        x_mm, y_mm: the places (mm).
        pose: of the fingers, shape `(..., 3)`.
    """
    x, y = x_mm - pose[..., 0], y_mm - pose[..., 1]
    cos, sin = np.cos(pose[..., 2]), np.sin(pose[..., 2])
    return x * cos + y * sin, y * cos - x * sin
