"""Both fingers as a robot's software wants them: URDF, xacro, meshes, masses."""

from collections.abc import Iterator

import numpy as np
import trimesh
from build123d import Shape, Solid
from numpy.typing import NDArray
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps

from lumitip_fab.artefact import Artefact
from lumitip_fab.design import (
    Board,
    Closing,
    Densities,
    Finger,
    Interface,
    Mould,
    Mount,
    Outline,
    Stack,
    Tip,
)
from lumitip_fab.frames import Matrix, finger_to_gripper, gripper_to_base
from lumitip_fab.mechanical import export, urdf
from lumitip_fab.mechanical.bodies import finger_bodies, layers_of, part_solid
from lumitip_fab.mechanical.surface import Mesh
from lumitip_fab.mechanical.tints import COLOURS

CHORD_MM = 0.05
_MESHES = "meshes"


def robot_files(
    stack: Stack,
    outline: Outline,
    tip: Tip,
    board: Board,
    emitter: Finger,
    receiver: Finger,
    mount: Mount,
    closing: Closing,
    mould: Mould,
    densities: Densities,
    interfaces: tuple[Interface, ...],
) -> tuple[Artefact, ...]:
    """URDF of the pair, a xacro macro for each finger, and the meshes that both name."""
    to_base = gripper_to_base(stack, mount, closing)
    models, files = [], []
    for finger in (receiver, emitter):
        bodies = finger_bodies(finger, stack, outline, tip, board, mount, mould, interfaces)
        layers = dict(layers_of(bodies))
        meshes = dict(_meshes(finger, layers, stack))
        models.append(
            urdf.FingerModel(
                name=finger.name,
                weight=_weight(finger, layers, stack, densities),
                visuals=tuple((f"{finger.name}_{k}.stl", COLOURS[k]) for k in layers),
                collisions=tuple(name for name in meshes if "collision" in name),
                to_base=to_base @ _closed(finger.name, mount, closing),
                opening=_opening(finger.name, mount, closing),
            )
        )
        files += [Artefact(f"robot/{_MESHES}/{n}", export.mesh_stl(m)) for n, m in meshes.items()]
    pair = tuple(models)
    travel_mm = closing.max_opening_mm / 2
    return (
        Artefact(
            "robot/lumitip.urdf",
            urdf.pair(pair, float(to_base[2, 3]), travel_mm, _MESHES),
            frame="",
        ),
        Artefact("robot/lumitip.xacro", urdf.macros(pair, _MESHES), frame=""),
        *files,
    )


def _meshes(finger: Finger, layers: dict[str, Solid], stack: Stack) -> Iterator[tuple[str, Mesh]]:
    """What is looked at, and the convex bodies that touch: the plate with its skin, and the block
    behind it."""
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


def _weight(
    finger: Finger, layers: dict[str, Solid], stack: Stack, densities: Densities
) -> urdf.Weight:
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
    return urdf.Weight(
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
