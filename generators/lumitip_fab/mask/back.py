"""Where flaps come to lie when they are folded round the finger's edge onto its back."""

import math
from dataclasses import dataclass

import shapely

from lumitip_fab.design import Box, Finger, Interface, Mould, Mount, Outline, Point, Stack, Tip

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
    """Block with its 45° ramp where they stand on the plate's back."""
    tilt, half = math.radians(mount.tilt_deg), mount.block_width_mm / 2
    shoulder = mount.land_mm * math.cos(tilt) - mount.block_back_w_mm * math.sin(tilt)
    ramp = (mount.block_back_w_mm - stack.rim_z_mm + stack.back_z_mm) / math.tan(
        math.radians(45) - tilt
    )
    return Box(-half, half, mount.origin_y_mm - FOOT_MM, mount.origin_y_mm + shoulder + ramp)


def _area(box: Box) -> shapely.Geometry:
    return shapely.box(box.x_min_mm, box.y_min_mm, box.x_max_mm, box.y_max_mm)


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
