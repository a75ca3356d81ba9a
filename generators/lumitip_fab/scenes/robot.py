"""Both fingers as a robot's software wants them: URDF, xacro, meshes, masses."""

from collections.abc import Iterator
from dataclasses import dataclass
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import numpy as np
import trimesh
from build123d import Shape, Solid
from numpy.typing import NDArray
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps

from lumitip_fab.design import Closing, Densities, Design, Finger, Mount, Stack
from lumitip_fab.design.frames import Matrix, finger_to_gripper, gripper_to_base
from lumitip_fab.parts import export
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.pipeline.artefact import Artefact
from lumitip_fab.scenes.bodies import finger_bodies, layers_of, part_solid
from lumitip_fab.scenes.glb import colour_of

MM = 0.001
SPEED_M_S = 0.15  # the largest of the Robotiq 2F-85's data sheet; the catalogue has no speeds
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


def pair_urdf(
    fingers: tuple[FingerModel, ...], tcp_mm: float, travel_mm: float, effort_n: float, meshes: str
) -> bytes:
    """A robot of two fingers that open.

    Args:
        fingers: both; the first is driven, the second mimics it.
        tcp_mm: height of the tool centre point above the base.
        travel_mm: how far each finger moves.
        effort_n: greatest force of a joint.
        meshes: where the meshes are, relative to the file.
    """
    robot = Element("robot", name="lumitip")
    # For MuJoCo, which otherwise forgets folders and what is only looked at.
    SubElement(SubElement(robot, "mujoco"), "compiler", strippath="false", discardvisual="false")
    robot.append(Element("link", name="lumitip_base"))
    for model in fingers:
        robot.append(_link(model, "lumitip_", meshes))
        joint = _joint(f"lumitip_{model.name}_joint", "prismatic", f"lumitip_{model.name}")
        joint.append(_origin(model.to_base))
        SubElement(joint, "axis", xyz=_numbers(model.opening))
        SubElement(
            joint,
            "limit",
            lower="0",
            upper=_numbers([travel_mm * MM]),
            effort=_numbers([effort_n]),
            velocity=_numbers([SPEED_M_S]),
        )
        if model is not fingers[0]:
            SubElement(joint, "mimic", joint=f"lumitip_{fingers[0].name}_joint")
        robot.append(joint)
    robot.append(Element("link", name="lumitip_tcp"))
    tcp = _joint("lumitip_tcp_joint", "fixed", "lumitip_tcp")
    SubElement(tcp, "origin", xyz=_numbers([0, 0, tcp_mm * MM]), rpy="0 0 0")
    robot.append(tcp)
    return _bytes(robot)


def pair_xacro(fingers: tuple[FingerModel, ...], meshes: str) -> bytes:
    """A xacro macro for each finger, to hang it on a link of one's own gripper."""
    ElementTree.register_namespace("xacro", _NAMESPACE)
    robot = Element("robot", name="lumitip")
    for model in fingers:
        macro = SubElement(
            robot,
            f"{{{_NAMESPACE}}}macro",
            name=f"lumitip_{model.name}",
            params=f"parent prefix:=lumitip_ meshes:={meshes} *origin",
        )
        macro.append(_link(model, "${prefix}", "${meshes}"))
        joint = _joint(
            f"${{prefix}}{model.name}_mount", "fixed", f"${{prefix}}{model.name}", "${parent}"
        )
        SubElement(joint, f"{{{_NAMESPACE}}}insert_block", name="origin")
        macro.append(joint)
    return _bytes(robot)


def _link(model: FingerModel, prefix: str, meshes: str) -> Element:
    link = Element("link", name=f"{prefix}{model.name}")
    inertial = SubElement(link, "inertial")
    weight = model.weight
    SubElement(inertial, "origin", xyz=_numbers(weight.centre_mm * MM), rpy="0 0 0")
    SubElement(inertial, "mass", value=_numbers([weight.mass_g * MM]))
    inertia = weight.inertia_g_mm2 * MM**3
    axes = {
        f"i{a}{b}": _numbers([inertia[i, j]])
        for i, a in enumerate("xyz")
        for j, b in enumerate("xyz")
        if j >= i
    }
    SubElement(inertial, "inertia", axes)
    for file, colour in model.visuals:
        visual = SubElement(link, "visual", name=file.removesuffix(".stl"))
        visual.append(_mesh(f"{meshes}/{file}"))
        material = SubElement(visual, "material", name=f"{prefix}{file.removesuffix('.stl')}")
        SubElement(material, "color", rgba=_numbers(colour))
    for file in model.collisions:
        collision = SubElement(link, "collision", name=file.removesuffix(".stl"))
        collision.append(_mesh(f"{meshes}/{file}"))
    return link


def _mesh(path: str) -> Element:
    geometry = Element("geometry")
    SubElement(geometry, "mesh", filename=path, scale=_numbers([MM] * 3))
    return geometry


def _joint(name: str, kind: str, child: str, parent: str = "lumitip_base") -> Element:
    joint = Element("joint", name=name, type=kind)
    SubElement(joint, "parent", link=parent)
    SubElement(joint, "child", link=child)
    return joint


def _origin(matrix: Matrix) -> Element:
    """A pose in the form of URDF: turns about the fixed axes x, y, z, in this order."""
    turn = matrix[:3, :3]
    pitch = np.arctan2(-turn[2, 0], np.hypot(turn[0, 0], turn[1, 0]))
    if np.hypot(turn[0, 0], turn[1, 0]) < 1e-9:  # x looks along z: only yaw minus roll is defined
        roll, yaw = np.arctan2(-turn[1, 2], turn[1, 1]), 0.0
    else:
        roll, yaw = np.arctan2(turn[2, 1], turn[2, 2]), np.arctan2(turn[1, 0], turn[0, 0])
    return Element("origin", xyz=_numbers(matrix[:3, 3] * MM), rpy=_numbers([roll, pitch, yaw]))


def _numbers(values: object) -> str:
    numbers = np.asarray(values, dtype=float).reshape(-1)
    return " ".join(f"{value:.9g}" for value in np.where(np.abs(numbers) < 1e-15, 0.0, numbers))


def _bytes(robot: Element) -> bytes:
    ElementTree.indent(robot)
    return b'<?xml version="1.0"?>\n' + ElementTree.tostring(robot) + b"\n"


CHORD_MM = 0.05
_MESHES = "meshes"


def robot_files(design: Design) -> tuple[Artefact, ...]:
    """URDF of the pair, a xacro macro for each finger, and the meshes that both name."""
    stack, mount, closing = design.stack, design.mount, design.closing
    to_base = gripper_to_base(stack, mount, closing)
    models, files = [], []
    for finger in (design.receiver, design.emitter):
        layers = dict(layers_of(finger_bodies(design, finger)))
        meshes = dict(_meshes(finger, layers, stack))
        models.append(
            FingerModel(
                name=finger.name,
                weight=_weight(finger, layers, stack, design.densities),
                visuals=tuple((f"{finger.name}_{k}.stl", colour_of(k)) for k in layers),
                collisions=tuple(name for name in meshes if "collision" in name),
                to_base=to_base @ _closed(finger.name, mount, closing),
                opening=_opening(finger.name, mount, closing),
            )
        )
        files += [Artefact(f"robot/{_MESHES}/{n}", export.mesh_stl(m)) for n, m in meshes.items()]
    pair = tuple(models)
    travel_mm, effort_n = closing.max_opening_mm / 2, design.strength.closing_n
    urdf = pair_urdf(pair, float(to_base[2, 3]), travel_mm, effort_n, _MESHES)
    masses = {f"{model.name}_g": model.weight.mass_g for model in pair}
    return (
        Artefact("robot/lumitip.urdf", urdf, frame="", facts=masses),
        Artefact("robot/lumitip.xacro", pair_xacro(pair, _MESHES), frame=""),
        *files,
    )


def _meshes(finger: Finger, layers: dict[str, Solid], stack: Stack) -> Iterator[tuple[str, Mesh]]:
    """Visual meshes of the layers, and convex collision meshes: the plate with its skin, and the
    block behind it."""
    shown = {kind: export.mesh(layer, CHORD_MM) for kind, layer in layers.items()}
    for kind, surface in shown.items():
        yield f"{finger.name}_{kind}.stl", surface
    backing = trimesh.Trimesh(shown["backing"].points_mm, shown["backing"].triangles)
    plane = (0.0, 0.0, stack.back_z_mm)
    plate = [backing.slice_plane(plane, (0, 0, 1)).vertices]
    plate += [shown[kind].points_mm for kind in ("silicone", "film")]
    yield f"{finger.name}_collision_plate.stl", _hull(np.concatenate(plate))
    if "interface" in shown:
        block = shown["interface"].points_mm
    else:
        block = backing.slice_plane(plane, (0, 0, -1)).vertices
    yield f"{finger.name}_collision_block.stl", _hull(block)


def _hull(points_mm: NDArray[np.float64]) -> Mesh:
    hull = trimesh.PointCloud(points_mm).convex_hull
    return Mesh(np.asarray(hull.vertices), np.asarray(hull.faces))


def _weight(finger: Finger, layers: dict[str, Solid], stack: Stack, densities: Densities) -> Weight:
    """Everything of a finger, each with its density."""
    whole = GProp_GProps()
    for kind, layer in layers.items():
        _add(whole, layer, getattr(densities, f"{kind}_g_ml"))
    for part in finger.parts:
        # The silicone is whole: where a part stands in it, there is the part instead.
        buried = densities.silicone_g_ml if part.side == "front" else 0.0
        _add(whole, part_solid(part, stack), densities.part_g_ml - buried)
    inertia = whole.MatrixOfInertia()
    centre = whole.CentreOfMass()
    return Weight(
        mass_g=whole.Mass() / 1000,
        centre_mm=np.array([centre.X(), centre.Y(), centre.Z()]),
        inertia_g_mm2=np.array([[inertia.Value(i, j) for j in (1, 2, 3)] for i in (1, 2, 3)])
        / 1000,
    )


def _add(whole: GProp_GProps, shape: Shape, density_g_ml: float) -> None:
    own = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape.wrapped, own)
    whole.Add(own, density_g_ml)


def _closed(finger: str, mount: Mount, closing: Closing) -> Matrix:
    return finger_to_gripper(finger, mount, closing, 0.0)


def _opening(finger: str, mount: Mount, closing: Closing) -> NDArray[np.float64]:
    """The way a finger goes when the gripper opens, in its own frame."""
    outward = 1.0 if finger == "emitter" else -1.0
    turn = _closed(finger, mount, closing)[:3, :3]
    return np.asarray(turn.T @ (0.0, 0.0, outward))
