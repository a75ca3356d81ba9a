"""Everything from the robot's tool flange to the fingertips: in order and in place.

Measured from the bodies of the GLB file, in the tool frame. Bodies that stand for what is bought
are plain: only printed parts, boards and fingers are held against each other.
"""

from collections.abc import Iterator
from itertools import combinations
from pathlib import Path

import numpy as np

from lumitip.errors import LayoutError
from lumitip.layout import Layout
from lumitip_fab.checks.colours import wrong_colours
from lumitip_fab.checks.drawings import measure_system
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.scene import Scene, read_scene
from lumitip_fab.checks.readers.solids import Vectors
from lumitip_fab.checks.result import Measurement, count, unreadable
from lumitip_fab.design import AuxiliaryBoard, Design, frames
from lumitip_fab.errors import OutputError

READS = (
    "assembly/system.*",
    "assembly/assembly.glb",
    "layout.json",
    "flange/*.stl",
    "holder/*.stl",
)
_FILE = "assembly/system.glb"
_ASSEMBLY = "assembly/assembly.glb"
_LAYOUT = "layout.json"
_BODIES = ("bodies", "stack", "place", "fingers", "tcp", "interference", "axis", "colours")
_BOUGHT = ("robot.flange", "coupling.body", "gripper.envelope")
"""Bodies that stand for what is bought, round the tool's axis."""
SHARED_MM3 = 0.05
PLACE_MM = 0.02


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Hold scene and drawing against the design and its files."""
    yield from measure_system(outputs, design)
    try:
        scene = read_scene(outputs / _FILE)
        missing = [name for name in wanted_bodies(design) if name not in scene.nodes]
    except OutputError as error:
        yield from (unreadable(f"system.{name}", _FILE, str(error)) for name in _BODIES)
        return
    note = f"of {len(scene.nodes)}" + (f", first {missing[0]}" if missing else "")
    yield Measurement("system.bodies", _FILE, len(missing), 0, 0, "missing", note)
    if missing:
        reason = f"{missing[0]} is missing"
        yield from (unreadable(f"system.{name}", _FILE, reason) for name in _BODIES[1:])
        return
    yield from _stack(scene, design)
    yield _placed("place", scene, _files(outputs, design), "file or outline")
    yield _placed("fingers", scene, _fingers(outputs, design), "the assembly")
    yield _interference(scene, design)
    bought = [name for name in _BOUGHT if name in scene.nodes]
    off = {name: float(np.abs(scene.nodes[name].centre_mm[:2]).max()) for name in bought}
    worst = max(off, key=lambda name: off[name])
    yield Measurement("system.axis", _FILE, off[worst], 0, PLACE_MM, "mm", f"{worst} off the axis")
    colours = {name: node.colour for name, node in scene.nodes.items()}
    yield count("system.colours", _FILE, list(wrong_colours(colours, design)), "colours")
    try:
        yield from _centre(_tcp(scene, Layout.load(outputs / _LAYOUT)), scene, design)
    except (LayoutError, KeyError) as error:
        yield unreadable("system.tcp", _FILE, str(error))


def real_bodies(design: Design) -> Iterator[str]:
    """Names of the bodies whose shape is that of the thing itself."""
    for flange in design.flanges:
        yield from (f"{flange.name}.{part}" for part in ("lower", "board", "upper"))
    for holder in design.system.holders:
        yield from (f"{holder}.{part}" for part in ("tray", "board"))
    for finger in design.fingers:
        yield f"{finger.name}.{design.held}"


def wanted_bodies(design: Design) -> Iterator[str]:
    """Names of all bodies."""
    if design.flanges:
        yield from ("robot.flange", "coupling.body")
    yield "gripper.envelope"
    yield from real_bodies(design)
    for finger in design.fingers:
        yield from (f"{finger.name}.{layer}" for layer in design.layers)
        yield from map(finger.body_name, finger.parts)


def _bounds(scene: Scene, name: str) -> Vectors:
    """Least and greatest corner in the tool frame."""
    points = scene.nodes[name].in_scene_mm
    return np.array([points.min(axis=0), points.max(axis=0)])


def _stack(scene: Scene, design: Design) -> Iterator[Measurement]:
    """Gaps along the axis from body to body, below zero where they solids."""
    system = design.system
    gripper = _bounds(scene, "gripper.envelope")[:, 2]
    foot = min(_bounds(scene, f"{f.name}.{design.held}")[0, 2] for f in design.fingers)
    gaps = {
        "gripper to fingers": foot - gripper[0] - system.reach_mm,
        "along the gripper": gripper[1] - gripper[0] - system.length_mm,
    }
    if not design.flanges:
        gaps["gripper on z = 0"] = gripper[0]
    for flange in design.flanges:
        robot, coupling = (_bounds(scene, n)[:, 2] for n in ("robot.flange", "coupling.body"))
        lower, upper = (_bounds(scene, f"{flange.name}.{n}")[:, 2] for n in ("lower", "upper"))
        gaps |= {
            "robot's tool flange": robot[1],
            "robot to coupling": coupling[0] - robot[1],
            "coupling's recess to flange": lower[0] - _recess_z_mm(scene),
            "lower to upper part": upper[0] - (lower[1] - flange.peg_height_mm),
            "flange to gripper": gripper[0] - upper[1],
        }
    worst = max(gaps, key=lambda joint: np.nan_to_num(abs(gaps[joint]), nan=np.inf))
    note = f"{worst}, the worst of {len(gaps)}"
    yield Measurement("system.stack", _FILE, float(gaps[worst]), -PLACE_MM, PLACE_MM, "mm", note)


def _recess_z_mm(scene: Scene) -> float:
    """Floor of the coupling's recess: the lowest face that looks up."""
    node = scene.nodes["coupling.body"]
    up = node.mesh.face_normals[:, 2] > 1 - 1e-6
    floor = frames.applied(node.to_scene, node.points_mm[node.triangles[up].ravel()])
    return float(floor[:, 2].min()) if len(floor) else np.nan


def _files(outputs: Path, design: Design) -> Iterator[tuple[str, Vectors]]:
    """Corners in the tool frame of each printed part, by its file, and of each board, by its
    outline."""
    auxiliary_boards = {auxiliary.name: auxiliary for auxiliary in design.auxiliary_boards}
    for flange in design.flanges:
        to_tool = frames.flange_to_tool(design.system)
        for part, bed in frames.flange_beds(flange).items():
            mesh = solids.read_mesh(outputs / f"flange/{flange.name}_{part}.stl")
            yield f"{flange.name}.{part}", frames.applied(to_tool @ bed, mesh.vertices)
        corners = _corners(auxiliary_boards[flange.auxiliary], design)
        yield (
            f"{flange.name}.board",
            frames.applied(to_tool @ frames.auxiliary_to_flange(flange), corners),
        )
    for holder in design.holders:
        if holder.name in design.system.holders:
            to_tool = frames.holder_to_tool(holder, design.system)
            mesh = solids.read_mesh(outputs / f"holder/{holder.name}.stl")
            standing = to_tool @ frames.holder_bed_to_auxiliary(holder)
            yield f"{holder.name}.tray", frames.applied(standing, mesh.vertices)
            corners = _corners(auxiliary_boards[holder.auxiliary], design)
            yield f"{holder.name}.board", frames.applied(to_tool, corners)


def _corners(auxiliary: AuxiliaryBoard, design: Design) -> Vectors:
    box = auxiliary.box
    return np.array(
        [
            (x, y, z)
            for x in (box.x_min_mm, box.x_max_mm)
            for y in (box.y_min_mm, box.y_max_mm)
            for z in (0.0, design.stack.auxiliary_mm)
        ]
    )


def _fingers(outputs: Path, design: Design) -> Iterator[tuple[str, Vectors]]:
    """Corners in the tool frame of each body of the fingers, by the assembly."""
    to_tool = _to_tool(design)
    for name, node in read_scene(outputs / _ASSEMBLY).nodes.items():
        yield name, frames.applied(to_tool, node.in_scene_mm)


def _to_tool(design: Design) -> frames.Matrix:
    return frames.gripper_to_tool(design.stack, design.mount, design.closing, design.system)


def _placed(
    check: str, scene: Scene, wanted: Iterator[tuple[str, Vectors]], by: str
) -> Measurement:
    """How far the extents of a body are from those that they ought to be."""
    try:
        off = {
            name: float(np.abs(_bounds(scene, name) - (at.min(axis=0), at.max(axis=0))).max())
            for name, at in wanted
        }
    except (OutputError, KeyError) as error:
        return unreadable(f"system.{check}", _FILE, str(error))
    worst = max(off, key=lambda name: off[name], default="")
    note = f"{worst} from {by}, the worst of {len(off)}"
    return Measurement(f"system.{check}", _FILE, off.get(worst, 0.0), 0, PLACE_MM, "mm", note)


def _tcp(scene: Scene, layout: Layout) -> Vectors:
    """Midway between both fingers' faces, where `layout.json` has the origin of its cells.

    The origin is the mean of the cells in x, but not in y, where columns are equal or irregular.
    """
    up_mm = float(layout.y_mm.mean())
    middles = []
    for first in ("emitter.D", "receiver.Q"):
        cells = [scene.nodes[f"{first}{i}"] for i in range(1, len(layout) + 1)]
        extents = [(node.points_mm.min(axis=0) + node.points_mm.max(axis=0)) / 2 for node in cells]
        middle = np.mean(extents, axis=0) * (1.0, 1.0, 0.0) - (0.0, up_mm, 0.0)
        middles.append(frames.applied(cells[0].to_scene, middle[None])[0])
    return np.asarray(np.mean(middles, axis=0))


def _centre(tcp: Vectors, scene: Scene, design: Design) -> Iterator[Measurement]:
    wanted = float(_to_tool(design)[2, 3])
    limits = wanted - PLACE_MM, wanted + PLACE_MM
    note = "origin of layout.json, from the robot's tool flange"
    yield Measurement("system.tcp", _FILE, float(tcp[2]), *limits, "mm", note)
    aside = float(np.hypot(*tcp[:2]))
    yield Measurement("system.tcp", f"{_FILE} aside", aside, 0, PLACE_MM, "mm", "off the axis")
    extra = scene.extras.get("tcp_mm")
    stated = float(extra) if isinstance(extra, int | float) else np.nan
    yield Measurement("system.tcp", f"{_FILE} stated", stated, *limits, "mm", "in the file")


def _interference(scene: Scene, design: Design) -> Measurement:
    """The greatest volume that two bodies share whose shapes are real."""
    try:
        bodies = {
            name: solids.placed(
                solids.solid(scene.nodes[name].mesh, name), scene.nodes[name].to_scene
            )
            for name in real_bodies(design)
        }
    except OutputError as error:
        return unreadable("system.interference", _FILE, str(error))
    shared = {
        f"{a} and {b}": solids.shared_mm3(bodies[a], bodies[b]) for a, b in combinations(bodies, 2)
    }
    worst = max(shared, key=lambda pair: shared[pair])
    note = f"{worst}, the worst of {len(shared)} pairs"
    return Measurement("system.interference", _FILE, shared[worst], 0, SHARED_MM3, "mm³", note)
