"""Drawings of what is tried on the bench before a finger is cast: both boards face to face, and a
drop of silicone on the plate."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from lumitip_fab.design import Point, Stack, frames
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.casting_page import inks
from lumitip_fab.scenes.drawing import Points, Sheet, View, view
from lumitip_fab.scenes.finger_views import (
    AZIMUTH_DEG,
    ELEVATION_DEG,
    SCALE,
    paint,
    paint_parts,
    smooth,
)
from lumitip_fab.scenes.glb import tints

FACING_DEG = 14.0  # elevation, to look between the boards
APART_MM = 26.0  # of the boards, as they are drawn
DROP_MM = 3.2  # across, as it is drawn
_FACE_DOWN = frames.rotation_y(180.0)
_WORDS_MM = 44.0
_AROUND = 48
_WIRE_MM, _SAG_MM = 24.0, 3.0
"""How far wires are drawn beyond the board, and how far they hang down there."""


@dataclass(frozen=True, eq=False)
class WiredBoard:
    """A board of a finger with its wires, in the sensor frame."""

    board: Mesh
    parts: Sequence[Mesh]
    """On its front."""
    pads: Sequence[Point]
    """Of the wires."""
    colours: Sequence[str]
    """Of the wires, pad by pad, by the codes of IEC 60757."""

    def moved(self, frame: frames.Matrix) -> "WiredBoard":
        """Board and parts in another frame; the pads stay in the sensor frame."""
        parts = [part.moved(frame) for part in self.parts]
        return WiredBoard(self.board.moved(frame), parts, self.pads, self.colours)


def facing_view(emitter: WiredBoard, receiver: WiredBoard) -> str:
    """The emitter's board face down over the receiver's, whose face is up."""
    sheet, eye = Sheet(), view(AZIMUTH_DEG, FACING_DEG).enlarged(SCALE)
    over = frames.translation(0.0, 0.0, APART_MM) @ _FACE_DOWN
    _wire(sheet, eye, receiver, np.eye(4))
    paint(sheet, eye, {"board": receiver.board})
    paint_parts(sheet, eye, receiver.parts)
    hung = emitter.moved(over)
    paint_parts(sheet, eye, hung.parts)
    paint(sheet, eye, {"board": hung.board})
    _wire(sheet, eye, emitter, over)
    labels = [
        (("Receiver", "face up"), _right(eye, receiver.board)),
        (("Emitter", "face down, some 10 mm over it"), _right(eye, hung.board)),
    ]
    sheet.leaders_beside(labels, _WORDS_MM)
    return sheet.svg({"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": FACING_DEG})


def _right(eye: View, mesh: Mesh) -> Points:
    """The corner of a body that is farthest to the right on the page."""
    seen = eye.seen(mesh.points_mm)
    return seen[seen[:, 0].argmax(), :2]


def _wire(sheet: Sheet, eye: View, wired: WiredBoard, frame: frames.Matrix) -> None:
    """Wires from the back of the board, beyond its gripper end; they hang down."""
    low = wired.board.points_mm.min(axis=0)
    for (x, y), colour in zip(wired.pads, wired.colours, strict=True):
        way = [(x, y, low[2]), (x, low[1], low[2] - 1.0), (x, low[1] - _WIRE_MM, low[2] - 1.0)]
        placed = np.array(way) @ frame[:3, :3].T + frame[:3, 3]
        placed[-1, 2] -= _SAG_MM
        sheet.wire(eye.seen(smooth(list(placed)))[:, :2], inks(colour))


def drop_view(layers: Mapping[str, Mesh], at: Point, stack: Stack) -> str:
    """A drop of silicone on the plate, with the board in its place.

    Args:
        layers: interface, backing and board in the sensor frame.
        at: where the drop is.
        stack: for the front of the plate.
    """
    sheet, eye = Sheet(), view(AZIMUTH_DEG, ELEVATION_DEG).enlarged(SCALE)
    words = "across plate, glue and board" if stack.sunk else "on the plate, beside the board"
    paint(sheet, eye, {k: layers[k] for k in ("interface", "backing", "board") if k in layers})
    turn = np.linspace(0.0, 2 * np.pi, _AROUND, endpoint=False)
    ring = DROP_MM / 2 * np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
    seen = eye.seen(ring + np.array([*at, stack.face_z_mm]))[:, :2]
    sheet.area([seen], "body", tints()["silicone"])
    sheet.leaders_beside([(("Drop", words), seen.mean(axis=0))], _WORDS_MM)
    return sheet.svg({"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": ELEVATION_DEG})
