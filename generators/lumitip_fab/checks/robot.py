"""The URDF of both fingers: tree, places when closed and open, masses, inertia, and what
touches."""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import trimesh

from lumitip_fab.checks.colours import Colour, wrong_colours
from lumitip_fab.checks.readers.solids import Vectors, moved
from lumitip_fab.checks.readers.urdf import Link, Model, read_macros, read_urdf, xml_text
from lumitip_fab.checks.result import Measurement, Subject, count, unreadable
from lumitip_fab.design import Design, Finger
from lumitip_fab.errors import OutputError

READS = ("robot/*", "robot/meshes/*")
_FILE, _MACROS = "robot/lumitip.urdf", "robot/lumitip.xacro"
_FINGERS = ("receiver", "emitter")
_CHECKS = (
    "tree",
    "facing",
    "tcp",
    "seat",
    "closed",
    "open",
    "slide",
    "limits",
    "mass",
    "centre",
    "inertia",
    "reach",
    "bulk",
    "colours",
)
PLACE_MM = 0.02
GAP_MM = 0.1  # the meshes are coarser than the parts, and a film's taper ends in one edge
MASS = 0.01
CENTRE_MM = 0.1
INERTIA = 0.01  # of the largest moment
REACH_MM = 0.02
_SPEED_MM_S = 150.0  # the largest of the Robotiq 2F-85's data sheet; the design has no speed
BULK = 1.6  # volume of what touches, of what is seen
_MOUNT = """
<joint xmlns:xacro="http://www.ros.org/wiki/xacro" name="{link}_mount" type="fixed">
  <parent link="${{parent}}" /><child link="{link}" /><xacro:insert_block name="origin" />
</joint>
"""
"""Joint of a macro: the user sets parent and place."""
_USES = (("left/", "package://left/meshes"), ("b2_", "file:///b2"))
"""Prefix and folder of meshes of two users: what is not theirs is a name written out."""
_PARAMETERS = "parent prefix:=lumitip_ meshes:=meshes *origin"
_SETTINGS = {"strippath": "false", "discardvisual": "false"}
"""Without these MuJoCo forgets folders and what is only looked at."""
_FOLLOWS = {"lumitip_emitter_joint": ("lumitip_receiver_joint", 1.0, 0.0)}
_ALONE = ("", 1.0, 0.0)
_URDF = Subject("robot", _FILE)


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Read the model and hold it against the design; its meshes give gaps, masses and reach."""
    try:
        model = read_urdf(outputs / _FILE)
    except OutputError as error:
        yield from (unreadable(f"robot.{name}", _FILE, str(error)) for name in _CHECKS)
    else:
        wrong = [*_misplaced(model), *_unseen(model, design)]
        yield _URDF.count("tree", wrong, "links and joints")
        if not wrong:
            yield from _places(model, design)
            yield _URDF.count("colours", list(_unlike(model, design)), "colours")
            for finger in design.fingers:
                yield from _body(model.links[f"lumitip_{finger.name}"], finger, design)
    yield _macros(outputs)


def _misplaced(model: Model) -> list[str]:
    """Names that users of the model expect and that are missing."""
    wanted = {
        **{f"lumitip_{f}_joint": ("prismatic", "lumitip_base", f"lumitip_{f}") for f in _FINGERS},
        "lumitip_tcp_joint": ("fixed", "lumitip_base", "lumitip_tcp"),
    }
    found = {name: (j.kind, j.parent, j.child) for name, j in model.joints.items()}
    wrong = sorted(name for name in {*wanted, *found} if wanted.get(name) != found.get(name))
    bodies = {"lumitip_base", "lumitip_tcp", *(f"lumitip_{f}" for f in _FINGERS)}
    wrong += sorted(bodies ^ set(model.links))
    wrong += [
        f"{name} mimics otherwise"
        for name, joint in model.joints.items()
        if joint.mimics != _FOLLOWS.get(name, _ALONE)
    ]
    wrong += ["robot's name"] if model.name != "lumitip" else []
    return wrong + (["settings for MuJoCo"] if model.settings != _SETTINGS else [])


def _unseen(model: Model, design: Design) -> Iterator[str]:
    """Layers of a finger that its link does not show under their own names."""
    for finger in design.fingers:
        link = model.links.get(f"lumitip_{finger.name}")
        names = [f"{finger.name}_{layer}" for layer in design.layers]
        yield from (f"no visual {name}" for name in names if link and name not in link.visuals)


def _unlike(model: Model, design: Design) -> Iterator[str]:
    """Visuals without a colour or of a wrong one. A material's name stands for one colour in the
    whole file, so that each has its own."""
    found: dict[str, Colour | None] = {}
    for finger in design.fingers:
        link = model.links[f"lumitip_{finger.name}"]
        for visual in link.visuals:
            name, colour = link.materials.get(visual, ("", None))
            found[visual.replace("_", ".", 1)] = colour
            if name != f"lumitip_{visual}":
                yield f"{visual} has the material {name or 'of no name'}"
    yield from wrong_colours(found, design)


def _places(model: Model, design: Design) -> Iterator[Measurement]:
    places = [model.to_base(f"lumitip_{f}") for f in _FINGERS]
    turned = np.diag([-1.0, 1.0, -1.0, 1.0])  # the fingers face: half a turn about the tips' axis
    facing = np.linalg.inv(places[0]) @ places[1]
    lean = design.mount.tilt_deg
    want = _about_x(-lean) @ turned @ _about_x(lean)
    off = np.abs(facing[:3, :3] - want[:3, :3]).max()
    yield _URDF.figure("facing", np.degrees(off), 0, 0.01, "°", "one finger's frame in the other's")
    tcp = model.to_base("lumitip_tcp")
    middle = (places[0][:3, 3] + places[1][:3, 3]) / 2
    off = np.abs(tcp[:3, 3] - middle).max()
    yield _URDF.figure("tcp", off, 0, PLACE_MM, note="from between the cells")
    off = np.degrees(np.abs(tcp[:3, :3] - np.eye(3)).max())
    yield _URDF.figure("tcp", off, 0, 0.01, "°", "turned against the base")
    held = design.held
    lowest = [_bounds(model, f, 0.0, held)[0][2] for f in _FINGERS]
    worst = max(lowest, key=abs)
    yield _URDF.figure(
        "seat", worst, -PLACE_MM, PLACE_MM, note=f"foot of the {held} to the mount plane"
    )
    for name, share in (("closed", 0.0), ("open", 1.0)):
        wanted = share * design.closing.max_opening_mm
        gap = _gap(model, share)
        yield _URDF.figure(name, gap, wanted - GAP_MM, wanted + GAP_MM, note="from skin to skin")

    aside = [np.abs(_slid_mm(model, finger)[1:]).max() for finger in _FINGERS]
    yield _URDF.figure(
        "slide", np.max(aside), 0, PLACE_MM, note="aside, on the way from closed to open"
    )
    yield from _limits(model, design)


def _limits(model: Model, design: Design) -> Iterator[Measurement]:
    """Where the joints begin and end, how strong and how fast they are."""
    wanted_n, way_mm = design.strength.closing_n, design.closing.max_opening_mm / 2
    joints = {name: joint for name, joint in model.joints.items() if joint.kind == "prismatic"}
    wrong = [
        name
        for name, joint in joints.items()
        if (joint.lower_mm, joint.effort_n) != (0.0, wanted_n)
        or not abs(joint.upper_mm - way_mm) < PLACE_MM
    ]
    yield _URDF.count("limits", wrong, "joints")
    speeds = [joint.speed_mm_s for joint in joints.values()]
    yield _URDF.near("limits", speeds, _SPEED_MM_S, 0.01, "greatest speed of a finger", "mm/s")


def _slid_mm(model: Model, finger: str) -> Vectors:
    """How far a finger moves from closed to open, in the base's frame."""
    link = f"lumitip_{finger}"
    ends = [model.to_base(link, way) for way in (0.0, model.joints[f"{link}_joint"].upper_mm)]
    return np.asarray(ends[1][:3, 3] - ends[0][:3, 3])


def _gap(model: Model, share: float) -> float:
    """Along the opening, from the receiver to the emitter."""
    receiver, emitter = (_bounds(model, f, share) for f in _FINGERS)
    return float(emitter[0][0] - receiver[1][0])


def _bounds(model: Model, finger: str, share: float, layer: str = "") -> Vectors:
    """Least and greatest corner of a finger, or one layer, in the base's frame, so far opened."""
    link = f"lumitip_{finger}"
    way = model.to_base(link, share * model.joints[f"{link}_joint"].upper_mm)
    visuals = model.links[link].visuals
    corners = [moved(mesh, way).bounds for name, mesh in visuals.items() if layer in name]
    return np.array([np.min(corners, axis=0)[0], np.max(corners, axis=0)[1]])


def _body(link: Link, finger: Finger, design: Design) -> Iterator[Measurement]:
    masses, centres, own = zip(*_pieces(link, finger, design), strict=True)
    mass, subject = sum(masses), f"{finger.name}"
    centre = np.average(centres, axis=0, weights=masses)
    yield _URDF.figure("mass", link.mass_g, mass * (1 - MASS), mass * (1 + MASS), "g", subject)
    off = float(np.abs(link.centre_mm - centre).max())
    yield _URDF.figure("centre", off, 0, CENTRE_MM, note=subject)
    away = np.array(centres) - centre
    wanted = sum(own) + sum(
        m * (np.dot(r, r) * np.eye(3) - np.outer(r, r)) for m, r in zip(masses, away, strict=True)
    )
    off = float(np.abs(link.inertia_g_mm2 - wanted).max() / np.abs(wanted).max())
    yield _URDF.figure("inertia", off, 0, INERTIA, "of the largest", subject)
    hulls = [mesh.convex_hull for mesh in link.collisions.values()]
    seen = np.concatenate([mesh.vertices for mesh in link.visuals.values()])
    outside = np.min([_outside(hull, seen) for hull in hulls], axis=0).max() if hulls else np.inf
    note = f"{subject}: farthest that anything stands out of what touches"
    yield _URDF.figure("reach", float(outside), -np.inf, REACH_MM, note=note)
    bulk = sum(h.volume for h in hulls) / sum(abs(m.volume) for m in link.visuals.values())
    yield _URDF.figure("bulk", bulk, 0, BULK, "times what is seen", subject)


def _pieces(link: Link, finger: Finger, design: Design) -> Iterator[tuple[float, Vectors, Vectors]]:
    """Mass (g), centre, and inertia about it (g mm2) of each layer, by its mesh, and each part."""
    densities = design.densities
    for kind in design.layers:
        mesh = link.visuals[f"{finger.name}_{kind}"]
        g_mm3 = getattr(densities, f"{kind}_g_ml") / 1000
        yield mesh.volume * g_mm3, mesh.center_mass, mesh.moment_inertia * g_mm3
    for part in finger.parts:
        front = part.side == "front"
        density = densities.part_g_ml - front * densities.silicone_g_ml
        size = np.array([part.size_x_mm, part.size_y_mm, part.height_mm])
        grams, stack = size.prod() * density / 1000, design.stack
        z_mm = (
            stack.rim_z_mm if front else stack.pocket_z_mm - part.height_mm
        ) + part.height_mm / 2
        inertia = grams / 12 * np.diag((size**2).sum() - size**2)
        yield grams, np.array([part.x_mm, part.y_mm, z_mm]), inertia


def _outside(hull: Any, points_mm: Vectors) -> Vectors:
    """How far each point stands out of a convex body; below zero inside."""
    normals, origins = hull.face_normals, hull.triangles[:, 0]
    return np.asarray((points_mm @ normals.T - np.einsum("ij,ij->i", normals, origins)).max(axis=1))


def _macros(outputs: Path) -> Measurement:
    """The macros as two users call them, against the links of the URDF with their names."""
    wrong: set[str] = set()
    try:
        model = read_urdf(outputs / _FILE)
        for prefix, meshes in _USES:
            found = Counter(read_macros(outputs / _MACROS, prefix, meshes))
            wanted = Counter(_wanted(model, prefix, meshes))
            wrong |= {name for name, _ in (found - wanted) + (wanted - found)}
    except OutputError as error:
        return unreadable("robot.macros", _MACROS, str(error))
    return count("robot.macros", _MACROS, sorted(wrong), "elements unlike the URDF's")


def _wanted(model: Model, prefix: str, meshes: str) -> Iterator[tuple[str, str]]:
    yield "robot", "lumitip"
    for finger in _FINGERS:
        link = f"{prefix}{finger}"
        yield f"macro lumitip_{finger}", _PARAMETERS
        yield f"{link}_mount", xml_text(ElementTree.fromstring(_MOUNT.format(link=link)))
        if f"lumitip_{finger}" in model.links:
            yield link, model.links[f"lumitip_{finger}"].renamed(prefix, meshes)


def _about_x(angle_deg: float) -> Vectors:
    angle = np.radians(angle_deg)
    matrix = trimesh.transformations.rotation_matrix(angle, (1, 0, 0))
    return np.asarray(matrix)
