"""The parts of the flange, exploded along their axis, the coupling below: what goes where. In the
flange's frame."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from lumitip_fab.design import AuxiliaryBoard, Component, Flange, Point, Stack, System, frames
from lumitip_fab.design.cabling import front_headers
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.drawing import Points, Sheet, View, silhouette, view, visible_lines
from lumitip_fab.scenes.glb import tints
from lumitip_fab.scenes.system import block, disc, prism, ring, socket

AZIMUTH_DEG, ELEVATION_DEG = 24.0, 27.0
WORDS_SCALE = 1.4
_LABEL_MM, _WORDS_MM = 12.0, 76.0
_BOLT_MM, _HEAD = 16.0, (1.6, 1.0)
"""How much of a bolt is drawn, and its head: diameter and height by the hole of its shank."""
_NUT = (2.0, 0.8)
"""A nut: between its corners and its height by the hole of its screw."""
_CORNERS = 6
_BEYOND_MM = 3.0  # of the axes past the parts
_PULLED_MM = {
    "coupling": 0.0,
    "pin": 24.0,
    "lower": 54.0,
    "board": 89.0,
    "nut": 101.0,
    "upper": 124.0,
    "bolt": 138.0,
}
"""By which parts are pulled apart, from the robot to the gripper; the screws as far as the pin."""
_TINTS = {"part": "film", "pin": "coupling", "screw": "coupling", "nut": "coupling"}
_TINTS |= {"bolt": "coupling", "contacts": "film"}


@dataclass(frozen=True, eq=False)
class _Drawn:
    """A part where it is drawn."""

    kind: str
    mesh: Mesh
    level: str


def flange_view(
    flange: Flange,
    printed: Mapping[str, Mesh],
    auxiliary: AuxiliaryBoard,
    stack: Stack,
    system: System,
    plugged: Mapping[str, str],
) -> str:
    """The drawing as SVG.

    Args:
        flange: for its heights, and for holes, pins and screws.
        printed: `"lower"` and `"upper"` part, each in the frame of its bed.
        auxiliary: the board between them.
        stack: for the thickness of the board.
        system: for the height of the coupling.
        plugged: name of the cable at each of the board's headers that one is plugged into.
    """
    sheet, eye = Sheet(words_scale=WORDS_SCALE), view(AZIMUTH_DEG, ELEVATION_DEG)
    found = [
        *_coupled(flange, system),
        *_from_below(flange, stack),
        *_printed(flange, printed, "lower"),
        *_board(flange, auxiliary, stack, eye),
        *_nuts(flange, stack),
        *_printed(flange, printed, "upper"),
        *_bolts(flange, eye),
    ]
    drawn = [_Drawn(d.kind, d.mesh.moved(_pulled(d.level)), d.level) for d in found]
    _axes(sheet, eye, flange, drawn)
    lines = visible_lines([each.mesh for each in drawn], eye)
    for each, seen in zip(drawn, lines, strict=True):
        with sheet.group(each.kind):
            tint = tints()[_TINTS.get(each.kind, each.kind)]
            sheet.area(silhouette(each.mesh, eye), "body", tint)
            sheet.lines(seen, "line")
    _label(sheet, eye, flange, drawn, auxiliary, stack, plugged)
    return sheet.svg({"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": ELEVATION_DEG})


def _pulled(level: str) -> frames.Matrix:
    return frames.translation(0.0, 0.0, _PULLED_MM[level])


def _coupled(flange: Flange, system: System) -> Iterator[_Drawn]:
    """The coupling, its face at z = 0."""
    height_mm = system.coupling_mm
    body = socket(flange.face_mm, flange.centring_mm, height_mm, -flange.seat_z_mm)
    yield _Drawn("coupling", body.moved(frames.translation(0.0, 0.0, -height_mm)), "coupling")


def _from_below(flange: Flange, stack: Stack) -> Iterator[_Drawn]:
    """The locating pin, and the screws of the board, head down."""
    top = flange.seat_z_mm + flange.pin_depth_mm
    pin = disc(flange.pin_mm, top - flange.pin_length_mm, top)
    yield _Drawn("pin", _at(pin, flange.pin_at), "pin")
    head_mm = (flange.screw_head_mm - flange.screw_mm) / 2
    end = flange.board_z_mm + stack.auxiliary_mm + _NUT[1] * flange.screw_mm
    for at in flange.screws:
        seat = flange.seat_z_mm
        yield _Drawn("screw", _at(disc(flange.screw_head_mm, seat, seat + head_mm), at), "pin")
        yield _Drawn("screw", _at(disc(flange.screw_mm, seat + head_mm, end), at), "pin")


def _printed(flange: Flange, printed: Mapping[str, Mesh], part: str) -> Iterator[_Drawn]:
    yield _Drawn(part, printed[part].moved(frames.flange_beds(flange)[part]), part)


def _board(flange: Flange, auxiliary: AuxiliaryBoard, stack: Stack, eye: View) -> Iterator[_Drawn]:
    """Parts on its back, the board, and parts on its front, the farthest first."""
    placed = frames.auxiliary_to_flange(flange)
    parts = [part for part in auxiliary.components if part.footprint.height_mm > 0]
    parts.sort(key=lambda part: float(eye.seen(np.array([part.x_mm, part.y_mm, 0.0]))[2]))
    for part in parts:
        if part.side == "back":
            body = _body(part, -part.footprint.height_mm, 0.0)
            yield _Drawn("contacts", body.moved(placed), "board")
    box, thick_mm = auxiliary.box, stack.auxiliary_mm
    across, along = (box.x_min_mm, box.x_max_mm), (box.y_min_mm, box.y_max_mm)
    board = block(across, along, auxiliary.corner_mm, 0.0, thick_mm)
    yield _Drawn("board", board.moved(placed), "board")
    for part in parts:
        if part.side == "front":
            body = _body(part, thick_mm, thick_mm + part.footprint.height_mm)
            yield _Drawn("part", body.moved(placed), "board")


def _body(part: Component, low_mm: float, high_mm: float) -> Mesh:
    box = part.body_on_board
    across, along = (box.x_min_mm, box.x_max_mm), (box.y_min_mm, box.y_max_mm)
    return block(across, along, 0.0, low_mm, high_mm)


def _nuts(flange: Flange, stack: Stack) -> Iterator[_Drawn]:
    """Of the board's screws, on its front."""
    front = flange.board_z_mm + stack.auxiliary_mm
    wide, high = (share * flange.screw_mm for share in _NUT)
    for at in flange.screws:
        nut = prism(ring(wide / 2, _CORNERS), front, front + high)
        yield _Drawn("nut", _at(nut, at), "nut")


def _bolts(flange: Flange, eye: View) -> Iterator[_Drawn]:
    """The flange bolts, from above, the farthest first."""
    low = flange.top_z_mm
    shank = disc(flange.bolt_hole_mm, low, low + _BOLT_MM)
    wide, high = (share * flange.bolt_hole_mm for share in _HEAD)
    head = disc(wide, low + _BOLT_MM, low + _BOLT_MM + high)
    for at in sorted(flange.bolts, key=lambda at: float(eye.seen(np.array([*at, 0.0]))[2])):
        yield _Drawn("bolt", _at(shank, at), "bolt")
        yield _Drawn("bolt", _at(head, at), "bolt")


def _at(mesh: Mesh, at: Point) -> Mesh:
    return mesh.moved(frames.translation(at[0], at[1], 0.0))


def _axes(sheet: Sheet, eye: View, flange: Flange, drawn: list[_Drawn]) -> None:
    """The way of each bolt, screw and pin, and of the peg into the upper part."""
    ends = {
        level: [d.mesh.points_mm[:, 2] for d in drawn if d.level == level] for level in _PULLED_MM
    }
    low = {level: min(float(z.min()) for z in found) for level, found in ends.items()}
    high = {level: max(float(z.max()) for z in found) for level, found in ends.items()}
    ways = [(at, low["coupling"], high["bolt"]) for at in flange.bolts]
    ways += [(at, low["pin"], high["nut"]) for at in flange.screws]
    ways += [(flange.pin_at, low["coupling"], high["lower"])]
    ways += [(flange.peg_at, high["lower"], high["upper"])]
    for at, below, above in ways:
        way = np.array([(*at, below - _BEYOND_MM), (*at, above + _BEYOND_MM)])
        sheet.lines([eye.seen(way)[:, :2]], "axis")


def _label(
    sheet: Sheet,
    eye: View,
    flange: Flange,
    drawn: list[_Drawn],
    auxiliary: AuxiliaryBoard,
    stack: Stack,
    plugged: Mapping[str, str],
) -> None:
    """Printed parts and board at the left, what holds them at the right."""

    def seen(kind: str, side: int) -> Points:
        points = np.concatenate([d.mesh.points_mm for d in drawn if d.kind == kind])
        flat = eye.seen(points)
        return np.asarray(flat[int((side * flat[:, 0]).argmax()), :2])

    peg = np.array([*flange.peg_at, flange.split_z_mm + flange.peg_height_mm])
    lifted = eye.seen(peg + _pulled("lower")[:3, 3])[:2]
    bolts = f"{len(flange.bolts)} x {flange.bolt}, through gripper and flange"
    screws = f"{len(flange.screws)} x {flange.screw}, countersunk, from below"
    pin = f"{flange.pin_mm:g} x {flange.pin_length_mm:g}, glued into the lower part"
    right = [
        (("Flange bolts", bolts), seen("bolt", 1)),
        (("Nuts", f"{len(flange.screws)} x {flange.screw}, on the board"), seen("nut", 1)),
        (("Board", "its spring contacts down"), seen("board", 1)),
        (("Screws", screws), seen("screw", 1)),
        (("Locating pin", pin), seen("pin", 1)),
    ]
    left = [
        (("Upper part", "printed"), seen("upper", -1)),
        (("Peg", "goes into the upper part"), lifted),
        (("Lower part", "printed, in the coupling's recess"), seen("lower", -1)),
        (("Coupling", "on the robot; has a hole for the pin"), seen("coupling", -1)),
    ]
    to_page = _pulled("board") @ frames.auxiliary_to_flange(flange)
    for part in front_headers(auxiliary):
        top_mm = stack.auxiliary_mm + part.footprint.height_mm
        at = to_page @ np.array([part.x_mm, part.y_mm, top_mm, 1.0])
        detail = f"for the socket of {plugged[part.ref]}" if part.ref in plugged else "header"
        left.append(((part.ref, detail), eye.seen(at[:3])[:2]))
    low, high = float(sheet.low[0]) - _LABEL_MM, float(sheet.high[0]) + _LABEL_MM
    top = float(sheet.high[1])
    sheet.leaders(right, high, "start")
    sheet.leaders(left, low, "end")
    sheet.cover(low - _WORDS_MM, top)
    sheet.cover(high + _WORDS_MM, top)
