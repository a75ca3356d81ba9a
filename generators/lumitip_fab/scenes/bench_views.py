"""Drawings of what is tried on the bench before a finger is cast: both boards face to face, and a
drop of silicone on the plate."""

from collections.abc import Mapping, Sequence

import numpy as np

from lumitip_fab.design import Point, Stack, frames
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.drawing import Points, Sheet, view
from lumitip_fab.scenes.finger_views import AZIMUTH_DEG, ELEVATION_DEG, SCALE, paint, paint_parts
from lumitip_fab.scenes.glb import tints

FACING_DEG = 14.0  # elevation, to look between the boards
APART_MM = 26.0  # of the boards, as they are drawn
DROP_MM = 3.2  # across, as it is drawn
_FACE_DOWN = frames.rotation_y(180.0)
_LABEL_MM, _WORDS_MM = 8.0, 44.0
_AROUND = 48
BoardMeshes = tuple[Mesh, Sequence[Mesh]]
"""A board, and the parts on its front; in the sensor frame of its finger."""


def facing_view(emitter: BoardMeshes, receiver: BoardMeshes) -> str:
    """The emitter's board face down over the receiver's, whose face is up."""
    sheet, eye = Sheet(), view(AZIMUTH_DEG, FACING_DEG).enlarged(SCALE)
    over = frames.translation(0.0, 0.0, APART_MM) @ _FACE_DOWN
    labels = []
    for words, (board, parts), frame in (
        (("Receiver", "face up"), receiver, np.eye(4)),
        (("Emitter", "face down, some 10 mm over it"), emitter, over),
    ):
        lying, hung = board.moved(frame), frame is over
        if hung:
            paint_parts(sheet, eye, [part.moved(frame) for part in parts])
        paint(sheet, eye, {"board": lying})
        if not hung:
            paint_parts(sheet, eye, list(parts))
        right = lying.points_mm[eye.seen(lying.points_mm)[:, 0].argmax()]
        labels.append((words, eye.seen(right)[:2]))
    _written(sheet, labels)
    return sheet.svg({"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": FACING_DEG})


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
    _written(sheet, [(("Drop", words), seen.mean(axis=0))])
    return sheet.svg({"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": ELEVATION_DEG})


def _written(sheet: Sheet, labels: list[tuple[tuple[str, str], Points]]) -> None:
    """Labels on the right."""
    right = float(sheet.high[0]) + _LABEL_MM
    sheet.leaders(labels, right, "start")
    sheet.cover(right + _WORDS_MM, float(labels[0][1][1]))
