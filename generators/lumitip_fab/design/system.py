"""From the robot's tool flange to the fingers, along one axis.

Tool frame: origin in the middle of the robot's tool flange, z out of it towards the fingers, x
along the opening from the receiver to the emitter. A design without the printed flange begins at
the gripper's own face. The locating pin of the coupling is taken to be in x.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class System:
    """Where everything is on that axis, and what the gripper looks like from outside."""

    robot_mm: float
    """Diameter of the robot's tool flange; 0 without a coupling."""
    coupling_mm: float
    """From there to the coupling's face; 0 without one."""
    gripper_z_mm: float
    """Where the gripper stands."""
    width_mm: float
    """Of the gripper's body, along the opening."""
    depth_mm: float
    corner_mm: float
    length_mm: float
    reach_mm: float
    """From where the gripper stands to the mount plane of the fingers, closed."""
    load_kg: float
    """Of the gripper and what it may hold, taken to be at the tool centre point."""
    confidence: str
    """How far to trust the figures of the gripper's body."""
    holders: tuple[str, ...]
    """Names of the holders that go round that body."""
    holder_z_mm: float
    """Middle of those."""
