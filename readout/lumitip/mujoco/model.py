"""`fingers`: both fingers as a MuJoCo model, to which a user adds a scene."""

from pathlib import Path

import mujoco
import numpy as np

from lumitip import arguments
from lumitip.errors import LumitipError
from lumitip.layout import Layout
from lumitip.values import shown

SENSOR = "lumitip_light"
"""Name of the user sensor that has a value for each cell."""
FINGERS = ("lumitip_receiver", "lumitip_emitter")
"""Bodies whose frames are the sensor frames."""
ACTUATOR = "lumitip_opening"
"""Name of the actuator: its target is the travel of each finger from where they touch (m)."""
_JOINTS = tuple(f"{name}_joint" for name in FINGERS)
_BORDER_MM, _THICK_MM = 4.0, 4.0
_TRAVEL_M = 0.05  # of the plates
_DENSITY_KG_M3 = 1270.0  # PETG
_TURNED = (0.0, 0.0, 1.0, 0.0)  # half a turn about y: the fingers face each other
_STIFFNESS_N_M, _DAMPING_N_S_M = 8000.0, 80.0
_DRIVE_KG = 0.2  # of the gripper's drive, felt at a finger: assumed
_TIMESTEP_S = 0.001
# A cable of a gram between fingers that press with newtons: softer contacts would let it through.
_STIFF = ([0.002, 1.0], [0.999, 0.9999, 1e-4, 0.5, 2.0])  # solref and solimp


class MujocoError(LumitipError, ValueError):
    """A model or argument that the sensor in MuJoCo cannot use."""


def fingers(layout: Layout, urdf: str | Path | None = None, force_n: float = 20.0) -> mujoco.MjSpec:
    """A model of both fingers: slide joints, the actuator `ACTUATOR`, the sensor `SENSOR`.

    Args:
        layout: the cells.
        urdf: `robot/lumitip.urdf` of the design's outputs; without it the fingers are two plates
            that touch in z = 0.
        force_n: force of each finger on a body that is gripped, with the target at its lower limit
            (N).

    Returns:
        The specification, to be extended and compiled.

    Raises:
        LayoutError: if `layout` is no layout.
        MujocoError: if the file cannot be read, or has no such fingers.
    """
    layout = arguments.layout(layout)
    force_n = arguments.number(force_n, "force_n", above=0.0, error=MujocoError)
    spec = _plates(layout) if urdf is None else _of_file(urdf)
    for name in _JOINTS:
        joint = spec.joint(name)
        joint.damping = [_DAMPING_N_S_M, 0.0, 0.0]
        joint.armature = _DRIVE_KG
    equal = spec.add_equality(type=mujoco.mjtEq.mjEQ_JOINT, objtype=mujoco.mjtObj.mjOBJ_JOINT)
    equal.name1, equal.name2 = _JOINTS[1], _JOINTS[0]
    equal.data[:5] = (0.0, 1.0, 0.0, 0.0, 0.0)
    equal.solref, equal.solimp = _STIFF
    # One actuator moves both fingers, so each has half of its force.
    most_n = 2.0 * force_n
    actuator = spec.add_actuator(name=ACTUATOR, target=_JOINTS[0])
    actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT
    actuator.set_to_position(kp=_STIFFNESS_N_M)
    # With the target this far below 0 the force is whole, even where the fingers touch.
    lowest_m = -most_n / _STIFFNESS_N_M
    actuator.ctrlrange = [lowest_m, float(spec.joint(_JOINTS[0]).range[1])]
    actuator.forcerange = [-most_n, most_n]
    actuator.ctrllimited = actuator.forcelimited = True
    spec.option.timestep = _TIMESTEP_S
    for name in FINGERS:
        for geom in spec.body(name).geoms:
            geom.priority = 1
            geom.solref, geom.solimp = _STIFF
    spec.add_sensor(
        name=SENSOR,
        type=mujoco.mjtSensor.mjSENS_USER,
        datatype=mujoco.mjtDataType.mjDATATYPE_REAL,
        needstage=mujoco.mjtStage.mjSTAGE_POS,
        dim=len(layout),
    )
    return spec


def open_fingers(
    model: mujoco.MjModel, data: mujoco.MjData, opening_mm: float, prefix: str = ""
) -> None:
    """Open the fingers and hold them so: positions, target, and all that follows from them.

    Args:
        model: of `fingers`.
        data: its state.
        opening_mm: skin to skin where they touch first (mm). At the cells, fingers of a URDF that
            lean are farther apart, and the light is that of the gap there.
        prefix: with which `fingers` was attached to the model.

    Raises:
        MujocoError: if the model has no such joints, or they do not open so far.
    """
    arguments.instance(prefix, str, "prefix", MujocoError)
    joints = [f"{prefix}{name}" for name in _JOINTS]
    numbers = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) for name in joints]
    if min(numbers) < 0:
        raise MujocoError(f"the model has no joints {' and '.join(joints)}; {_remedy(model)}")
    most_mm = 2e3 * float(model.jnt_range[numbers, 1].min())
    opening_mm = arguments.number(
        opening_mm, "opening_mm", 0.0, most=most_mm + 1e-9, error=MujocoError
    )
    data.qpos[model.jnt_qposadr[numbers]] = opening_mm / 2e3
    data.qvel[model.jnt_dofadr[numbers]] = 0.0
    data.ctrl[model.actuator(f"{prefix}{ACTUATOR}").id] = opening_mm / 2e3
    mujoco.mj_forward(model, data)


def _remedy(model: mujoco.MjModel) -> str:
    """How to name the fingers of a model."""
    names = (model.joint(number).name for number in range(model.njnt))
    prefixes = [name.removesuffix(_JOINTS[0]) for name in names if name.endswith(_JOINTS[0])]
    if not prefixes:
        return "`fingers` makes them"
    return f"it has them with the prefix {' or '.join(map(shown, prefixes))}: pass it as `prefix`"


def _of_file(urdf: str | Path) -> mujoco.MjSpec:
    try:
        spec = mujoco.MjSpec.from_file(str(urdf))
    except (ValueError, OSError, mujoco.FatalError) as problem:
        raise MujocoError(f"urdf is {shown(str(urdf))}; MuJoCo cannot read it: {problem}") from None
    missing = [name for name in FINGERS if spec.body(name) is None]
    missing += [name for name in _JOINTS if spec.joint(name) is None]
    if missing:
        raise MujocoError(
            f"{urdf} has no {' and no '.join(missing)}; the file robot/lumitip.urdf of a design's "
            "outputs is needed"
        )
    for equality in list(spec.equalities):
        if {equality.name1, equality.name2} == set(_JOINTS):
            spec.delete(equality)  # made anew, stiffer
    return spec


def _plates(layout: Layout) -> mujoco.MjSpec:
    """Two plates as large as the grid, in place of the printed fingers."""
    spec = mujoco.MjSpec()
    spec.modelname = "lumitip"
    half_mm = [
        float(np.abs(place).max()) + layout.pitch_mm / 2.0 + _BORDER_MM
        for place in (layout.x_mm, layout.y_mm)
    ]
    for name, quat in zip(FINGERS, ((1.0, 0.0, 0.0, 0.0), _TURNED), strict=True):
        body = spec.worldbody.add_body(name=name, quat=quat)
        body.add_joint(
            name=f"{name}_joint",
            type=mujoco.mjtJoint.mjJNT_SLIDE,
            axis=[0.0, 0.0, -1.0],
            range=[0.0, _TRAVEL_M],
            limited=True,
        )
        body.add_geom(
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=[half_mm[0] / 1e3, half_mm[1] / 1e3, _THICK_MM / 2e3],
            pos=[0.0, 0.0, -_THICK_MM / 2e3],
            density=_DENSITY_KG_M3,
        )
    return spec
