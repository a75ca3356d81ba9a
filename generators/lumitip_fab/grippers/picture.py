"""The picture of a fingertip that was read: its views with everything found marked."""

import numpy as np

from lumitip_fab.design import Point
from lumitip_fab.grippers.proposal import Proposal, upright
from lumitip_fab.parts.export import mesh
from lumitip_fab.scenes.coupling_view import FROM_GRIPPER, FROM_SIDE, draw_body
from lumitip_fab.scenes.dimensions import circle, line, pointers
from lumitip_fab.scenes.drawing import Sheet

LARGE_MM = 85.0  # of the larger view on the page
_BEYOND_MM = 6.0
_CHORD_MM = 0.03
_NAMES_MM = 66.0  # width of the names between the views


def found_drawing(proposal: Proposal) -> str:
    """The fingertip seen from the gripper and from its side, as SVG."""
    body = mesh(proposal.shape, _CHORD_MM)
    low, high = body.points_mm.min(axis=0), body.points_mm.max(axis=0)
    scale, sheet = LARGE_MM / float((high - low).max()), Sheet()
    edge, top = scale * float(high[0]), -scale * float(low[1])
    draw_body(sheet, body, FROM_GRIPPER, scale)
    named: dict[str, list[tuple[int, Point]]] = {}
    for number, hole in enumerate(proposal.holes):
        if not upright(hole):
            continue  # it is seen from its side
        u, w = scale * hole.foot[:2]
        sheet.lines([circle((u, -w), scale * p.diameter_mm / 2) for p in hole.pieces], "mark")
        rim = scale * hole.wide_mm / 2 * np.sqrt(0.5)
        named.setdefault(proposal.words(number), []).append((number + 1, (u + rim, rim - w)))
    names = []
    for words, alike in named.items():
        numbers = ", ".join(str(number) for number, _ in alike)
        sizes = words.rpartition(", ")[0]
        names.append((f"{numbers}: {sizes}", max(place for _, place in alike)))
    pointers(sheet, names, edge + 12.0, top)
    right = (edge + 12.0 + _NAMES_MM) / scale - float(low[2])
    draw_body(sheet, body, FROM_SIDE, scale, right)
    _mark_side(sheet, proposal, scale, right, (low, high))
    return sheet.svg({})


def _mark_side(
    sheet: Sheet, proposal: Proposal, scale: float, right: float, box: tuple[np.ndarray, np.ndarray]
) -> None:
    """Mount face, pad and the bolts' axis in the side view."""
    (_, low_w, low_h), (_, high_w, high_h) = box
    beyond = _BEYOND_MM / scale

    def page(h: float, w: float) -> Point:
        return scale * (right + h), -scale * w

    sheet.lines([line(page(0, low_w - beyond), page(0, high_w + beyond))], "mark")
    end = page(high_h + beyond, 0)
    sheet.lines([line(page(low_h - beyond, 0), end)], "axis")
    names = [("bolts", end), ("mount face", page(0, high_w + beyond))]
    for name, face in proposal.pads.items():
        pad = face.corners
        first, last = pad[pad[:, 2].argmin()], pad[pad[:, 2].argmax()]
        ends = page(first[2], first[1]), page(last[2], last[1])
        sheet.lines([line(*ends)], "mark")
        names.append((name, ends[1]))
    pointers(sheet, names, end[0] + 10.0, -scale * low_w + 10.0)
