"""The fit test plate: what is drawn looser and tighter by steps, and where each is on the plate."""

from dataclasses import dataclass, replace

from lumitip_fab.design.mount import Mount, Nose
from lumitip_fab.design.shape import Box, Point


@dataclass(frozen=True)
class Fits:
    """Everything of backing and coupling that is drawn looser by a fit."""

    fit_mm: float
    """Added to every gap, on each side; below zero all is tighter."""
    pocket_gap_mm: float
    """Board to pocket, on each side."""
    pin_mm: float
    """Diameter of the locating pins in the board's holes."""
    bolt_hole_mm: float
    gripper_pin_mm: float
    """Diameter of the holes for the gripper's pins; 0 where it has none."""
    nose: Nose | None

    def of(self, mount: Mount) -> Mount:
        """A coupling drawn with this fit."""
        return replace(
            mount, bolt_hole_mm=self.bolt_hole_mm, pin_mm=self.gripper_pin_mm, nose=self.nose
        )


@dataclass(frozen=True)
class PocketCorner:
    """The corner of the board's pocket at the tip, cut out of a backing as it stands printed:
    the mount frame is the bed's, moved.

            ╲──╲
             ╲  ╲ ╲   roof over the board's tip, 45° to the bed
              ╲ ─ ▌╲  pin, level but for the tilt
     pocket    ╲  ▌ ╲ gussets
               ─╲▌───╲────────────  foot, the slice behind it
    """

    origin_mm: tuple[float, float, float]
    """Place of the mount frame's origin on the bed, of the first coupon."""
    x_min_mm: float
    """Left side of the first coupon's corner on the bed, outside its wall."""
    x_max_mm: float
    wall_mm: float
    """Of each gusset; of the pocket's wall and roof where they are thinnest."""
    height_mm: float
    foot: Box
    """Under the plate and behind it, as thick as a slice."""
    gusset_mm: tuple[float, float]
    """How far the gussets reach behind the plate on the bed, and their height."""
    lead_mm: float
    """Chamfer of floor and wall at the bed, where a first layer is squeezed wide."""
    pin: Point
    """The board's hole at its pin, in the receiver's sensor frame."""


@dataclass(frozen=True)
class FitPlate:
    """The coupons as they lie on the bed: x to the right, y away from the reader, z up.

    Each step is a coupon of its own, so that a board on one meets no other: in front a corner of
    the pocket with a pin, upright as on the backing, on a foot; behind it a slice of the coupling,
    as thin as the layers that a fit takes. A compliant finger has no pocket, and its plate the
    slices alone.

      ╲ -10 ╱  ╲ -5  ╱
       │ ◎ │    │ ◎ │    slices of the coupling, the nose away from the reader; values in 0.01 mm
     ┌─┴───┴┐ ┌─┴───┴┐
     │▛▀▀▀▀▀│ │▛▀▀▀▀▀│   corners: wall at the left, roof, the pin between them
    """

    steps: tuple[Fits, ...]
    """Tightest first, which is the leftmost."""
    pitch_mm: float
    """From coupon to coupon along x; the first begins at x = 0."""
    width_mm: float
    """Of a coupon."""
    corners: tuple[PocketCorner, ...]
    """The corner of each coupon; none on a compliant finger."""
    label: Box
    """The value of the first coupon, of three characters."""
    label_mm: float
    """Depth of the engraving."""
    slice: Box
    """Slice of the coupling, in the mount's axes u and w."""
    slice_at: Point
    """Place of u = 0, w = 0 of the first coupon's slice; u runs against x, and w against y."""
    thickness_mm: float
    """Thickness of slices."""
    pin_depth_mm: float
    """Depth of the holes for the gripper's pins, from below: through, unless they are sleeves round
    the bolts."""
    volume_ml: float
    """Volume of all coupons, estimated."""

    @property
    def size_mm(self) -> tuple[float, float, float]:
        """Box round all coupons, from the origin."""
        width = (len(self.steps) - 1) * self.pitch_mm + self.width_mm
        depth = self.slice_at[1] - self.slice.y_min_mm
        return width, depth, max(self.thickness_mm, *(c.height_mm for c in self.corners), 0.0)

    def at(self, step: int, place: Point) -> Point:
        """A place of the first coupon moved to another."""
        return place[0] + step * self.pitch_mm, place[1]

    def label_of(self, step: int) -> str:
        """Value of a step in 0.01 mm, with its sign."""
        hundredths = round(100 * self.steps[step].fit_mm)
        return f"{hundredths:+d}" if hundredths else "0"
