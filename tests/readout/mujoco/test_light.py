"""The light of rigid bodies, ropes and cloth in MuJoCo, against scenes of the twin."""

from collections.abc import Callable

import mujoco
import numpy as np
import pytest

from lumitip.grid import Floats
from lumitip.links.twin import published_layout
from lumitip.mujoco import SENSOR, LightSensor, MujocoError, fingers
from lumitip.twin import Cable, Corner, Disc, HalfPlane, Polygon, Scene, Twin

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
    data.qpos[:2] = gap_mm / 2000.0
    mujoco.mj_forward(model, data)
    return model, data


def values(add: Add, gap_mm: float = 3.0) -> Floats:
    model, data = state(add, gap_mm)
    return LightSensor(model, LAYOUT).values(data)


def quat(turn_deg: float) -> list[float]:
    half = np.radians(turn_deg) / 2.0
    return [np.cos(half), 0.0, 0.0, np.sin(half)]


def direction(angle_deg: float) -> Floats:
    return np.array([np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))])


def sheet(offset_mm: float, angle_deg: float) -> Add:
    """A large thin box right of a line."""
    x, y = (offset_mm - 50.0) * direction(angle_deg + 90.0) / 1e3
    return lambda spec: spec.worldbody.add_geom(
        type=GEOM.mjGEOM_BOX, size=[0.1, 0.05, 2e-4], pos=[x, y, 0.0], quat=quat(angle_deg)
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


def disc(x_mm: float, y_mm: float) -> Add:
    return lambda spec: spec.worldbody.add_geom(
        type=GEOM.mjGEOM_CYLINDER, size=[0.006, 5e-4, 0.0], pos=[x_mm / 1e3, y_mm / 1e3, 0.0]
    )


def ball(x_mm: float, y_mm: float) -> Add:
    return lambda spec: spec.worldbody.add_geom(
        type=GEOM.mjGEOM_SPHERE, size=[0.0015, 0.0, 0.0], pos=[x_mm / 1e3, y_mm / 1e3, 0.0]
    )


@pytest.mark.parametrize("seed", range(8))
def test_rigid_shapes_give_the_light_of_the_twin(seed: int) -> None:
    chance = np.random.default_rng(seed)
    offset, angle = chance.uniform(-7.0, 7.0), chance.uniform(-180.0, 180.0)
    x, y = chance.uniform(-8.0, 8.0, 2)
    pairs: list[tuple[Add, Scene]] = [
        (sheet(offset, angle), HalfPlane(offset_mm=offset, angle_deg=angle)),
        (corner(x, y, angle), Corner(x_mm=x, y_mm=y, angle_deg=angle)),
        (rod(offset, angle, GEOM.mjGEOM_CAPSULE), Cable(offset_mm=offset, angle_deg=angle)),
        (rod(offset, angle, GEOM.mjGEOM_CYLINDER), Cable(offset_mm=offset, angle_deg=angle)),
        (disc(x, y), Disc(x_mm=x, y_mm=y, diameter_mm=12.0)),
        (ball(x, y), Disc(x_mm=x, y_mm=y, diameter_mm=3.0)),
    ]
    for add, scene in pairs:
        expected = TWIN.values(scene)
        assert expected.min() < 250.0, "the scene shades nothing"
        assert np.abs(values(add) - expected).max() <= MOST_COUNTS, scene


def test_a_small_plate_and_two_bodies_are_outlines() -> None:
    points = [(x, y) for x, y in ((-4.0, -3.0), (4.0, -3.0), (4.0, 3.0), (-4.0, 3.0))]

    def plate(spec: mujoco.MjSpec) -> None:
        spec.worldbody.add_geom(type=GEOM.mjGEOM_BOX, size=[0.004, 0.003, 2e-4])

    def both(spec: mujoco.MjSpec) -> None:
        plate(spec)
        disc(12.0, 4.0)(spec)

    assert np.abs(values(plate) - TWIN.values(Polygon(points))).max() <= MOST_COUNTS
    scene = [Polygon(points), Disc(x_mm=12.0, y_mm=4.0, diameter_mm=12.0)]
    assert np.abs(values(both) - TWIN.values(scene)).max() <= MOST_COUNTS


def test_the_gap_and_the_height_in_it_count() -> None:
    for gap_mm in (2.0, 5.0):
        wide = Twin(LAYOUT, TWIN.model.__class__.from_layout(LAYOUT, gap_mm=gap_mm))
        found = values(sheet(1.0, 20.0), gap_mm)
        assert np.abs(found - wide.values(HalfPlane(1.0, 20.0))).max() <= MOST_COUNTS
    high = values(rod(1.0, 20.0, GEOM.mjGEOM_CAPSULE, z_mm=1.0), 6.0)
    wide = Twin(LAYOUT, TWIN.model.__class__.from_layout(LAYOUT, gap_mm=6.0))
    expected = wide.values(Cable(offset_mm=1.0, angle_deg=20.0, height=4.0 / 6.0))
    assert np.abs(high - expected).max() <= MOST_COUNTS
    assert np.abs(high - wide.values(Cable(offset_mm=1.0, angle_deg=20.0))).max() > MOST_COUNTS


def test_nothing_between_the_fingers_is_full_light() -> None:
    def beside(spec: mujoco.MjSpec) -> None:
        spec.worldbody.add_geom(type=GEOM.mjGEOM_BOX, size=[0.01, 0.01, 0.01], pos=[0.1, 0.0, 0.0])
        spec.worldbody.add_geom(type=GEOM.mjGEOM_PLANE, size=[1.0, 1.0, 0.1], pos=[0.0, 0.0, -0.2])

    assert (values(beside) > 255.0 - 1e-9).all()


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


@pytest.mark.parametrize(("y_mm", "turn_deg"), [(0.0, 0.0), (2.5, 12.0), (-3.0, -25.0)])
def test_the_edge_of_cloth(y_mm: float, turn_deg: float) -> None:
    expected = TWIN.values(HalfPlane(offset_mm=-y_mm, angle_deg=180.0 + turn_deg))
    assert np.abs(values(cloth(y_mm, turn_deg)) - expected).max() <= MOST_COUNTS


def test_a_fold_is_two_layers() -> None:
    """The part that is turned over is darker, if the cloth lets light through."""
    model, data = state(cloth(-40.0))
    sensor = LightSensor(model, LAYOUT, materials={"cloth": (0.4, 0.0)})
    single = sensor.values(data)
    assert np.allclose(single, single[0], atol=3.0)
    points = data.flexvert_xpos
    over = points[:, 1] > 0.0
    points[over, 1] *= -1.0  # folded along y = 0: two layers below it
    double = sensor.values(data)
    above, below = LAYOUT.y_mm > 4.0, LAYOUT.y_mm < -4.0
    assert (double[above] > 250.0).all()
    assert (double[below] < single[below] - 20.0).all()


def rope(offset_mm: float, number: int = 60) -> Add:
    def add(spec: mujoco.MjSpec) -> None:
        body = spec.worldbody.add_body(name="rope_body", pos=[0.0, offset_mm / 1e3, 0.0])
        body.make_flex(
            "rope", type="grid", dim=1, count=[number, 1, 1], spacing=[0.003] * 3, radius=0.0015,
            mass=0.01, equality=1,
        )  # fmt: skip

    return add


def test_a_rope_is_a_cable_and_its_end_is_seen() -> None:
    whole = values(rope(1.0))
    assert np.abs(whole - TWIN.values(Cable(offset_mm=1.0))).max() <= MOST_COUNTS
    short = values(rope(1.0, number=5))  # from -6 to 6 mm
    outer, inner = np.abs(LAYOUT.x_mm) > 12.0, np.abs(LAYOUT.x_mm) < 2.0
    assert (short[outer] > 250.0).all() and short[inner].min() < whole[inner].min() + 30.0


def test_a_bent_rope_is_an_arc() -> None:
    radius_mm, step = 40.0, 0.05
    model, data = state(rope(0.0))
    along = (np.arange(60) - 29.5) * step
    points = np.stack([radius_mm * np.sin(along), radius_mm * (1.0 - np.cos(along))], axis=1)
    near = np.abs(along) < np.pi / 2.0
    data.flexvert_xpos[:, :2] = np.where(near[:, None], points, points + 1e3) / 1e3
    expected = TWIN.values(Cable(curvature_per_mm=1.0 / radius_mm))
    found = LightSensor(model, LAYOUT).values(data)
    assert np.abs(found - expected).max() <= 3.0  # chords of 2 mm instead of the arc


def test_mujoco_fills_the_sensor_in_each_step() -> None:
    spec = fingers(LAYOUT)
    body = spec.worldbody.add_body(name="rod", pos=[0.0, -0.005, 0.0])
    body.add_joint(type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0.0, 1.0, 0.0])
    body.add_geom(type=GEOM.mjGEOM_CAPSULE, fromto=[-0.08, 0, 0, 0.08, 0, 0], size=[0.001, 0, 0])
    spec.option.gravity = [0.0, 0.0, 0.0]
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[:2], data.ctrl[0] = 0.0015, 0.0015
    data.qvel[2] = 0.5
    sensor = LightSensor(model, LAYOUT)
    heights = []
    with sensor.installed():
        for _ in range(20):
            mujoco.mj_step(model, data)
            light = 255.0 - data.sensor(SENSOR).data
            heights.append(float(light @ LAYOUT.y_mm / light.sum()))
        with pytest.raises(MujocoError, match="callback is set already"), sensor.installed():
            pass
    assert mujoco.get_mjcb_sensor() is None
    assert np.all(np.diff(heights) > 0.0), "the shadow does not follow the rod"
    assert heights[-1] - heights[0] == pytest.approx(19 * 0.5, rel=0.2)  # 0.5 mm in a step


def test_the_fingers_close_on_a_body_and_hold_it() -> None:
    spec = fingers(LAYOUT, opening_mm=6.0)
    spec.option.gravity = [0.0, 0.0, 0.0]
    body = spec.worldbody.add_body(name="rod")
    body.add_freejoint()
    body.add_geom(type=GEOM.mjGEOM_CAPSULE, fromto=[-0.03, 0, 0, 0.03, 0, 0], size=[0.002, 0, 0])
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    assert 2e3 * data.qpos[0] == pytest.approx(6.0)
    data.ctrl[0] = 0.0
    mujoco.mj_step(model, data, 1000)
    assert data.ncon >= 2
    gap_mm = 2e3 * data.qpos[0]
    assert gap_mm == pytest.approx(4.0, abs=0.1)
    assert data.qpos[0] == pytest.approx(data.qpos[1], abs=1e-4)
    assert LightSensor(model, LAYOUT).values(data).min() < 60.0


def test_a_model_can_be_saved_as_mjcf() -> None:
    spec = fingers(LAYOUT)
    rope(1.0)(spec)
    before = spec.compile()
    again = mujoco.MjModel.from_xml_string(spec.to_xml())
    assert again.nsensordata == before.nsensordata == len(LAYOUT)
    data = mujoco.MjData(again)
    data.qpos[:2] = 0.0015
    mujoco.mj_forward(again, data)
    assert LightSensor(again, LAYOUT).values(data).min() < 60.0


def test_wrong_arguments_are_named() -> None:
    model, _ = state(sheet(0.0, 0.0))
    with pytest.raises(MujocoError, match="the model has no body of such a name"):
        LightSensor(model, LAYOUT, fingers=("left", "right"))
    with pytest.raises(MujocoError, match="materials has 'silk'; the model has no such"):
        LightSensor(model, LAYOUT, materials={"silk": (0.1, 0.1)})
    spec = fingers(LAYOUT)
    spec.worldbody.add_geom(name="foil", type=GEOM.mjGEOM_BOX, size=[0.01, 0.01, 0.001])
    with pytest.raises(MujocoError, match=r"materials\['foil'\] is .*sum is 1 at most"):
        LightSensor(spec.compile(), LAYOUT, materials={"foil": (0.8, 0.4)})
    with pytest.raises(MujocoError, match=r"'none\.urdf'; MuJoCo cannot read it"):
        fingers(LAYOUT, "none.urdf")
    bare = mujoco.MjSpec()
    for name in ("lumitip_receiver", "lumitip_emitter"):
        bare.worldbody.add_body(name=name)
    with (
        pytest.raises(MujocoError, match=f"no sensor {SENSOR} of 32 values"),
        LightSensor(bare.compile(), LAYOUT).installed(),
    ):
        pass
