"""The printer's fit: the only place where it is added to drawn sizes.

A printed surface that meets another part is offset by the fit: a gap to a board, to metal or to
the gripper grows by the fit, a gap between two printed parts by twice the fit. Between parts of
two filaments only the part of the measured filament is offset: see
`lumitip_fab.derive.finger.interface`.
"""

import math
from dataclasses import dataclass

from lumitip_fab.catalogue.grippers import Gripper
from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.stack import held_by
from lumitip_fab.design import Fits, Nose


@dataclass(frozen=True)
class Drawn:
    """Drawn sizes for a printer, from nominal ones."""

    fit_mm: float

    def gap_mm(self, nominal_mm: float) -> float:
        """Gap between a printed surface and a part that is not printed."""
        return nominal_mm + self.fit_mm

    def hole_mm(self, nominal_mm: float) -> float:
        """Diameter or width of a hole."""
        return nominal_mm + 2 * self.fit_mm

    def peg_mm(self, nominal_mm: float) -> float:
        """Diameter or width of a peg."""
        return nominal_mm - 2 * self.fit_mm


LEAST_GAP_MM = 0.02  # as drawn


def refuse_touching(config: Input, field: str, clearance_mm: float, faults: Diagnostics) -> None:
    """Refuse a fit that removes a clearance."""
    fit_mm = config.parameters.printer.fit_mm
    left_mm = Drawn(fit_mm).gap_mm(clearance_mm)
    faults.unless(
        fit_mm >= 0 or left_mm >= LEAST_GAP_MM - 1e-9,
        "fit_closes_gap",
        left_mm=left_mm,
        clearance_mm=clearance_mm,
        least=min(LEAST_GAP_MM - clearance_mm, 0.0),
        beside=field,
    )


def derive_fits(config: Input, fit_mm: float) -> Fits:
    """Gaps, pins and holes with a fit added to every gap on each side.

    Args:
        config: the clearances and the gripper.
        fit_mm: above zero everything sits looser.
    """
    p = config.parameters
    gripper, drawn = held_by(config), Drawn(fit_mm)
    return Fits(
        fit_mm=fit_mm,
        pocket_gap_mm=drawn.gap_mm(p.backing.pocket_clearance_mm),
        pin_mm=drawn.peg_mm(p.board.hole_mm - 2 * p.backing.pin_clearance_mm),
        bolt_hole_mm=drawn.hole_mm(gripper.bolt_hole_mm),
        gripper_pin_mm=drawn.hole_mm(gripper.pins.hole_mm) if gripper.pins else 0.0,
        nose=_nose(gripper, fit_mm),
    )


def _nose(gripper: Gripper, fit_mm: float) -> Nose | None:
    """The nose as it is drawn: each flank moved in by the fit, square to itself."""
    nose = gripper.nose
    if nose is None:
        return None
    along = Drawn(fit_mm / math.cos(math.radians(nose.half_angle_deg)))
    return Nose(
        along.peg_mm(nose.front_width_mm), nose.front_w_mm, nose.half_angle_deg, nose.height_mm
    )
