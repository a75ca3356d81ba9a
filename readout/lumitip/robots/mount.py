"""`Mount`: place of the fingertip on the tool, and velocities in other coordinate frames.

Three frames: the sensor frame of the receiving finger (mm; x to the right, y towards the tip, z out
of its face), the tool frame of the arm (its tool centre point, as set on the controller) and the
arm's base. Poses and twists of an arm are in m and rad: `(x, y, z, rx, ry, rz)`; the last three
numbers of a pose are a rotation vector, and a twist is that of the tool centre point.
"""

import math
from dataclasses import dataclass

import numpy as np

from lumitip import arguments
from lumitip.control import Command
from lumitip.errors import LumitipError
from lumitip.grid import Floats
from lumitip.values import shown

Vector = tuple[float, float, float]
_TOLERANCE = 1e-3


class ArmError(LumitipError):
    """An arm that cannot be reached, or invalid limits or mount."""


@dataclass(frozen=True, slots=True)
class Mount:
    """The sensor frame in the tool frame of the arm.

    A gripper on a UR arm points along the tool's z. With the fingers opening along the tool's y, a
    receiver on the side of +y looks along -y: `Mount(x=(1, 0, 0), y=(0, 0, 1))`.
    """

    x: Vector
    """Direction of the sensor's x, which the tracer calls forward."""
    y: Vector
    """Direction of the sensor's y, towards the fingertip's end."""
    origin_mm: Vector = (0.0, 0.0, 0.0)
    """The middle of the sensor's cells, from the tool centre point."""

    def __post_init__(self) -> None:
        axes = np.full((3, 3), np.nan)
        for row, name in enumerate(("x", "y", "origin_mm")):
            axis = arguments.numbers(getattr(self, name), name, ArmError)
            if axis.shape != (3,) or not np.isfinite(axis).all():
                raise ArmError(f"{name} is {shown(getattr(self, name))}; three numbers are needed")
            axes[row] = axis
        off = max(abs(math.hypot(*self.x) - 1), abs(math.hypot(*self.y) - 1))
        if max(off, abs(float(axes[0] @ axes[1]))) > _TOLERANCE:
            raise ArmError(
                f"x is {self.x}, y is {self.y}; both must have length 1 and be perpendicular"
            )

    @property
    def rotation(self) -> Floats:
        """Columns are the sensor's x, y and z in the tool frame, shape `(3, 3)`."""
        x = np.array(self.x, float)
        x /= np.linalg.norm(x)
        y = np.array(self.y, float)
        y -= x * (x @ y)
        y /= np.linalg.norm(y)
        return np.column_stack([x, y, np.cross(x, y)])

    def tool_twist(self, command: Command) -> Floats:
        """Twist of the tool centre point, in the tool frame, for a command; `(6,)`."""
        axes = self.rotation
        turn = axes[:, 2] * command.rotation_rad_s
        velocity = axes @ (command.forward_mm_s, command.lateral_mm_s, 0.0) / 1000.0
        arm_m = np.array(self.origin_mm) / 1000.0
        return np.concatenate([velocity - np.cross(turn, arm_m), turn])

    def command(self, twist: Floats) -> Command:
        """Motion of the fingertip, in the plane of the sensor, at a twist of the tool centre
        point in the tool frame."""
        velocity, turn = twist[:3], twist[3:]
        moved = velocity + np.cross(turn, np.array(self.origin_mm) / 1000.0)
        forward, lateral, _ = self.rotation.T @ moved * 1000.0
        return Command(float(forward), float(lateral), float(self.rotation[:, 2] @ turn))

    def origin_in_base_mm(self, pose: Floats) -> Floats:
        """The middle of the cells in the arm's base at a pose of the tool centre point, `(3,)`."""
        origin_mm: Floats = pose[:3] * 1000.0 + rotation_of(pose) @ np.array(self.origin_mm)
        return origin_mm

    def speed_of_origin_mm_s(self, pose: Floats, twist: Floats) -> float:
        """Speed of the middle of the cells at a pose and twist in the base."""
        arm_mm = rotation_of(pose) @ np.array(self.origin_mm)
        return float(np.linalg.norm(twist[:3] * 1000.0 + np.cross(twist[3:], arm_mm)))


def in_base(pose: Floats, twist: Floats) -> Floats:
    """A twist in tool axes, expressed in base axes; `(6,)`."""
    axes = rotation_of(pose)
    return np.concatenate([axes @ twist[:3], axes @ twist[3:]])


def in_tool(pose: Floats, twist: Floats) -> Floats:
    """A twist in base axes, expressed in tool axes; `(6,)`."""
    axes = rotation_of(pose).T
    return np.concatenate([axes @ twist[:3], axes @ twist[3:]])


def rotation_of(pose: Floats) -> Floats:
    """Columns are the tool's axes in the base, shape `(3, 3)`: Rodrigues' formula."""
    angle = float(np.linalg.norm(pose[3:]))
    if angle < 1e-12:
        return np.eye(3)
    x, y, z = pose[3:] / angle
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turned: Floats = np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross
    return turned
