"""The holder where it is on the gripper, between the robot and the fingers, with its height."""

import manifold3d
import numpy as np

from lumitip_fab.design import Holder, Mount, System
from lumitip_fab.design.frames import holder_edge_mm, translation
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.dimensions import dimension_rows
from lumitip_fab.scenes.drawing import Points, Sheet, View, silhouette, view, visible_lines
from lumitip_fab.scenes.glb import Group
from lumitip_fab.scenes.system_view import Drawn, painted, shown, tint

AZIMUTH_DEG, ELEVATION_DEG = 50.0, 20.0
_FINGERS = ("emitter", "receiver")
_BARE_MM = 35.0
_BESIDE_MM, _WORDS_MM, _FIGURE_MM, _WORDS = 10.0, 118.0, 46.0, 2.75


def mounted_view(groups: list[Group], holder: Holder, mount: Mount, system: System) -> str:
    """Everything in its place.

    Args:
        groups: the bodies from the robot to the fingers.
        holder: which of them is the holder, and its length.
        mount: for the gripper's name.
        system: for the planes along the tool's axis.
    """
    eye = view(AZIMUTH_DEG, ELEVATION_DEG)
    bodies = _ordered(groups, holder, eye, _nearer_mm(system))
    meshes = [body.mesh for body in bodies]
    sheet = Sheet(words_scale=_WORDS)
    top_mm = system.gripper_z_mm + system.length_mm
    sheet.lines([_on_axis(eye, top_mm, top_mm + _bare_mm(system) - _nearer_mm(system))], "axis")
    for body, lines in zip(bodies, visible_lines(meshes, eye), strict=True):
        with sheet.group(body.name):
            sheet.area(silhouette(body.mesh, eye), "body", tint(body.name))
            sheet.lines(lines, "line")
    envelope = next(body.mesh for body in bodies if body.name == "gripper.envelope")
    _measure(sheet, eye, system, holder, eye.seen(envelope.points_mm))
    at = {body.name: _left_corner(eye.seen(body.mesh.points_mm)) for body in bodies}
    named = {
        "receiver.backing": ("Fingers", "receiver and emitter"),
        "gripper.envelope": (mount.title, "as the design has it"),
        f"{holder.name}.board": ("Holder", "board beside the stroke"),
        "flange.upper": ("Flange", "printed"),
        "coupling.body": ("Coupling", "on the robot"),
    }
    labels = [(words, at[name]) for name, words in named.items() if name in at]
    edge = float(sheet.low[0]) - _BESIDE_MM
    low = sheet.leaders(labels, edge, "end")
    sheet.cover(edge - _WORDS_MM, low)
    return sheet.svg({"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": ELEVATION_DEG})


def _bare_mm(system: System) -> float:
    """From the gripper's body to the fingers, where its own jaws are, which nobody drew."""
    return system.reach_mm - system.length_mm


def _nearer_mm(system: System) -> float:
    """So much nearer the fingers are drawn: long jaws would leave the page empty there."""
    return max(0.0, _bare_mm(system) - _BARE_MM)


def _ordered(groups: list[Group], holder: Holder, eye: View, nearer_mm: float) -> list[Drawn]:
    """Bodies in the tool frame, from the farthest to the nearest: the stack from the robot up with
    the holder's arms behind the gripper before it, the fingers, the holder's tray and board."""
    stack: list[Drawn] = []
    fingers: list[Drawn] = []
    nearest: list[Drawn] = []
    behind: Drawn | None = None
    for group in groups:
        drawn = [
            Drawn(group.name, body.name, body.mesh.moved(group.to_scene))
            for body in group.bodies
            if shown(group.name, body.name)
        ]
        if group.name in _FINGERS:
            by_mm = translation(0.0, 0.0, -nearer_mm)
            fingers += [Drawn(d.group, d.name, d.mesh.moved(by_mm)) for d in drawn]
        elif group.name == holder.name:
            far, near = _halves(drawn[0].mesh, eye)
            behind = Drawn(group.name, f"{holder.name}.far", far)
            nearest = [Drawn(group.name, f"{holder.name}.near", near), *drawn[1:]]
        else:
            stack += drawn
    *below, gripper = stack
    arms = [behind] if behind else []
    seen = [fingers[k] for k in painted(fingers, eye)]
    return [*below, *arms, gripper, *seen, *nearest]


def _halves(printed: Mesh, eye: View) -> tuple[Mesh, Mesh]:
    """A holder round the tool's axis, cut there: what is behind it, and what is before it."""
    solid = manifold3d.Manifold(
        manifold3d.Mesh64(printed.points_mm, printed.triangles.astype(np.uint64))
    )
    x, y, _ = eye.axes[2].tolist()
    before, behind = solid.split_by_plane((x, y, 0.0), 0.0)
    return _mesh(behind), _mesh(before)


def _mesh(solid: manifold3d.Manifold) -> Mesh:
    found = solid.to_mesh64()
    points = np.asarray(found.vert_properties[:, :3], np.float64)
    return Mesh(points, np.asarray(found.tri_verts, np.int64))


def _measure(sheet: Sheet, eye: View, system: System, holder: Holder, body: Points) -> None:
    """From the plane that the gripper stands on to the holder's nearer edge, beside its body."""
    edge_mm = holder_edge_mm(holder, system)
    stands, edge = _on_axis(eye, system.gripper_z_mm, system.gripper_z_mm + edge_mm)[:, 1].tolist()
    side, right = float(body[:, 0].max()), float(sheet.high[0]) + _BESIDE_MM
    sheet.lines([np.array([(side, y), (right, y)]) for y in (stands, edge)], "leader")
    dimension_rows(sheet, [("", (side, stands), (side, edge))], right, 1, upright=True)
    middle = np.array([right, (stands + edge) / 2])
    sheet.leaders_beside([((f"{edge_mm:.0f} mm", "to its edge"), middle)], _FIGURE_MM)


def _on_axis(eye: View, low_mm: float, high_mm: float) -> Points:
    """Two places of the tool's axis on the page."""
    return eye.seen(np.array([(0.0, 0.0, low_mm), (0.0, 0.0, high_mm)]))[:, :2]


def _left_corner(seen: Points) -> Points:
    """The highest of a body's points that are farthest to the left."""
    leftmost = seen[seen[:, 0] < seen[:, 0].min() + 0.1]
    return np.asarray(leftmost[int(leftmost[:, 1].argmax()), :2])
