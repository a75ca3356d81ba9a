"""The assembled gripper: what faces what, what touches first, and that nothing else touches.

Measured from the bodies of the GLB file, in the gripper frame: the fingers meet at z = 0.
"""

import math
from collections.abc import Iterator
from itertools import combinations
from pathlib import Path

import numpy as np

from lumitip_fab.checks.colours import wrong_colours
from lumitip_fab.checks.drawings import measure_exploded
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.scene import Node, Scene, read_scene
from lumitip_fab.checks.readers.solids import Vectors
from lumitip_fab.checks.result import Measurement, Subject, unreadable
from lumitip_fab.design import Design, Finger
from lumitip_fab.design.frames import applied, mount_to_sensor, translation
from lumitip_fab.errors import OutputError

READS = (
    "assembly/assembly.glb",
    "assembly/assembly.step",
    "assembly/*_exploded.svg",
    "backing/*_backing.stl",
    "interface/*_interface.stl",
)
NAMES = (
    "assembly.bodies",
    "assembly.facing",
    "assembly.lean",
    "assembly.skew",
    "assembly.first_contact",
    "assembly.opening",
    "assembly.stroke",
    "assembly.closes",
    "assembly.interference",
    "assembly.colours",
)
FACING_MM = 0.05
LEAN_DEG = 0.02
_TOUCH_MM = 1e-4
OPENING_MM = 0.02
STROKE_MM = 0.05
SHARED_MM3 = 0.05
_FILE = "assembly/assembly.glb"
_GLB = Subject("assembly", _FILE)
_STEP = "assembly/assembly.step"
_STEP_END = "END-ISO-10303-21;"
_FLAT = 0.9  # of the face's own normal: leaves out taper and rounding


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Hold the assembly against the design."""
    yield _step(outputs, design)
    for finger in design.fingers:
        yield from measure_exploded(outputs, design, finger)
    try:
        scene = read_scene(outputs / _FILE)
    except OutputError as error:
        yield from (unreadable(name, _FILE, str(error)) for name in NAMES)
        return
    missing = [name for name in _wanted(design) if name not in scene.nodes]
    note = f"of {len(scene.nodes)}" + (f", first {missing[0]}" if missing else "")
    yield Measurement("assembly.bodies", _FILE, len(missing), 0, 0, "missing", note)
    if missing:
        reason = f"{missing[0]} is missing"
        yield from (unreadable(name, _FILE, reason) for name in NAMES[1:])
        return
    yield _facing(scene, design)
    yield from _leans(scene, design)
    yield from _contacts(scene, design)
    yield from _openings(scene, design)
    yield from _interference(scene, design)
    colours = {name: node.colour for name, node in scene.nodes.items()}
    yield _GLB.count("colours", list(wrong_colours(colours, design)), "colours")


def _step(outputs: Path, design: Design) -> Measurement:
    """The STEP file holds every body, in mm, the layers under their names."""
    try:
        text = (outputs / _STEP).read_text(encoding="ascii")
    except (OSError, ValueError) as error:
        return unreadable("assembly.step", _STEP, f"cannot be read: {error!r:.200}")
    names = [f"{finger.name}.{layer}" for finger in design.fingers for layer in design.layers]
    for phrase in (*(f"PRODUCT('{name}'" for name in names), "SI_UNIT(.MILLI.,.METRE.)", _STEP_END):
        if phrase not in text:
            return unreadable("assembly.step", _STEP, f"holds no {phrase}")
    wanted = len(names) + sum(len(finger.parts) for finger in design.fingers)
    solids = text.count("MANIFOLD_SOLID_BREP(")
    return Measurement("assembly.step", _STEP, solids, wanted, wanted, "bodies")


def _wanted(design: Design) -> Iterator[str]:
    for finger in design.fingers:
        yield from (f"{finger.name}.{layer}" for layer in design.layers)
        yield from map(finger.body_name, finger.parts)


def _facing(scene: Scene, design: Design) -> Measurement:
    """LED i against photodetector i, seen along z."""
    numbers = range(1, len(design.cells) + 1)
    lit = np.array([scene.nodes[f"emitter.D{i}"].centre_mm for i in numbers])
    seen = np.array([scene.nodes[f"receiver.Q{i}"].centre_mm for i in numbers])
    apart = np.hypot(*(lit - seen)[:, :2].T)
    worst = int(apart.argmax())
    note = f"D{worst + 1} to Q{worst + 1}, the worst of {len(apart)}"
    return Measurement("assembly.facing", _FILE, float(apart[worst]), 0, FACING_MM, "mm", note)


def _leans(scene: Scene, design: Design) -> Iterator[Measurement]:
    """How far each face is tilted towards the other finger at the tip."""
    tilt = design.mount.tilt_deg
    leans = [_lean_deg(scene.nodes[f"{finger.name}.film"]) for finger in design.fingers]
    for finger, lean in zip(design.fingers, leans, strict=True):
        yield _GLB.near("lean", lean, tilt, LEAN_DEG, "tip inward", "deg", finger.name)
    note = "between the axes of LED and photodetector"
    yield _GLB.near("skew", sum(leans), 2 * tilt, 2 * LEAN_DEG, note, "deg")


def _lean_deg(film: Node) -> float:
    mesh = film.mesh
    flat = mesh.face_normals[:, 2] > _FLAT
    summed = (mesh.face_normals * mesh.area_faces[:, None])[flat]
    heights = mesh.triangles_center[flat][:, 2]
    face = summed[heights > heights.max(initial=-math.inf) - 1e-3].sum(axis=0)
    normal = film.to_scene[:3, :3] @ face
    return float(np.degrees(np.arctan2(-normal[1], abs(normal[2]))))


def _contacts(scene: Scene, design: Design) -> Iterator[Measurement]:
    """The line of each face that stands out farthest, by its distance from the tip."""
    for finger in design.fingers:
        film = scene.nodes[f"{finger.name}.film"]
        reach = _reach_mm(film, finger)
        touching = film.points_mm[reach > reach.max() - _TOUCH_MM]
        place = touching[touching[:, 1].argmax()]  # of a whole line or face, where it begins
        off, most = design.outline.tip_y_mm - place[1], design.closing.most_from_tip_mm
        note = "from the tip edge"
        yield _GLB.figure("first_contact", off, 0, most, note=note, at=finger.name)


def _reach_mm(node: Node, finger: Finger) -> Vectors:
    """How far each corner stands towards the other finger, from the mid-plane."""
    return np.asarray(node.in_scene_mm[:, 2] * _inward(finger))


def _inward(finger: Finger) -> float:
    return 1.0 if finger.name == "receiver" else -1.0


def _openings(scene: Scene, design: Design) -> Iterator[Measurement]:
    """Skin to skin as it is and as the file says, with the gripper open, and closed."""
    stated = scene.extras.get("opening_mm")
    if not isinstance(stated, int | float):
        yield unreadable("assembly.opening", _FILE, "states no opening_mm")
    else:
        opening = _opening_mm(scene, design)
        yield _GLB.near("opening", opening, stated, OPENING_MM, "skin to skin")
    widest = design.mount.stroke_mm
    for finger in design.fingers:
        skin = _reach_mm(scene.nodes[f"{finger.name}.film"], finger).max()
        bolt = _bolt_z_mm(scene.nodes[f"{finger.name}.{design.held}"], design) * _inward(finger)
        widest += design.mount.pad_w_mm - (skin - bolt)
    note = "skin to skin in the open gripper"
    yield _GLB.near("stroke", widest, design.closing.max_opening_mm, STROKE_MM, note)
    note = "left between the gripper's pads when the skins meet"
    yield _GLB.figure("closes", design.mount.stroke_mm - widest, 0, math.inf, note=note)


def _opening_mm(scene: Scene, design: Design) -> float:
    reaches = [_reach_mm(scene.nodes[f"{f.name}.film"], f).max() for f in design.fingers]
    return float(-sum(reaches))


def _bolt_z_mm(backing: Node, design: Design) -> float:
    """Height of the bolts' axes in the gripper frame, by the first one's hole (or the sleeve's
    round it) in the mount plane."""
    mount = design.mount
    hole = max(mount.bolt_hole_mm, mount.pin_mm) if mount.sleeved else mount.bolt_hole_mm
    to_sensor = mount_to_sensor(mount, design.stack)
    corners = applied(np.asarray(np.linalg.inv(to_sensor), dtype=np.float64), backing.points_mm)
    radius = np.hypot(corners[:, 0] - mount.bolt_u_mm[0], corners[:, 1] - mount.bolt_w_mm)
    rim = corners[(np.abs(corners[:, 2]) < 0.01) & (radius < hole / 2 + 0.4)]
    if not len(rim):
        return math.nan
    middle = (rim.min(axis=0) + rim.max(axis=0)) / 2
    return float(applied(backing.to_scene @ to_sensor, middle[None])[0, 2])


def _interference(scene: Scene, design: Design) -> Iterator[Measurement]:
    """Volume shared by the bodies of a finger, and by both fingers when they just touch."""
    try:
        fingers = [_bodies(scene, finger, design.layers) for finger in design.fingers]
    except OutputError as error:
        yield unreadable("assembly.interference", _FILE, str(error))
        return
    for finger, bodies in zip(design.fingers, fingers, strict=True):
        pairs = [p for p in combinations(bodies, 2) if p != ("silicone", "parts")]
        yield _worst(
            f"{_FILE}: {finger.name}",
            {f"{a} and {b}": solids.shared_mm3(bodies[a], bodies[b]) for a, b in pairs},
        )
    opening = _opening_mm(scene, design)
    closed = []
    for finger, bodies in zip(design.fingers, fingers, strict=True):
        to_scene = scene.nodes[f"{finger.name}.film"].to_scene
        shut = translation(0.0, 0.0, _inward(finger) * opening / 2) @ to_scene
        closed.append({name: solids.placed(body, shut) for name, body in bodies.items()})
    yield _worst(
        f"{_FILE}: closed",
        {
            f"{a} and {b}": solids.shared_mm3(closed[0][a], closed[1][b])
            for a in closed[0]
            for b in closed[1]
        },
    )


def _bodies(scene: Scene, finger: Finger, layers: tuple[str, ...]) -> dict[str, solids.Solid]:
    """The layers and, as one body, the parts."""
    bodies = {
        layer: solids.solid(scene.nodes[f"{finger.name}.{layer}"].mesh, layer) for layer in layers
    }
    bodies["parts"] = solids.united(
        [solids.solid(scene.nodes[name].mesh, name) for name in map(finger.body_name, finger.parts)]
    )
    return bodies


def _worst(subject: str, shared: dict[str, float]) -> Measurement:
    which = max(shared, key=lambda pair: shared[pair])
    note = f"{which}, the worst of {len(shared)} pairs"
    return Measurement("assembly.interference", subject, shared[which], 0, SHARED_MM3, "mm³", note)
