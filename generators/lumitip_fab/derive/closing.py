"""How the two fingers meet when the gripper closes."""

import math

from lumitip_fab.derive.faults import Faults
from lumitip_fab.design import Closing, Mould, Mount, Outline, Stack

CONTACT_MM = 4.0


def derive_closing(
    outline: Outline, stack: Stack, mount: Mount, mould: Mould, faults: Faults
) -> Closing:
    """First contact and largest opening, with the lean of the mount applied.

    A point (y, z) of the sensor frame stands `y sin(tilt) + z cos(tilt)` towards the other
    finger. The gripper's opening is between its own pads, `pad_w_mm` before the bolt axis.
    """
    sine, cosine = math.sin(math.radians(mount.tilt_deg)), math.cos(math.radians(mount.tilt_deg))
    thinnest = mould.tip_silicone_mm - stack.cover_mm
    profile = (
        (outline.tip_y_mm, thinnest),
        (outline.tip_y_mm - mould.taper_length_mm, 0.0),
        (outline.end_y_mm + mould.end_round_mm, 0.0),
    )
    reach, y = max((y * sine + z * cosine, y) for y, z in profile)
    bolt = mount.origin_y_mm * sine + stack.rim_z_mm * cosine - mount.bolt_w_mm
    opening = mount.stroke_mm + 2 * (mount.pad_w_mm - (reach - bolt))
    faults.refuse_unless(
        outline.tip_y_mm - y <= CONTACT_MM,
        "coupling.gripper",
        f"{mount.gripper!r} given, whose tilt of {mount.tilt_deg:g}° lets the fingers touch first "
        f"{outline.tip_y_mm - y:.1f} mm from the tip; at most {CONTACT_MM:g} mm is allowed: a tilt "
        "of 0 or more",
    )
    faults.refuse_unless(
        opening >= 10,
        "coupling.gripper",
        f"{mount.gripper!r} given, these fingers open to {opening:.1f} mm in it; at least 10 mm "
        "is needed",
    )
    faults.refuse_unless(
        opening <= mount.stroke_mm,
        "coupling.gripper",
        f"{mount.gripper!r} given, in which these fingers stay {opening - mount.stroke_mm:.1f} mm "
        "apart when it is closed: its bolt_w_mm less its pad_w_mm must grow by half of that",
    )
    return Closing(y, reach, opening)
