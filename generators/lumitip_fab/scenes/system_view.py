"""The exploded drawing of the whole system along the tool's axis, with the heights that add up."""

from dataclasses import dataclass

import numpy as np

from lumitip_fab.design import Flange, Mount, System
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.drawing import Points, Sheet, View, silhouette, view, visible_lines
from lumitip_fab.scenes.glb import Group, tints

AZIMUTH_DEG = 35.0
ELEVATION_DEG = 24.0
GAP_MM = 26.0  # by which the bodies are pulled apart along the axis
ASIDE_MM = 115.0  # by which a holder is pulled off the gripper
WORDS_PER_MM, TITLE_SHARE = 4.2 / 360.0, 2 / 3
"""Scale of the words for each mm of the drawing's height, and of the title against them: the manual
sets the drawing as high as its page allows."""
PAGE_SHARE, BESIDE_MM = 1 / 115.0, 52.0
"""Least scale of the words for each mm of the drawing's width, with what is beside it and is no
word: so wide that the page's width is the limit."""
LABEL_MM, WORDS = 12.0, 46.5  # from the drawing; width of the longest words at scale 1
LAYERS = ("interface", "backing", "board", "silicone", "film")
Words = tuple[str, str]


@dataclass(frozen=True, eq=False)
class Drawn:
    """A body where it is drawn."""

    group: str
    name: str
    mesh: Mesh


def system_view(
    groups: list[Group], flanges: tuple[Flange, ...], mount: Mount, system: System, tcp_mm: float
) -> str:
    """The drawing as SVG.

    Args:
        groups: the bodies; of the fingers only the layers are drawn.
        flanges: for their names and heights.
        mount: for the gripper's name.
        system: for heights along the axis.
        tcp_mm: height of the tool centre point.
    """
    sheet, eye = Sheet(), view(AZIMUTH_DEG, ELEVATION_DEG)
    shifts = _shifts(groups, system)
    drawn = [
        Drawn(group.name, body.name, _pulled(body.mesh, group, shifts[group.name]))
        for group in groups
        for body in group.bodies
        if shown(group.name, body.name)
    ]
    meshes = [body.mesh for body in drawn]
    lines = visible_lines(meshes, eye)
    order = painted(drawn, eye)
    _axis(sheet, eye, drawn, shifts)
    for k in order:
        name = drawn[k].name
        with sheet.group(name):
            sheet.area(silhouette(meshes[k], eye), "body", tint(name))
    for k in order:
        sheet.lines(lines[k], "line")
    at = {body.name: eye.seen(body.mesh.points_mm) for body in drawn}
    with sheet.group("labels"):
        _label(sheet, at, flanges, mount, system, tcp_mm)
    return sheet.svg({"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": ELEVATION_DEG})


def shown(group: str, body: str) -> bool:
    """Whether a body is drawn: of a finger, its layers are."""
    return group not in ("emitter", "receiver") or body.rpartition(".")[2] in LAYERS


def tint(name: str) -> str:
    """Colour of a body by its name."""
    first, _, last = name.partition(".")
    return tints()[last] if last in tints() else tints()[first]


def painted(drawn: list[Drawn], eye: View) -> list[int]:
    """Numbers of the bodies from the farthest to the nearest: groups lie apart, and of the emitter
    one sees the back."""
    depths = {
        group: float(np.mean([eye.seen(_middle(b.mesh))[2] for b in drawn if b.group == group]))
        for group in dict.fromkeys(body.group for body in drawn)
    }

    def rank(k: int) -> tuple[float, int]:
        last = drawn[k].name.rpartition(".")[2]
        layer = LAYERS.index(last) if last in LAYERS else 0
        return depths[drawn[k].group], -layer if drawn[k].group == "emitter" else layer

    return sorted(range(len(drawn)), key=rank)


def _shifts(groups: list[Group], system: System) -> dict[str, Points]:
    """How far each group is pulled out: along the axis, but holders to the side of the gripper."""
    shifts: dict[str, Points] = {}
    steps = 0
    for group in groups:
        if group.name in system.holders:
            shifts[group.name] = np.array([0.0, -ASIDE_MM, steps * GAP_MM - GAP_MM])
        elif group.name == "receiver":
            shifts[group.name] = shifts["emitter"]
        else:
            shifts[group.name] = np.array([0.0, 0.0, steps * GAP_MM])
            steps += 1
    return shifts


def _pulled(mesh: Mesh, group: Group, shift: Points) -> Mesh:
    to_tool = group.to_scene
    points = mesh.points_mm @ to_tool[:3, :3].T + to_tool[:3, 3] + shift
    return Mesh(np.asarray(points), mesh.triangles)


def _middle(mesh: Mesh) -> Points:
    return np.asarray((mesh.points_mm.min(axis=0) + mesh.points_mm.max(axis=0)) / 2)


def _axis(sheet: Sheet, eye: View, drawn: list[Drawn], shifts: dict[str, Points]) -> None:
    """The tool's axis, and the way of what is pulled aside."""
    low = min(float(body.mesh.points_mm[:, 2].min()) for body in drawn)
    high = max(float(body.mesh.points_mm[:, 2].max()) for body in drawn)
    lines = [np.array([(0.0, 0.0, low), (0.0, 0.0, high + GAP_MM / 2)])]
    for body in drawn:
        aside, z = float(shifts[body.group][1]), float(_middle(body.mesh)[2])
        if aside:
            lines.append(np.array([(0.0, 0.0, z), (0.0, aside, z)]))
    sheet.lines([eye.seen(line)[:, :2] for line in lines], "axis")


def _label(
    sheet: Sheet,
    at: dict[str, Points],
    flanges: tuple[Flange, ...],
    mount: Mount,
    system: System,
    tcp_mm: float,
) -> None:
    """Names with heights at the right, the rest at the left, a title over them."""
    right: list[tuple[Words, Points]] = []
    left: list[tuple[Words, Points]] = []
    below = 0.0

    def climb(to_mm: float) -> str:
        nonlocal below
        step = f"+ {to_mm - below:.2f} = {to_mm:.2f} mm"
        below = to_mm
        return step

    for flange in flanges:
        right.append(
            (
                ("Robot's tool flange", f"ISO 9409-1-{flange.iso}, 0.00 mm"),
                _rightmost(at["robot.flange"]),
            )
        )
        right.append(
            (
                (f"Coupling {flange.coupling}", climb(system.coupling_mm)),
                _rightmost(at["coupling.body"]),
            )
        )
        right.append(
            (
                ("Flange, both parts", climb(system.gripper_z_mm)),
                _rightmost(at[f"{flange.name}.upper"]),
            )
        )
        left.append(
            (("Flange's board", "contacts, 5 V, cables"), _leftmost(at[f"{flange.name}.board"]))
        )
        left.append((("Flange, lower part", "printed"), _leftmost(at[f"{flange.name}.lower"])))
    mounted = climb(system.gripper_z_mm + system.reach_mm)
    right.append(
        (
            (f"Gripper {mount.title}", f"{mounted}, {system.confidence}"),
            _rightmost(at["gripper.envelope"]),
        )
    )
    for name in system.holders:
        left.append(
            (
                ("Controller's board", "its holder is on the gripper"),
                _leftmost(at[f"{name}.tray"]),
            )
        )
    right.append((("Tool centre point", climb(tcp_mm)), _rightmost(at["emitter.backing"])))
    left.append((("Receiver", "its face to the emitter's"), _leftmost(at["receiver.backing"])))
    wide, high = (sheet.high - sheet.low).tolist()
    sheet.words_scale = max(WORDS_PER_MM * high, PAGE_SHARE * (wide + BESIDE_MM))
    words_mm = WORDS * sheet.words_scale
    x_low, x_high = float(sheet.low[0]) - LABEL_MM, float(sheet.high[0]) + LABEL_MM
    top = float(sheet.high[1]) + LABEL_MM
    low = min(sheet.leaders(right, x_high, "start"), sheet.leaders(left, x_low, "end"))
    sheet.words_scale *= TITLE_SHARE
    start = "robot's tool flange" if flanges else "gripper"
    sheet.words(x_low - words_mm, top, f"From the {start} to the fingers", "title", "start")
    sheet.cover(x_low - words_mm, top + 5 * sheet.words_scale)
    sheet.cover(x_low - words_mm, low)
    sheet.cover(x_high + words_mm + LABEL_MM, top)


def _rightmost(seen: Points) -> Points:
    return np.asarray(seen[int(seen[:, 0].argmax()), :2])


def _leftmost(seen: Points) -> Points:
    return np.asarray(seen[int(seen[:, 0].argmin()), :2])
