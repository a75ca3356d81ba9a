"""Speed of the light in MuJoCo on one core, without the physics: rigid shapes, cloth and rope.

Run by `make bench`.
"""

import sys
import time

import mujoco
import numpy as np

from common import PUBLISHED, Goals, layout_of, on_one_core
from lumitip.mujoco import LightSensor, fingers, open_fingers

GOAL_RIGID, GOAL_CLOTH = 1_000.0, 200.0
GAP_MM = 3.3  # between the gaps that the sensor computes, so that it interpolates
GEOM = mujoco.mjtGeom
LAYOUT = layout_of(PUBLISHED, 6.0)


def box(spec: mujoco.MjSpec) -> None:
    """An edge."""
    spec.worldbody.add_geom(type=GEOM.mjGEOM_BOX, size=[0.1, 0.05, 2e-4], pos=[0, -0.05, 1e-4])


def corner(spec: mujoco.MjSpec) -> None:
    """A corner of a box."""
    spec.worldbody.add_geom(type=GEOM.mjGEOM_BOX, size=[0.05, 0.05, 2e-4], pos=[0.05, -0.05, 1e-4])


def plate(spec: mujoco.MjSpec) -> None:
    """A small box, all of whose corners are seen."""
    spec.worldbody.add_geom(type=GEOM.mjGEOM_BOX, size=[4e-3, 3e-3, 2e-4], pos=[0, 0, 1e-4])


def cable(spec: mujoco.MjSpec) -> None:
    """A capsule."""
    ends = [-0.08, 0.0, 1e-4, 0.08, 0.002, 1e-4]
    spec.worldbody.add_geom(type=GEOM.mjGEOM_CAPSULE, fromto=ends, size=[0.0015, 0.0, 0.0])


def cables(spec: mujoco.MjSpec) -> None:
    """Two capsules that cross, at different heights: ray by ray."""
    cable(spec)
    ends = [-0.04, -0.06, 0.001, 0.04, 0.06, 0.001]
    spec.worldbody.add_geom(type=GEOM.mjGEOM_CAPSULE, fromto=ends, size=[0.0005, 0.0, 0.0])


def cloth(spec: mujoco.MjSpec) -> None:
    """A cloth of 625 points with its edge among the cells."""
    body = spec.worldbody.add_body(name="cloth_body", pos=[0.0, 0.048, 1e-4])
    body.make_flex(
        "cloth", type="grid", dim=2, count=[25, 25, 1], spacing=[4e-3] * 3, radius=2e-4,
        mass=0.01, equality=1,
    )  # fmt: skip


SHAPES = {
    "edge": box,
    "corner": corner,
    "plate": plate,
    "cable": cable,
    "two cables": cables,
    "cloth": cloth,
}


def closing() -> float:
    """Processor time of the frames while plates close on a cable from 8 mm on (s)."""
    spec = fingers(LAYOUT)
    cable(spec)
    model = spec.compile()
    data = mujoco.MjData(model)
    sensor = LightSensor(model, LAYOUT)
    begun = time.process_time()
    for opening_mm in np.linspace(8.0, 3.0, 100):
        open_fingers(model, data, float(opening_mm))
        sensor.values(data)
    return time.process_time() - begun


def rate(name: str, folded: bool = False) -> float:
    """Print a line; frames in a second of processor time."""
    spec = fingers(LAYOUT)
    SHAPES[name](spec)
    model = spec.compile()
    data = mujoco.MjData(model)
    open_fingers(model, data, GAP_MM)
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
    rate("two cables")
    print(f"first grasp, 100 frames from 8 to 3 mm with all that they compute: {closing():.1f} s")
    rigid = min(rate(name) for name in ("edge", "corner", "plate", "cable"))
    goals.at_least("slowest rigid shape", rigid, GOAL_RIGID, "frames/s")
    goals.at_least("cloth", min(rate("cloth"), rate("cloth", True)), GOAL_CLOTH, "frames/s")
    return goals.exit_code()


if __name__ == "__main__":
    on_one_core()
    sys.exit(main())
