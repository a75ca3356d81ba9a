"""The edge of the black, and where flaps lie when they are folded onto the finger's back."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from lumitip_fab.design import Box, Finger, Interface, Mould, Mount, Outline, Point, Stack, Tip

Points = NDArray[np.float64]

SAGITTA_MM = 0.28  # of a straight fold from the black's edge; FOLD_OFF_MM is promised
STEP_MM = 0.4  # between the points where folds may end
LONGEST_FOLD_MM = 20.0  # a longer flap is hard to lay down without a crease; the tip's may be


def grown(outline: Outline, by_mm: float, step_mm: float = np.inf) -> Points:
    """Corners of the outline moved out by `by_mm`, counter-clockwise from its first point.

    Args:
        outline: the finger's outline; smooth, so that each point has one normal.
        by_mm: how far to move it.
        step_mm: longest chord on straight pieces; curved ones are always fine.
    """
    corners = []
    for piece in outline.curve:
        p = np.array(piece)
        straight = np.allclose(p[1], p[0] + (p[3] - p[0]) / 3, atol=1e-9)
        steps = max(1, int(np.linalg.norm(p[3] - p[0]) / step_mm)) if straight else 96
        t = np.linspace(0.0, 1.0, steps + 1)[:-1, None]
        at = (1 - t) ** 3 * p[0] + 3 * t * (1 - t) ** 2 * p[1]
        at += 3 * t * t * (1 - t) * p[2] + t**3 * p[3]
        along = (1 - t) ** 2 * (p[1] - p[0]) + 2 * t * (1 - t) * (p[2] - p[1])
        along += t * t * (p[3] - p[2])
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        corners.append(at + by_mm * np.stack([along[:, 1], -along[:, 0]], axis=1))
    return np.concatenate(corners)


def fold_corners(outline: Outline, by_mm: float, start_x_mm: float) -> Points:
    """Ends of the folds, counter-clockwise from the right leg of the gripper end to the left.

    Straight chords of the black's edge, as few as the sagitta allows; mirror-symmetric, with one
    fold across the tip and none across the notch.

    Args:
        outline: the finger's outline.
        by_mm: the wrap allowance.
        start_x_mm: where the first fold begins at the gripper end.
    """
    edge = grown(outline, by_mm, 0.1)
    right = edge[edge[:, 0] >= 0]  # bottom to tip: the outline starts at its left end
    bottom = (right[:, 1] < edge[:, 1].min() + 1e-6) & (right[:, 0] <= start_x_mm)
    right = np.concatenate([[(start_x_mm, edge[:, 1].min())], right[~bottom]])
    tip = int(np.flatnonzero(right[:, 1] < right[-1, 1] - SAGITTA_MM)[-1]) + 1
    half = _chords(right[: tip + 1])
    return np.concatenate([half, half[::-1] * (-1.0, 1.0)])


def _chords(run: Points) -> Points:
    """Corners of the fewest chords along a run, and of those the ones with no narrow chord.

    The best way to each point is the best way to one before it, and one chord more.
    """
    passed = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(run, axis=0).T))])
    steps = max(1, round(passed[-1] / STEP_MM))
    run = run[np.unique(np.searchsorted(passed, np.linspace(0, passed[-1], steps + 1) - 1e-9))]
    ways: list[tuple[int, float, int]] = [(0, 0.0, 0)]  # chords, narrowness, point before
    for end in range(1, len(run)):
        found = []
        for start in range(end - 1, -1, -1):
            length = _chord_length(run[start : end + 1])
            if length is None:
                break
            count, narrowness, _ = ways[start]
            found.append((count + 1, narrowness + length**-2, start))
        ways.append(min(found))
    corners = [len(run) - 1]
    while corners[-1]:
        corners.append(ways[corners[-1]][2])
    return run[corners[::-1]]


def _chord_length(run: Points) -> float | None:
    """Length of the chord of a run, None where it does not follow it; neighbours always do."""
    chord = run[-1] - run[0]
    length = float(np.hypot(*chord))
    if len(run) == 2:
        return length
    off = (run - run[0]) @ np.array([chord[1], -chord[0]]) / length
    follows = length <= LONGEST_FOLD_MM and float(np.abs(off).max()) <= SAGITTA_MM
    return length if follows else None


NOTCH_GAP_MM = 0.5
RELIEF_GAP_MM = 0.5
FOOT_MM = 2.5  # fillets at the foot of the coupling, and a gap


@dataclass(frozen=True)
class Finished:
    """The finger that is wrapped: what a flap must pass and what it must not cover."""

    finger: Finger
    outline: Outline
    stack: Stack
    tip: Tip
    mould: Mould
    mount: Mount
    interfaces: tuple[Interface, ...]

    def side_mm(self, y_mm: float) -> float:
        """Height of the finger's side, from the silicone's face to the plate's back: full but
        for the wedge of the plate and the taper of the silicone at the tip."""
        to_tip = self.outline.tip_y_mm - y_mm
        slant = self.outline.tip_y_mm - self.tip.slant_start_y_mm
        plate = _ramp(to_tip / slant, self.tip.edge_mm, self.stack.plate_mm)
        plate = max(plate, self.mould.level_mm(y_mm))  # the silicone round the tip
        taper = to_tip / self.mould.taper_length_mm
        return plate + _ramp(taper, self.mould.tip_silicone_mm, self.stack.cover_mm)

    def free_from_x_mm(self) -> float:
        """Where, along the gripper end, coupling and notch leave room for flaps."""
        return max(
            self.finger.notch.x_max_mm + NOTCH_GAP_MM,
            self.mount.block_width_mm / 2 + FOOT_MM,
            *(i.groove.x_max_mm + NOTCH_GAP_MM for i in self.interfaces),
        )

    def kept_clear(self) -> tuple[shapely.Geometry, ...]:
        """Coupling, notch and interface, with their gaps: no flap may lie there.

        Of an interface it is the groove that counts, which no fit of the printer moves."""
        notch = self.finger.notch.grown(NOTCH_GAP_MM)
        pads = [_area(i.groove.grown(NOTCH_GAP_MM)) for i in self.interfaces]
        return _area(notch), _area(_coupling(self.mount, self.stack).grown(FOOT_MM)), *pads

    def better_clear(self) -> tuple[shapely.Geometry, ...]:
        """Windows behind parts on the back of the board, with their gaps."""
        return tuple(_area(r.box.grown(RELIEF_GAP_MM)) for r in self.finger.reliefs if r.through)


def _ramp(share: float, low: float, high: float) -> float:
    return low + (high - low) * min(max(share, 0.0), 1.0)


def _coupling(mount: Mount, stack: Stack) -> Box:
    """Block with its ramp and flare where they stand on the plate's back."""
    half = mount.block_width_mm / 2
    end = mount.ramp_end_y_mm(stack.back_z_mm, stack.rim_z_mm) + mount.flare_mm
    return Box(-half, half, mount.origin_y_mm - FOOT_MM, end)


def _area(box: Box) -> shapely.Geometry:
    return shapely.box(*box.bounds_mm)


def folded(
    corners: tuple[Point, Point, Point, Point], allowance_mm: float, side_mm: float
) -> shapely.Geometry:
    """The part of a flap that lies on the back, seen through the finger from its front.

    The film is taken as taut, which reaches farthest: over allowance and side, then inward.

    Args:
        corners: fold start, outer corner, outer corner, fold end; outward is to the right.
        allowance_mm: finger outline to fold.
        side_mm: height of the finger's side.
    """
    a, c, d, b = (shapely.Point(p) for p in corners)
    width = a.distance(b)
    along = ((b.x - a.x) / width, (b.y - a.y) / width)
    outward = (along[1], -along[0])
    length = (c.x - a.x) * outward[0] + (c.y - a.y) * outward[1]
    on_side = side_mm - allowance_mm
    if length <= on_side:
        return shapely.Polygon()

    def laid(start: shapely.Point, end: shapely.Point, reach: float) -> Point:
        """The point of a flap's side edge at a distance from the fold, on the back."""
        share = reach / length
        s = ((end.x - start.x) * along[0] + (end.y - start.y) * along[1]) * share
        inward = reach + 2 * allowance_mm - side_mm
        return (
            start.x + s * along[0] - inward * outward[0],
            start.y + s * along[1] - inward * outward[1],
        )

    at = max(on_side, 0.0)
    return shapely.Polygon([laid(a, c, at), laid(a, c, length), laid(b, d, length), laid(b, d, at)])
