"""Speed of the light in MuJoCo on one core, without the physics: rigid shapes, cloth and rope.

Run by `make bench`.
"""

import sys
import time

import mujoco

from common import PUBLISHED, Goals, layout_of, on_one_core
from lumitip.mujoco import LightSensor, fingers

GOAL_RIGID, GOAL_CLOTH = 1_000.0, 200.0
GEOM = mujoco.mjtGeom
LAYOUT = layout_of(PUBLISHED, 6.0)


def box(spec: mujoco.MjSpec) -> None:
    """An edge."""
    spec.worldbody.add_geom(type=GEOM.mjGEOM_BOX, size=[0.1, 0.05, 2e-4], pos=[0, -0.05, 0])


def corner(spec: mujoco.MjSpec) -> None:
    """A corner of a box."""
    spec.worldbody.add_geom(type=GEOM.mjGEOM_BOX, size=[0.05, 0.05, 2e-4], pos=[0.05, -0.05, 0])


def plate(spec: mujoco.MjSpec) -> None:
    """A small box, all of whose corners are seen."""
    spec.worldbody.add_geom(type=GEOM.mjGEOM_BOX, size=[4e-3, 3e-3, 2e-4])


def cable(spec: mujoco.MjSpec) -> None:
    """A capsule."""
    ends = [-0.08, 0.0, 0.0, 0.08, 0.002, 0.0]
    spec.worldbody.add_geom(type=GEOM.mjGEOM_CAPSULE, fromto=ends, size=[0.0015, 0.0, 0.0])


def cloth(spec: mujoco.MjSpec) -> None:
    """A cloth of 625 points with its edge among the cells."""
    body = spec.worldbody.add_body(name="cloth_body", pos=[0.0, 0.048, 0.0])
    body.make_flex(
        "cloth", type="grid", dim=2, count=[25, 25, 1], spacing=[4e-3] * 3, radius=2e-4,
        mass=0.01, equality=1,
    )  # fmt: skip


def rate(name: str, folded: bool = False) -> float:
    """Print a line; frames in a second of processor time."""
    spec = fingers(LAYOUT)
    {"edge": box, "corner": corner, "plate": plate, "cable": cable, "cloth": cloth}[name](spec)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[:2] = 0.0015
    mujoco.mj_forward(model, data)
    if folded:
        points = data.flexvert_xpos
        points[points[:, 1] > 0.012, 1] *= -1.0
    sensor = LightSensor(model, LAYOUT)
    sensor.values(data)
    begun, frames = time.process_time(), 0
    while time.process_time() < begun + 2.0:
        sensor.values(data)
        frames += 1
    frames_s = frames / (time.process_time() - begun)
    print(f"{name + (', folded' if folded else ''):<20}{frames_s:>10,.0f} frames/s")
    return frames_s


def main() -> int:
    """Print everything; the exit code."""
    goals = Goals()
    rigid = min(rate(name) for name in ("edge", "corner", "plate", "cable"))
    goals.at_least("slowest rigid shape", rigid, GOAL_RIGID, "frames/s")
    goals.at_least("cloth", min(rate("cloth"), rate("cloth", True)), GOAL_CLOTH, "frames/s")
    return goals.exit_code()


if __name__ == "__main__":
    on_one_core()
    sys.exit(main())
