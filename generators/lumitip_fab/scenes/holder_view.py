"""The holder of the controller's board on the gripper, from behind, with the loops of ties."""

import numpy as np

from lumitip_fab.design import Holder
from lumitip_fab.design.tie_lug import TieLug
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.dimensions import circle
from lumitip_fab.scenes.drawing import Points, Sheet, view
from lumitip_fab.scenes.finger_views import paint

AZIMUTH_DEG, ELEVATION_DEG = 155.0, 28.0
SCALE = 0.8
TIE = "#1a1a1a"
_BEYOND_MM = 10.0  # of the gripper, on both sides of the holder
_OUTSIDE_MM = 0.6  # of a tie outside its lug
_LABEL_MM, _WORDS_MM, _WORDS = 8.0, 75.0, 2.1


def holder_view(holder: Holder, printed: Mesh) -> str:
    """The arms round the gripper, which is drawn as its edges.

    Args:
        holder: for its lugs, and the gripper's axis.
        printed: the holder in the frame of its bed, on which it stands.
    """
    sheet, eye = Sheet(words_scale=_WORDS), view(AZIMUTH_DEG, ELEVATION_DEG).enlarged(SCALE)
    paint(sheet, eye, {"holder": printed})
    high = float(printed.points_mm[:, 2].max())
    axis = 0.0, -holder.axis_z_mm
    ring = circle(axis, holder.body_mm / 2)
    ends = [-_BEYOND_MM, high + _BEYOND_MM]
    rings = [eye.seen(np.column_stack([ring, np.full(len(ring), z)]))[:, :2] for z in ends]
    sides = [np.argmin(rings[0][:, 0]), np.argmax(rings[0][:, 0])]
    sheet.lines([*rings, *(np.array([rings[0][k], rings[1][k]]) for k in sides)], "axis")
    loops = [eye.seen(loop)[:, :2] for loop in _loops(holder)]
    with sheet.group("ties"):
        for loop in loops:
            sheet.wire(loop, [TIE])
    lower = min(loops, key=lambda points: float(points[:, 1].min()))
    upper = max(loops, key=lambda points: float(points[:, 1].max()))
    cables = [
        (("Cable lug", f"for the cable at {lug.name}"), eye.seen(_outside(lug))[0, :2])
        for lug in holder.lugs
    ]
    middle = float(rings[0][:, 0].mean())
    right = [
        (("Gripper", "dashed: its edges"), rings[1][int(rings[1][:, 0].argmax())]),
        (("Loop", "two ties, pulled tight"), lower[lower[:, 0].argmax()]),
        *(label for label in cables if label[1][0] > middle),
    ]
    sheet.leaders_beside(right, _WORDS_MM)
    left = [
        (("Arm lug", "for a tie of the loop"), upper[upper[:, 0].argmin()]),
        *(label for label in cables if label[1][0] <= middle),
    ]
    edge = float(sheet.low[0]) - _LABEL_MM
    low = sheet.leaders(left, edge, "end")
    sheet.cover(edge - _WORDS_MM, low)
    return sheet.svg({"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": ELEVATION_DEG})


def _outside(lug: TieLug) -> Points:
    """Middle of a lug's outer face on the bed, `(1, 3)`."""
    z = (lug.opening.y_min_mm + lug.opening.y_max_mm) / 2
    return np.array([[lug.side * (lug.face_mm + lug.out_mm), sum(lug.along_mm) / 2, z]])


def _loops(holder: Holder) -> list[Points]:
    """The way of each loop: through a lug and behind the gripper to that of the other arm, and back
    outside both; `(n, 3)` on the bed."""
    return [_loop(lug) for lug in holder.arm_lugs if lug.side < 0]


def _loop(lug: TieLug) -> Points:
    first, last = lug.along_mm
    z = (lug.opening.y_min_mm + lug.opening.y_max_mm) / 2
    inner = lug.face_mm + (lug.opening.x_min_mm + lug.opening.x_max_mm) / 2
    outer = lug.face_mm + lug.out_mm + _OUTSIDE_MM
    turn = np.linspace(0.0, np.pi, 49)
    behind = np.column_stack([np.cos(turn), np.sin(turn)])
    ways = [inner * behind + (0.0, last), outer * behind[::-1] + (0.0, last)]
    corners = [
        ways[0],
        [(-inner, first), (-outer, first)],
        ways[1],
        [(outer, first), (inner, first), (inner, last)],
    ]
    flat = np.concatenate([np.asarray(corner) for corner in corners])
    return np.column_stack([flat, np.full(len(flat), z)])
