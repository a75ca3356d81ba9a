"""Where a worn skin is cut and taken off: the board's edge, and the plugs of silicone."""

from collections.abc import Mapping, Sequence

import numpy as np
import shapely

from lumitip_fab.design import Board, Finger, Key, Point
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.dimensions import circle
from lumitip_fab.scenes.drawing import Sheet, View
from lumitip_fab.scenes.finger_views import paint

_FRONT = View(np.eye(3)).enlarged(1.5)
_IN_MM = 1.5  # from the side of the notch to where a label points at
_WORDS_MM = 50.0


def skin_view(finger: Finger, board: Board, keys: Sequence[Key], layers: Mapping[str, Mesh]) -> str:
    """The finger from the front, its tip up, without its mask.

    Args:
        finger: for its notch, where the wires lie in the silicone.
        board: whose edge is cut along.
        keys: holes of which silicone is pushed out.
        layers: interface, backing and silicone in the sensor frame, from the back.
    """
    sheet, box = Sheet(), board.box
    seen = {k: layers[k] for k in ("interface", "backing", "silicone") if k in layers}
    view = _FRONT.fitted(seen.values())
    scale = view.scale
    paint(sheet, view, seen)
    edge = shapely.box(*box.bounds_mm).exterior - shapely.box(*finger.notch.bounds_mm)
    with sheet.group("cut"):
        pieces = shapely.get_parts(shapely.line_merge(edge))
        sheet.lines([scale * shapely.get_coordinates(piece) for piece in pieces], "mark")
    with sheet.group("plugs"):
        sheet.lines(
            [circle(_page(key.at, scale), scale * key.hole_mm / 2) for key in keys], "hidden"
        )
    cut_at = np.array(_page((box.x_max_mm, box.centre_mm[1]), scale))
    notch = finger.notch
    wires = np.array(_page((notch.x_max_mm - _IN_MM, notch.centre_mm[1]), scale))
    labels = [
        (("Cut", "round the edge of the board"), cut_at),
        (("Wires", "in the silicone here: no cut"), wires),
    ]
    if keys:
        last = max(keys, key=lambda key: (key.at[0], key.at[1]))
        place = np.array(_page(last.at, scale))
        labels.append((("Plugs", "pushed out to the back"), place))
    sheet.leaders_beside(labels, _WORDS_MM)
    return sheet.svg({"data-scale": scale})


def _page(at: Point, scale: float) -> Point:
    return scale * at[0], scale * at[1]
