"""Everything from the robot's tool flange to the fingertips, as bodies and as a drawing."""

import io
import math
from collections.abc import Iterator

import numpy as np
import trimesh
from numpy.typing import NDArray

from lumitip_fab.design import AuxiliaryBoard, Design, Finger, Flange, Holder, Stack, System, frames
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.pipeline.artefact import Artefact, Files
from lumitip_fab.scenes.glb import Body, Group, colour_of, glb
from lumitip_fab.scenes.mounted_view import mounted_view
from lumitip_fab.scenes.system_view import system_view

SECTIONS = 96
"""Chords of a whole circle."""


def disc(diameter_mm: float, low_mm: float, high_mm: float) -> Mesh:
    """A cylinder round z."""
    return prism(ring(diameter_mm / 2), low_mm, high_mm)


def block(
    x_mm: tuple[float, float],
    y_mm: tuple[float, float],
    corner_mm: float,
    low_mm: float,
    high_mm: float,
) -> Mesh:
    """A block, its edges along z rounded."""
    quarter = SECTIONS // 4
    outline = []
    for k, (right, top) in enumerate(((1, 1), (0, 1), (0, 0), (1, 0))):
        centre = (x_mm[right] + corner_mm * (1 - 2 * right), y_mm[top] + corner_mm * (1 - 2 * top))
        for step in range(quarter + 1 if corner_mm else 1):
            turn = math.pi / 2 * (k + step / quarter)
            outline.append(
                (centre[0] + corner_mm * math.cos(turn), centre[1] + corner_mm * math.sin(turn))
            )
    rounded = np.round(np.array(outline), 9)
    distinct = np.abs(rounded - np.roll(rounded, 1, axis=0)).max(axis=1) > 1e-6
    return prism(rounded[distinct], low_mm, high_mm)


def socket(diameter_mm: float, recess_mm: float, height_mm: float, depth_mm: float) -> Mesh:
    """A cylinder round z from z = 0, with a round recess in its top."""
    outer, inner = ring(diameter_mm / 2), ring(recess_mm / 2)
    floor = height_mm - depth_mm
    rings = [_at(outer, 0.0), _at(outer, height_mm), _at(inner, height_mm), _at(inner, floor)]
    n = len(outer)
    walls = [wall for k in range(3) for wall in _band(k * n, (k + 1) * n, n)]
    triangles = [*walls, *_fan(0, n)[:, ::-1].tolist(), *_fan(3 * n, n).tolist()]
    return Mesh(np.concatenate(rings), np.array(triangles, dtype=np.int64))


def prism(outline: NDArray[np.float64], low_mm: float, high_mm: float) -> Mesh:
    """A convex outline, counter-clockwise, along z."""
    n = len(outline)
    triangles = [*_band(0, n, n), *_fan(0, n)[:, ::-1].tolist(), *_fan(n, n).tolist()]
    points = np.concatenate([_at(outline, low_mm), _at(outline, high_mm)])
    return Mesh(points, np.array(triangles, dtype=np.int64))


def ring(radius_mm: float, corners: int = SECTIONS) -> NDArray[np.float64]:
    """Corners round z, as chords of a circle."""
    turn = np.arange(corners) * (2 * math.pi / corners)
    return np.column_stack([radius_mm * np.cos(turn), radius_mm * np.sin(turn)])


def _at(outline: NDArray[np.float64], z_mm: float) -> NDArray[np.float64]:
    return np.column_stack([outline, np.full(len(outline), z_mm)])


def _fan(first: int, n: int) -> NDArray[np.int64]:
    """Triangles over a convex ring of corners, seen from +z counter-clockwise."""
    return np.array([(first, first + k, first + k + 1) for k in range(1, n - 1)])


def _band(low: int, high: int, n: int) -> list[tuple[int, int, int]]:
    """Triangles between two rings of corners, from the outside if the second is above."""
    corners = [(k, (k + 1) % n) for k in range(n)]
    return [
        t for a, b in corners for t in ((low + a, low + b, high + b), (low + a, high + b, high + a))
    ]


ROBOT_MM = 6.0
"""How thick the disc is that stands for the robot's tool flange."""
_M_TO_MM = np.diag([1000.0, 1000.0, 1000.0, 1.0])
_MM = 1000.0


def system_files(design: Design, files: Files) -> tuple[Artefact, ...]:
    """Printed parts, boards and the assembly of the fingers: GLB in the tool frame, and an
    exploded drawing."""
    stack, mount, system = design.stack, design.mount, design.system
    boards = {auxiliary.name: auxiliary for auxiliary in design.auxiliary_boards}
    groups: list[Group] = []
    for flange in design.flanges:
        groups += _robot_side(files, flange, boards[flange.auxiliary], stack, system)
    groups.append(Group("gripper", _raised(system.gripper_z_mm), (_envelope(system),)))
    for holder in design.holders:
        if holder.name in system.holders:
            groups.append(_held(files, holder, boards[holder.auxiliary], stack, system))
    to_tool = frames.gripper_to_tool(stack, mount, design.closing, system)
    scene = trimesh.load(io.BytesIO(files.read("assembly/assembly.glb")), file_type="glb")
    groups += [finger_group(scene, finger, to_tool) for finger in design.fingers]
    tcp_mm = float(to_tool[2, 3])
    extras = {"opening_mm": float(scene.metadata["opening_mm"]), "tcp_mm": tcp_mm}
    drawing = system_view(groups, design.flanges, mount, system, tcp_mm)
    mounted = [
        Artefact(
            "manual/mounted.svg", mounted_view(groups, holder, mount, system).encode(), frame=""
        )
        for holder in design.holders
        if holder.name in system.holders
    ]
    return (
        *mounted,
        Artefact("assembly/system.glb", glb("system", tuple(groups), extras), _M_TO_MM, "tool"),
        Artefact("assembly/system.svg", drawing.encode(), frame=""),
    )


def _robot_side(
    files: Files, flange: Flange, auxiliary: AuxiliaryBoard, stack: Stack, system: System
) -> Iterator[Group]:
    """The robot's tool flange, the coupling, and the printed flange round its board."""
    robot = disc(system.robot_mm, -ROBOT_MM, 0.0)
    yield Group("robot", np.eye(4), (Body("robot.flange", robot, colour_of("robot")),))
    coupling = socket(flange.face_mm, flange.centring_mm, system.coupling_mm, -flange.seat_z_mm)
    yield Group("coupling", np.eye(4), (Body("coupling.body", coupling, colour_of("coupling")),))
    to_tool, beds = frames.flange_to_tool(system), frames.flange_beds(flange)
    parts = {
        part: Body(
            f"{flange.name}.{part}",
            stl_mesh(files, f"flange/{flange.name}_{part}.stl"),
            colour_of(part),
        )
        for part in beds
    }
    board = Body(f"{flange.name}.board", _board(auxiliary, stack), colour_of("board"))
    yield Group(f"{flange.name}_lower", to_tool @ beds["lower"], (parts["lower"],))
    yield Group(f"{flange.name}_board", to_tool @ frames.auxiliary_to_flange(flange), (board,))
    yield Group(f"{flange.name}_upper", to_tool @ beds["upper"], (parts["upper"],))


def _envelope(system: System) -> Body:
    half = system.width_mm / 2, system.depth_mm / 2
    return Body(
        "gripper.envelope",
        block((-half[0], half[0]), (-half[1], half[1]), system.corner_mm, 0.0, system.length_mm),
        colour_of("gripper"),
    )


def _held(
    files: Files, holder: Holder, auxiliary: AuxiliaryBoard, stack: Stack, system: System
) -> Group:
    """A holder with its board, in the board's frame."""
    bed = frames.holder_bed_to_auxiliary(holder)
    printed = stl_mesh(files, f"holder/{holder.name}.stl").moved(bed)
    bodies = (
        Body(f"{holder.name}.tray", printed, colour_of("holder")),
        Body(f"{holder.name}.board", _board(auxiliary, stack), colour_of("board")),
    )
    return Group(holder.name, frames.holder_to_tool(holder, system), bodies)


def finger_group(scene: trimesh.Scene, finger: Finger, to_tool: frames.Matrix) -> Group:
    """A finger as the assembly has it, every body in the finger's frame."""
    kinds = {finger.body_name(part): part.kind for part in finger.parts}
    placed = scene.graph.get(finger.name)[0].copy()
    placed[:3, 3] *= _MM
    bodies = []
    for name in sorted(scene.graph.nodes_geometry):
        if not name.startswith(f"{finger.name}."):
            continue
        place, geometry = scene.graph.get(name, finger.name)
        surface = scene.geometry[geometry]
        points = (surface.vertices @ place[:3, :3].T + place[:3, 3]) * _MM
        kind = kinds.get(name, name.rpartition(".")[2])
        mesh = Mesh(np.asarray(points), np.asarray(surface.faces, dtype=np.int64))
        bodies.append(Body(name, mesh, colour_of(kind)))
    return Group(finger.name, np.asarray(to_tool @ placed), tuple(bodies))


def _board(auxiliary: AuxiliaryBoard, stack: Stack) -> Mesh:
    box = auxiliary.box
    across, along = (box.x_min_mm, box.x_max_mm), (box.y_min_mm, box.y_max_mm)
    return block(across, along, auxiliary.corner_mm, 0.0, stack.auxiliary_mm)


def stl_mesh(files: Files, path: str) -> Mesh:
    """A printed part in its own frame."""
    read = trimesh.load(io.BytesIO(files.read(path)), file_type="stl")
    return Mesh(np.asarray(read.vertices), np.asarray(read.faces, dtype=np.int64))


def _raised(by_mm: float) -> frames.Matrix:
    matrix = np.eye(4)
    matrix[2, 3] = by_mm
    return matrix
