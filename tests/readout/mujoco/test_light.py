"""The light of rigid bodies, ropes and cloth in MuJoCo, against scenes of the twin."""

from collections.abc import Callable

import mujoco
import numpy as np
import pytest

from lumitip.grid import Floats
from lumitip.links.twin import published_layout
from lumitip.mujoco import ACTUATOR, SENSOR, LightSensor, MujocoError, fingers, open_fingers
from lumitip.twin import Cable, Corner, Disc, HalfPlane, Model, Polygon, Scene, Twin

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

    assert np.abs(values(plate) - TWIN.values(Polygon(points))).max() <= MOST_COUNTS
    scene = [Polygon(points), Disc(x_mm=12.0, y_mm=4.0, diameter_mm=12.0)]
    assert np.abs(values(both(plate, disc(12.0, 4.0))) - TWIN.values(scene)).max() <= MOST_COUNTS


@pytest.mark.parametrize("seed", range(6))
def test_any_gap_and_any_height(seed: int) -> None:
    chance = np.random.default_rng(seed)
    gap_mm = chance.uniform(2.0, 9.0)
    z_mm = chance.uniform(-0.3, 0.3) * gap_mm
    offset, angle = chance.uniform(-6.0, 6.0), chance.uniform(-90.0, 90.0)
    twin = Twin(LAYOUT, Model.from_layout(LAYOUT, gap_mm=gap_mm))
    height = 0.5 + z_mm / gap_mm
    line = {"offset_mm": offset, "angle_deg": angle, "height": height}
    for add, scene in (
        (rod(offset, angle, GEOM.mjGEOM_CAPSULE, z_mm), Cable(**line)),
        (sheet(offset, angle, z_mm), HalfPlane(**line)),
        (disc(offset, 2.0, z_mm), Disc(x_mm=offset, y_mm=2.0, diameter_mm=12.0, height=height)),
    ):
        error = np.abs(values(add, gap_mm) - twin.values(scene)).max()
        assert error <= 1.5 * MOST_COUNTS, (gap_mm, z_mm, scene)


def test_what_is_not_between_the_fingers_shades_nothing() -> None:
    """Links of a robot: capsules and discs behind and beside the fingers."""
    for add in (
        rod(0.0, 0.0, GEOM.mjGEOM_CAPSULE, -50.0),
        rod(0.0, 0.0, GEOM.mjGEOM_CAPSULE, 50.0),
        lambda spec: spec.worldbody.add_geom(
            type=GEOM.mjGEOM_CYLINDER, size=[0.04, 1e-3, 0.0], pos=[0.0, 0.0, -0.03]
        ),
        disc(45.0, 0.0),
        lambda spec: spec.worldbody.add_geom(type=GEOM.mjGEOM_BOX, size=[0.01] * 3, rgba=[0] * 4),
    ):
        assert (values(add) > 255.0 - 1e-9).all()
    partly = values(disc(21.0, 4.0))
    assert np.abs(partly - TWIN.values(Disc(x_mm=21.0, y_mm=4.0, diameter_mm=12.0))).max() <= 2.0
    assert partly.min() < 150.0


def test_several_cables_stay_round() -> None:
    pair = both(rod(3.0, 0.0, GEOM.mjGEOM_CAPSULE), rod(-3.0, 0.0, GEOM.mjGEOM_CAPSULE))
    scene = [Cable(offset_mm=3.0), Cable(offset_mm=-3.0)]
    assert np.abs(values(pair) - TWIN.values(scene)).max() <= MOST_COUNTS
    crossing = both(rod(0.0, 20.0, GEOM.mjGEOM_CAPSULE), rod(0.0, -50.0, GEOM.mjGEOM_CAPSULE))
    scene = [Cable(angle_deg=20.0), Cable(angle_deg=-50.0)]
    assert np.abs(values(crossing) - TWIN.values(scene)).max() <= MOST_COUNTS


@pytest.mark.parametrize("turn_deg", [90.0, 150.0])
def test_a_sharp_bend_has_two_legs(turn_deg: float) -> None:
    """Two capsules that meet: each shades as alone, away from the bend."""

    def leg(angle_deg: float) -> Add:
        ends = [0.0, 0.0, 0.0, *(0.08 * direction(angle_deg)), 0.0]
        return lambda spec: spec.worldbody.add_geom(
            type=GEOM.mjGEOM_CAPSULE, fromto=ends, size=[0.0015, 0.0, 0.0]
        )

    bent = values(both(leg(0.0), leg(180.0 - turn_deg)))
    for angle in (0.0, 180.0 - turn_deg):
        alone = values(leg(angle))
        darkest = int(alone.argmin())
        assert bent[darkest] <= alone[darkest] + MOST_COUNTS


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


def test_a_coarse_cloth_and_a_solid_that_yields() -> None:
    """No point of theirs is between the fingers, yet they are."""

    def coarse(spec: mujoco.MjSpec) -> None:
        body = spec.worldbody.add_body(name="cloth_body")
        body.make_flex(
            "cloth", type="grid", dim=2, count=[2, 2, 1], spacing=[0.1] * 3, radius=2e-4,
            mass=0.01, equality=1,
        )  # fmt: skip

    def foam(spec: mujoco.MjSpec) -> None:
        body = spec.worldbody.add_body(name="foam_body")
        body.make_flex(
            "foam", type="grid", dim=3, count=[5, 5, 2], spacing=[0.004] * 3, radius=2e-4,
            mass=0.01, equality=1,
        )  # fmt: skip

    assert (values(coarse) < 5.0).all()
    assert values(foam, 4.0).min() < 5.0


def test_an_ellipsoid_is_the_ellipse_that_is_seen() -> None:
    def ellipsoid(spec: mujoco.MjSpec) -> None:
        spec.worldbody.add_geom(type=GEOM.mjGEOM_ELLIPSOID, size=[8e-3, 4e-3, 1e-3], quat=quat(30))

    turn = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
    rim = np.stack([8.0 * np.cos(turn), 4.0 * np.sin(turn)], axis=1)
    way = np.stack([direction(30.0), direction(120.0)])
    assert np.abs(values(ellipsoid) - TWIN.values(Polygon(rim @ way))).max() <= MOST_COUNTS


def test_sizes_that_change_are_followed() -> None:
    model, data = state(sheet(0.0, 0.0))
    sensor = LightSensor(model, LAYOUT)
    wide = sensor.values(data)
    model.geom_size[0, 1] = 1e-3
    mujoco.mj_forward(model, data)
    assert (sensor.values(data) - wide).max() > 200.0


def moving_rod() -> mujoco.MjSpec:
    """Fingers and a rod without weight that moves towards the tip."""
    spec = fingers(LAYOUT)
    body = spec.worldbody.add_body(name="rod", pos=[0.0, -0.005, 0.0])
    body.add_joint(name="slide", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0.0, 1.0, 0.0])
    body.add_geom(type=GEOM.mjGEOM_CAPSULE, fromto=[-0.08, 0, 0, 0.08, 0, 0], size=[0.001, 0, 0])
    spec.option.gravity = [0.0, 0.0, 0.0]
    return spec


def test_mujoco_fills_the_sensor_in_each_step() -> None:
    model = moving_rod().compile()
    data = mujoco.MjData(model)
    open_fingers(model, data, 3.0)
    data.joint("slide").qvel = 0.5
    heights = []
    with LightSensor(model, LAYOUT).installed():
        for _ in range(20):
            mujoco.mj_step(model, data)
            light = 255.0 - data.sensor(SENSOR).data
            heights.append(float(light @ LAYOUT.y_mm / light.sum()))
    assert mujoco.get_mjcb_sensor() is None
    assert np.all(np.diff(heights) > 0.0), "the shadow does not follow the rod"
    assert heights[-1] - heights[0] == pytest.approx(19 * 0.5, rel=0.2)  # 0.5 mm in a step


def test_two_pairs_in_one_model_and_a_callback_of_ones_own() -> None:
    spec = mujoco.MjSpec()
    spec.option.timestep, spec.option.gravity = 0.001, [0.0, 0.0, 0.0]
    for name, place in (("left/", -0.2), ("right/", 0.2)):
        pair = moving_rod()
        spec.worldbody.add_frame(pos=[place, 0.0, 0.0]).attach_body(pair.worldbody, name, "")
    model = spec.compile()
    data = mujoco.MjData(model)
    for name in ("left/", "right/"):
        for side in ("receiver", "emitter"):
            data.joint(f"{name}lumitip_{side}_joint").qpos = 0.0015
    data.joint("right/slide").qpos = 0.008
    mujoco.mj_forward(model, data)
    calls = []
    mujoco.set_mjcb_sensor(lambda *_: calls.append(1))
    try:
        sensors = [
            LightSensor(
                model,
                LAYOUT,
                fingers=(f"{name}lumitip_receiver", f"{name}lumitip_emitter"),
                sensor=f"{name}{SENSOR}",
            )
            for name in ("left/", "right/")
        ]
        with sensors[0].installed(), sensors[1].installed():
            mujoco.mj_forward(model, data)
        assert calls and mujoco.get_mjcb_sensor() is not None
    finally:
        mujoco.set_mjcb_sensor(None)
    left, right = (data.sensor(f"{name}{SENSOR}").data for name in ("left/", "right/"))
    assert left.min() < 150.0 and np.abs(left - right).max() > 50.0


@pytest.mark.parametrize("radius_mm", [0.5, 2.0])
def test_the_fingers_close_on_a_body_with_their_force(radius_mm: float) -> None:
    spec = fingers(LAYOUT, force_n=10.0)
    spec.option.gravity = [0.0, 0.0, 0.0]
    body = spec.worldbody.add_body(name="rod")
    body.add_freejoint()
    ends, radius_m = [-0.03, 0, 0, 0.03, 0, 0], radius_mm / 1e3
    body.add_geom(type=GEOM.mjGEOM_CAPSULE, fromto=ends, size=[radius_m, 0, 0])
    model = spec.compile()
    data = mujoco.MjData(model)
    open_fingers(model, data, 6.0)
    assert 2e3 * data.qpos[0] == pytest.approx(6.0)
    data.ctrl[model.actuator(ACTUATOR).id] = model.actuator(ACTUATOR).ctrlrange[0]
    mujoco.mj_step(model, data, 1000)
    assert 2e3 * data.qpos[0] == pytest.approx(2.0 * radius_mm, abs=0.2)
    assert data.qpos[0] == pytest.approx(data.qpos[1], abs=2e-4)
    pressed = dict.fromkeys(("receiver", "emitter"), 0.0)
    for number in range(data.ncon):
        force = np.zeros(6)
        mujoco.mj_contactForce(model, data, number, force)
        bodies = {model.body(int(model.geom_bodyid[g])).name for g in data.contact[number].geom}
        for side in pressed:
            pressed[side] += force[0] if f"lumitip_{side}" in bodies else 0.0
    assert pressed == pytest.approx({"receiver": 10.0, "emitter": 10.0}, rel=0.1)
    assert LightSensor(model, LAYOUT).values(data).min() < 200.0


def test_a_model_can_be_saved_as_mjcf() -> None:
    spec = fingers(LAYOUT)
    rope(1.0)(spec)
    before = spec.compile()
    again = mujoco.MjModel.from_xml_string(spec.to_xml())
    assert again.nsensordata == before.nsensordata == len(LAYOUT)
    data = mujoco.MjData(again)
    open_fingers(again, data, 3.0)
    assert LightSensor(again, LAYOUT).values(data).min() < 60.0


def test_materials_by_geom_body_and_chain() -> None:
    def chain(spec: mujoco.MjSpec) -> None:
        body = spec.worldbody.add_body(name="hose")
        for number in range(8):
            begin = -0.08 + 0.02 * number
            body.add_geom(
                name=f"part{number}",
                type=GEOM.mjGEOM_CAPSULE,
                fromto=[begin, 0.0, 0.0, begin + 0.02, 0.0, 0.0],
                size=[0.0015, 0.0, 0.0],
            )

    model, data = state(chain)
    clear = LightSensor(model, LAYOUT, materials={"hose": (0.9, 0.0)}).values(data)
    assert np.abs(clear - TWIN.values(Cable(clear=0.9))).max() <= MOST_COUNTS
    part = LightSensor(model, LAYOUT, materials={"part4": (0.9, 0.0)}).values(data)
    opaque = LightSensor(model, LAYOUT).values(data)
    darker = part < clear - 50.0
    assert darker.any() and (part > opaque + 50.0).any()


def test_wrong_arguments_are_named() -> None:
    model, data = state(sheet(0.0, 0.0))
    for names in (("left", "right"), ("world", "lumitip_emitter"), ("lumitip_emitter",) * 2):
        with pytest.raises(MujocoError, match="two bodies of the model are needed"):
            LightSensor(model, LAYOUT, fingers=names)
    for materials, words in (
        ({"silk": (0.1, 0.1)}, "materials has 'silk'; the model has no such"),
        ({"lumitip_receiver": (0.8, 0.4)}, "whose sum is 1 at most"),
        ({"lumitip_receiver": 0.3}, "whose sum is 1 at most"),
        (["lumitip_receiver"], "names with two numbers are needed"),
    ):
        with pytest.raises(MujocoError, match=words):
            LightSensor(model, LAYOUT, materials=materials)  # type: ignore[arg-type]
    with pytest.raises(MujocoError, match=r"'none\.urdf'; MuJoCo cannot read it"):
        fingers(LAYOUT, "none.urdf")
    with pytest.raises(MujocoError, match="opening_mm is 200"):
        open_fingers(model, data, 200.0)
    bare = mujoco.MjSpec()
    for name in ("lumitip_receiver", "lumitip_emitter"):
        bare.worldbody.add_body(name=name)
    other = bare.compile()
    with (
        pytest.raises(MujocoError, match=f"no sensor '{SENSOR}' of 32 values"),
        LightSensor(other, LAYOUT).installed(),
    ):
        pass
    with pytest.raises(MujocoError, match="data is of another model"):
        LightSensor(other, LAYOUT).values(data)
    with pytest.raises(MujocoError, match="the fingers do not face"):
        LightSensor(other, LAYOUT).values(mujoco.MjData(other))
    data.qpos[0] = np.nan
    with pytest.raises(MujocoError, match="not finite"):
        LightSensor(model, LAYOUT).values(data)
