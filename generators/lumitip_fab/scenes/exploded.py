"""The exploded drawing of a finger: an SVG of visible lines, in mm on the page.

The layers lie above each other along z, so the drawing is painted from the back to the front:
each layer is an opaque silhouette with the lines that it does not hide itself. The parts on the
board are boxes, painted one by one, for the kernel hides a hundred of them only slowly.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from build123d import Compound, Edge, GeomType, Solid
from OCP.BRepLib import BRepLib
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.HLRAlgo import HLRAlgo_Projector
from OCP.HLRBRep import HLRBRep_Algo, HLRBRep_HLRToShape

from lumitip_fab.design import Finger, Outline, Part, Stack
from lumitip_fab.parts import export
from lumitip_fab.scenes.bodies import Bodies, layers_of
from lumitip_fab.scenes.drawing import Points, Sheet, View, silhouette, view
from lumitip_fab.scenes.glb import tints

AZIMUTH_DEG = 32.0  # of the viewer, from the gripper end towards +x
ELEVATION_DEG = 32.0
SPREAD = 0.9  # of a layer's height on the page, from layer to layer
LABEL_MM = 10.0  # from the drawing to its labels
WORDS_MM = 38.0  # width of the longest label
TITLE_MM = 8.0  # from the title's foot to the page's edge
_PAGE_MM = 160.0  # height up to which a page has words of usual size: the manual sets it smaller
_CHORD_MM = 0.05
_STEPS = 24  # chords of a curve on the page
_FACES = ((0, 1, 5, 4), (1, 3, 7, 5), (4, 5, 7, 6))  # of a box, towards the viewer


@dataclass(frozen=True)
class Layer:
    """A layer with its place on the page and what is said of it."""

    name: str
    solid: Solid
    rise_mm: float
    """How far it is moved up the page."""
    words: tuple[str, str]
    point: Points
    """Where its label points at, on the page."""


def exploded_view(bodies: Bodies, stack: Stack, outline: Outline) -> str:
    """The drawing as SVG.

    Args:
        bodies: the finger.
        stack: for the layers' heights and names.
        outline: for the lines along which the layers are pulled apart.
    """
    sheet, finger = Sheet(), bodies.finger
    layers = _layers(bodies, stack, outline)
    corners = _projected(_at(outline.polygon(16), stack.rim_z_mm))
    guides = [int(corners[:, 0].argmin()), int(corners[:, 0].argmax())]
    pins = _projected(_at(np.array(finger.holes), stack.rim_z_mm))
    for layer, above in zip(layers, (*layers[1:], None), strict=True):
        with sheet.group(layer.name):
            sheet.area(_silhouette(layer), "area", tints()[layer.name])
            sheet.lines(_visible_lines(layer), "line")
        if layer.name == "board":
            _draw_parts(sheet, finger, stack, layer.rise_mm)
        if above:
            starts = [corners[k] for k in guides] + (list(pins) if above.name == "board" else [])
            if layer.name == "interface":
                starts = list(_projected(_pad_corners(layer.solid)))
            sheet.lines([_upright(at, layer.rise_mm, above.rise_mm) for at in starts], "axis")
    with sheet.group("labels"):
        _label(sheet, layers, finger, stack)
    return sheet.svg({"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": ELEVATION_DEG})


def _layers(bodies: Bodies, stack: Stack, outline: Outline) -> list[Layer]:
    flat = outline.polygon(16)
    page = _projected(_at(flat, 0.0))
    height = float(np.ptp(page[:, 1]))
    edge = flat[int(page[:, 0].argmax())] - (2.5, 0.0)
    corner = bodies.board.bounding_box().max
    sunk = stack.sunk
    words_of = {
        "interface": ("Interface", "printed, glued to the backing"),
        "backing": (
            f"Backing, {stack.plate_mm:g} mm",
            "printed, with its block" if sunk else "printed, bends",
        ),
        "board": (
            f"Board, {stack.pcb_mm:g} mm",
            "glued in, flush with the rim" if sunk else "flexible, tied on",
        ),
        "silicone": (f"Silicone, {stack.silicone_mm:g} mm", "cast on the board"),
        "film": (f"Mask, {stack.film_mm:g} mm", "black but above each cell"),
    }
    layers = []
    for step, (name, solid) in enumerate(layers_of(bodies)):
        words = words_of[name]
        rise = SPREAD * height * step
        place = (corner.X - 1.5, corner.Y - 1.5) if name == "board" else edge
        at = [*place, stack.rim_z_mm]
        if name == "interface":
            at = _pad_corners(solid)[1] - (0.7, 0.7, 0.0)
        point = _projected(np.array(at), rise)
        layers.append(Layer(name, solid, rise, words, point))
    return layers


def _pad_corners(interface: Solid) -> Points:
    """Corners of the interface's front that are farthest from the gripper."""
    far = interface.bounding_box().max
    return np.array([(-far.X, far.Y, far.Z), (far.X, far.Y, far.Z)])


def _eye() -> View:
    return view(AZIMUTH_DEG, ELEVATION_DEG)


def _projected(points: Points, rise_mm: float = 0.0) -> Points:
    """Points of the finger, shape `(..., 3)`, on the page."""
    return np.asarray(_eye().seen(points)[..., :2] + (0.0, rise_mm))


def _at(points: Points, z_mm: float) -> Points:
    return np.column_stack([points, np.full(len(points), z_mm)])


def _upright(at: Points, from_mm: float, to_mm: float) -> Points:
    return np.asarray(at + np.array([[0.0, from_mm], [0.0, to_mm]]))


def _silhouette(layer: Layer) -> list[Points]:
    """The layer's outer and inner contours on the page."""
    rings = silhouette(export.mesh(layer.solid, _CHORD_MM), _eye())
    return [np.add(ring, (0.0, layer.rise_mm)) for ring in rings]


def _visible_lines(layer: Layer) -> list[Points]:
    """Sharp edges and contours that the layer does not hide itself."""
    right, _, viewer = _eye().axes
    towards = gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(*viewer), gp_Dir(*right))
    hidden = HLRBRep_Algo()
    hidden.Add(layer.solid.wrapped)
    hidden.Projector(HLRAlgo_Projector(towards))
    hidden.Update()
    hidden.Hide()
    seen = HLRBRep_HLRToShape(hidden)
    lines = []
    for found in (seen.VCompound(), seen.OutLineVCompound()):
        if found is not None and not found.IsNull():
            BRepLib.BuildCurves3d_s(found)
            lines += [_chords(edge, layer.rise_mm) for edge in Compound(found).edges()]
    return lines


def _chords(edge: Edge, rise_mm: float) -> Points:
    steps = 1 if edge.geom_type == GeomType.LINE else _STEPS
    points = [edge.position_at(k / steps) for k in range(steps + 1)]
    return np.array([(p.X, p.Y + rise_mm) for p in points])


def _draw_parts(sheet: Sheet, finger: Finger, stack: Stack, rise_mm: float) -> None:
    """The parts on the board's front, the farthest first."""
    viewer = _eye().axes[2]
    front = [part for part in finger.parts if part.side == "front"]
    front.sort(key=lambda part: float(viewer[0] * part.x_mm + viewer[1] * part.y_mm))
    for part in front:
        corners = _projected(_box_corners(part, stack.rim_z_mm), rise_mm)
        with sheet.group(part.name):
            for face in _FACES:
                sheet.area([corners[list(face)]], "part", tints("part_tints")[part.kind])


def _box_corners(part: Part, low_mm: float) -> Points:
    box = part.box
    return np.array(
        [
            (x, y, z)
            for z in (low_mm, low_mm + part.height_mm)
            for y in (box.y_min_mm, box.y_max_mm)
            for x in (box.x_min_mm, box.x_max_mm)
        ]
    )


def _label(sheet: Sheet, layers: list[Layer], finger: Finger, stack: Stack) -> None:
    """Title, the layers' names at the right, and what else is to be seen at the left."""
    left, right = float(sheet.low[0]) - LABEL_MM, float(sheet.high[0]) + LABEL_MM
    low, top = float(sheet.low[1]), float(sheet.high[1]) + 2 * LABEL_MM
    sheet.words_scale = max(1.0, (top - low + 2 * sheet.margin_mm) / _PAGE_MM)
    words_mm = WORDS_MM * sheet.words_scale
    names = [(layer.words, layer.point) for layer in layers]
    details = []
    for words, place, name in _details(finger, stack):
        rise = next(layer.rise_mm for layer in layers if layer.name == name)
        details.append((words, _projected(np.array(place), rise)))
    sheet.leaders(names, right, "start")
    sheet.leaders(details, left, "end")
    sheet.words(
        left - words_mm, top, f"{finger.name.capitalize()} finger, exploded", "title", "start"
    )
    sheet.cover(left - words_mm, top + TITLE_MM * sheet.words_scale - sheet.margin_mm)
    sheet.cover(right + words_mm, top)


def _details(finger: Finger, stack: Stack) -> list[tuple[tuple[str, str], Any, str]]:
    """Labels on the left: words, place in the finger, layer."""
    half = stack.rim_z_mm
    labels: list[tuple[tuple[str, str], Any, str]] = []
    for kind, plural in (
        ("photodetector", "photodetectors"),
        ("led", "LEDs"),
        ("multiplexer", "multiplexers"),
        ("current source", "current sources"),
        ("resistor", "resistors"),
        ("switch", "transistors"),
        ("capacitor", "bulk capacitors"),
    ):
        alike = [part for part in finger.parts if part.kind == kind and part.side == "front"]
        if alike:
            at = min(alike, key=lambda part: part.x_mm)
            names = f"{alike[0].name} … {alike[-1].name}"
            counted = f"{len(alike)} {plural}"
            if len(alike) == 1:
                names, counted = at.name, f"1 {plural.removesuffix('s')}"
            labels.append(
                (
                    (counted, names),
                    (at.x_mm, at.y_mm, half + at.height_mm),
                    "board",
                )
            )
    pad = finger.connector.pads[0]
    ways = len(finger.connector.pads)
    labels.append(((f"{ways} wires", "put in from the back"), (*pad, half), "board"))
    hole = min(finger.holes)
    words = ("Pins", "hold the board") if stack.sunk else ("Holes", "for thread")
    labels.append((words, (*hole, stack.face_z_mm), "backing"))
    notch = (finger.notch.x_min_mm + 2, finger.notch.y_min_mm + 4, stack.pocket_z_mm)
    labels.append((("Wire notch", "opens to the gripper"), notch, "backing"))
    return labels
