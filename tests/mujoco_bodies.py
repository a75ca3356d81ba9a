"""Bodies between the fingers of a MuJoCo model, for tests of their light."""

from collections.abc import Callable

import mujoco
import numpy as np

from lumitip.grid import Floats
from lumitip.links.twin import published_layout
from lumitip.mujoco import LightSensor, fingers, open_fingers
from lumitip.twin import Twin

GEOM = mujoco.mjtGeom
LAYOUT = published_layout()
TWIN = Twin(LAYOUT)
MOST_COUNTS = 2.0
Add = Callable[[mujoco.MjSpec], object]


def state(add: Add, gap_mm: float = 3.0) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """A model of plates at a gap with something between them, and its state."""
    spec = fingers(LAYOUT)
    add(spec)
    model = spec.compile()
    data = mujoco.MjData(model)
    open_fingers(model, data, gap_mm)
    return model, data


def both(*adds: Add) -> Add:
    def add(spec: mujoco.MjSpec) -> None:
        for each in adds:
            each(spec)

    return add


def values(add: Add, gap_mm: float = 3.0) -> Floats:
    model, data = state(add, gap_mm)
    return LightSensor(model, LAYOUT).values(data)


def quat(turn_deg: float) -> list[float]:
    half = np.radians(turn_deg) / 2.0
    return [np.cos(half), 0.0, 0.0, np.sin(half)]


def direction(angle_deg: float) -> Floats:
    return np.array([np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))])


def sheet(offset_mm: float, angle_deg: float, z_mm: float = 0.0) -> Add:
    """A large thin box right of a line."""
    x, y = (offset_mm - 50.0) * direction(angle_deg + 90.0) / 1e3
    return lambda spec: spec.worldbody.add_geom(
        type=GEOM.mjGEOM_BOX, size=[0.1, 0.05, 2e-4], pos=[x, y, z_mm / 1e3], quat=quat(angle_deg)
    )


def corner(x_mm: float, y_mm: float, angle_deg: float) -> Add:
    """A large thin box with one corner among the cells."""
    x, y = (np.array([x_mm, y_mm]) + 50.0 * np.sqrt(2.0) * direction(angle_deg)) / 1e3
    return lambda spec: spec.worldbody.add_geom(
        type=GEOM.mjGEOM_BOX, size=[0.05, 0.05, 2e-4], pos=[x, y, 0.0], quat=quat(angle_deg + 45.0)
    )


def rod(offset_mm: float, angle_deg: float, kind: int, z_mm: float = 0.0) -> Add:
    """A lying capsule or cylinder of 3 mm."""
    middle, way = offset_mm * direction(angle_deg + 90.0), 80.0 * direction(angle_deg)
    ends = [*(middle - way), z_mm, *(middle + way), z_mm]
    return lambda spec: spec.worldbody.add_geom(
        type=kind, fromto=[end / 1e3 for end in ends], size=[0.0015, 0.0, 0.0]
    )


def disc(x_mm: float, y_mm: float, z_mm: float = 0.0) -> Add:
    place = [x_mm / 1e3, y_mm / 1e3, z_mm / 1e3]
    return lambda spec: spec.worldbody.add_geom(
        type=GEOM.mjGEOM_CYLINDER, size=[0.006, 2e-4, 0.0], pos=place
    )


def ball(x_mm: float, y_mm: float) -> Add:
    return lambda spec: spec.worldbody.add_geom(
        type=GEOM.mjGEOM_SPHERE, size=[0.0015, 0.0, 0.0], pos=[x_mm / 1e3, y_mm / 1e3, 0.0]
    )


def cloth(y_mm: float, turn_deg: float = 0.0, name: str = "cloth") -> Add:
    """A cloth of 96 mm from a height on towards the tip."""

    def add(spec: mujoco.MjSpec) -> None:
        x, y = (y_mm + 48.0) * direction(turn_deg + 90.0) / 1e3
        body = spec.worldbody.add_body(name=f"{name}_body", quat=quat(turn_deg))
        body.pos = [x, y, 0.0]
        body.make_flex(
            name, type="grid", dim=2, count=[25, 25, 1], spacing=[0.004] * 3, radius=2e-4,
            mass=0.01, equality=1,
        )  # fmt: skip

    return add


def rope(offset_mm: float, number: int = 60) -> Add:
    def add(spec: mujoco.MjSpec) -> None:
        body = spec.worldbody.add_body(name="rope_body", pos=[0.0, offset_mm / 1e3, 0.0])
        body.make_flex(
            "rope", type="grid", dim=1, count=[number, 1, 1], spacing=[0.003] * 3, radius=0.0015,
            mass=0.01, equality=1,
        )  # fmt: skip

    return add


def moving_rod() -> mujoco.MjSpec:
    """Fingers and a rod without weight that moves towards the tip."""
    spec = fingers(LAYOUT)
    body = spec.worldbody.add_body(name="rod", pos=[0.0, -0.005, 0.0])
    body.add_joint(name="slide", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0.0, 1.0, 0.0])
    body.add_geom(type=GEOM.mjGEOM_CAPSULE, fromto=[-0.08, 0, 0, 0.08, 0, 0], size=[0.001, 0, 0])
    spec.option.gravity = [0.0, 0.0, 0.0]
    return spec
