"""What a fit of the printer changes: the one place where it is added."""

import math

from lumitip_fab.derive.flex import held_by
from lumitip_fab.design import Fits, Nose
from lumitip_fab.gripper_entry import Gripper
from lumitip_fab.load import Input


def derive_fits(given: Input, fit_mm: float) -> Fits:
    """Gaps, pins and holes with a fit added to every gap on each side.

    Args:
        given: the clearances and the gripper.
        fit_mm: above zero everything sits looser.
    """
    p = given.parameters
    gripper = held_by(given)
    return Fits(
        fit_mm=fit_mm,
        pocket_gap_mm=p.backing.pocket_clearance_mm + fit_mm,
        pin_mm=p.board.hole_mm - 2 * (p.backing.pin_clearance_mm + fit_mm),
        bolt_hole_mm=gripper.bolt_hole_mm + 2 * fit_mm,
        gripper_pin_mm=gripper.pins.hole_mm + 2 * fit_mm if gripper.pins else 0.0,
        nose=_nose(gripper, fit_mm),
    )


def _nose(gripper: Gripper, fit_mm: float) -> Nose | None:
    """The nose as it is drawn: each flank moved in by the fit, square to itself."""
    nose = gripper.nose
    if nose is None:
        return None
    narrower = 2 * fit_mm / math.cos(math.radians(nose.half_angle_deg))
    return Nose(
        nose.front_width_mm - narrower, nose.front_w_mm, nose.half_angle_deg, nose.height_mm
    )
