"""URDF of a pair of fingers, and the same links as xacro macros: text only, metres and radians.

    lumitip_base ─┬─ prismatic ─ lumitip_receiver
                  ├─ prismatic ─ lumitip_emitter   (mimics the receiver)
                  └─ fixed ───── lumitip_tcp

The frame of a finger's link is its sensor frame, so that a contact in mm is a point of the link
in m. The base lies in the mount plane midway between the fingers: x along the opening, from the
receiver to the emitter, z to the tips.
"""

from dataclasses import dataclass
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.frames import Matrix

MM = 0.001
# What a simulator lets the joints do: the largest of the Robotiq 2F-85's data sheet.
SPEED_M_S = 0.15
EFFORT_N = 235.0
_NAMESPACE = "http://www.ros.org/wiki/xacro"


@dataclass(frozen=True, eq=False)
class Weight:
    """Mass and how it is spread, in the finger's sensor frame."""

    mass_g: float
    centre_mm: NDArray[np.float64]
    inertia_g_mm2: NDArray[np.float64]
    """About the centre of mass, shape `(3, 3)`."""


@dataclass(frozen=True, eq=False)
class FingerModel:
    """One finger for a robot's software."""

    name: str
    weight: Weight
    visuals: tuple[tuple[str, tuple[float, float, float, float]], ...]
    """Mesh files below the folder of meshes, and their colours (red, green, blue, opacity)."""
    collisions: tuple[str, ...]
    """Mesh files of convex bodies."""
    to_base: Matrix
    """From the sensor frame to the base, fingers closed (mm)."""
    opening: NDArray[np.float64]
    """Unit vector along which the finger moves when the gripper opens, in the sensor frame."""


def pair(fingers: tuple[FingerModel, ...], tcp_mm: float, travel_mm: float, meshes: str) -> bytes:
    """A robot of two fingers that open.

    Args:
        fingers: both; the first is driven, the second mimics it.
        tcp_mm: height of the tool centre point above the base.
        travel_mm: how far each finger moves.
        meshes: where the meshes are, relative to the file.
    """
    robot = Element("robot", name="lumitip")
    # For MuJoCo, which otherwise forgets folders and what is only looked at.
    SubElement(
        SubElement(robot, "mujoco"), "compiler", strippath="false", discardvisual="false"
    )  # fmt: skip
    robot.append(Element("link", name="lumitip_base"))
    for model in fingers:
        robot.append(_link(model, "lumitip_", meshes))
        joint = _joint(f"lumitip_{model.name}_joint", "prismatic", f"lumitip_{model.name}")
        joint.append(_origin(model.to_base))
        SubElement(joint, "axis", xyz=_told(model.opening))
        SubElement(joint, "limit", lower="0", upper=_told([travel_mm * MM]),
                   effort=_told([EFFORT_N]), velocity=_told([SPEED_M_S]))  # fmt: skip
        if model is not fingers[0]:
            SubElement(joint, "mimic", joint=f"lumitip_{fingers[0].name}_joint")
        robot.append(joint)
    robot.append(Element("link", name="lumitip_tcp"))
    tcp = _joint("lumitip_tcp_joint", "fixed", "lumitip_tcp")
    SubElement(tcp, "origin", xyz=_told([0, 0, tcp_mm * MM]), rpy="0 0 0")
    robot.append(tcp)
    return _bytes(robot)


def macros(fingers: tuple[FingerModel, ...], meshes: str) -> bytes:
    """A xacro macro for each finger, to hang it on a link of one's own gripper."""
    ElementTree.register_namespace("xacro", _NAMESPACE)
    robot = Element("robot", name="lumitip")
    for model in fingers:
        macro = SubElement(
            robot, f"{{{_NAMESPACE}}}macro", name=f"lumitip_{model.name}",
            params=f"parent prefix:=lumitip_ meshes:={meshes} *origin",
        )  # fmt: skip
        macro.append(_link(model, "${prefix}", "${meshes}"))
        joint = _joint(f"${{prefix}}{model.name}_mount", "fixed", f"${{prefix}}{model.name}",
                       "${parent}")  # fmt: skip
        SubElement(joint, f"{{{_NAMESPACE}}}insert_block", name="origin")
        macro.append(joint)
    return _bytes(robot)


def _link(model: FingerModel, prefix: str, meshes: str) -> Element:
    link = Element("link", name=f"{prefix}{model.name}")
    inertial = SubElement(link, "inertial")
    weight = model.weight
    SubElement(inertial, "origin", xyz=_told(weight.centre_mm * MM), rpy="0 0 0")
    SubElement(inertial, "mass", value=_told([weight.mass_g * MM]))
    told = weight.inertia_g_mm2 * MM**3
    axes = {f"i{a}{b}": _told([told[i, j]]) for i, a in enumerate("xyz")
            for j, b in enumerate("xyz") if j >= i}  # fmt: skip
    SubElement(inertial, "inertia", axes)
    for file, colour in model.visuals:
        visual = SubElement(link, "visual", name=file.removesuffix(".stl"))
        visual.append(_mesh(f"{meshes}/{file}"))
        material = SubElement(visual, "material", name=f"{prefix}{file.removesuffix('.stl')}")
        SubElement(material, "color", rgba=_told(colour))
    for file in model.collisions:
        collision = SubElement(link, "collision", name=file.removesuffix(".stl"))
        collision.append(_mesh(f"{meshes}/{file}"))
    return link


def _mesh(path: str) -> Element:
    geometry = Element("geometry")
    SubElement(geometry, "mesh", filename=path, scale=_told([MM] * 3))
    return geometry


def _joint(name: str, kind: str, child: str, parent: str = "lumitip_base") -> Element:
    joint = Element("joint", name=name, type=kind)
    SubElement(joint, "parent", link=parent)
    SubElement(joint, "child", link=child)
    return joint


def _origin(matrix: Matrix) -> Element:
    """A pose as URDF tells it: turns about the fixed axes x, y, z, in this order."""
    turn = matrix[:3, :3]
    pitch = np.arctan2(-turn[2, 0], np.hypot(turn[0, 0], turn[1, 0]))
    if np.hypot(turn[0, 0], turn[1, 0]) < 1e-9:  # x looks along z: only yaw minus roll is told
        roll, yaw = np.arctan2(-turn[1, 2], turn[1, 1]), 0.0
    else:
        roll, yaw = np.arctan2(turn[2, 1], turn[2, 2]), np.arctan2(turn[1, 0], turn[0, 0])
    return Element("origin", xyz=_told(matrix[:3, 3] * MM), rpy=_told([roll, pitch, yaw]))


def _told(values: object) -> str:
    numbers = np.asarray(values, dtype=float).reshape(-1)
    return " ".join(f"{value:.9g}" for value in np.where(np.abs(numbers) < 1e-15, 0.0, numbers))


def _bytes(robot: Element) -> bytes:
    ElementTree.indent(robot)
    return b'<?xml version="1.0"?>\n' + ElementTree.tostring(robot) + b"\n"
