"""Input of the controller: the contact in the gripper frame, and its prediction."""

import math
from dataclasses import dataclass, replace

from lumitip.control.command import ControlError
from lumitip.estimation import KINDS, Estimate
from lumitip.processing import Contact
from lumitip.values import shown

_STEEPEST_DEG = 80.0  # a line across the way of the finger cannot be followed
_CORNER_DEG = 30.0  # a corner opens by a right angle within this; what is flatter is a curve
_CORNER_MM = 13.0  # a vertex further from the middle is not seen by enough cells
_BEARABLE = frozenset({"misfit", "unfinished", "ambiguous"})


@dataclass(frozen=True, slots=True)
class Sight:
    """The followed line, in the sensor frame."""

    height_mm: float | None = None
    """Where the line crosses x = 0 (mm); `None` without a line that can be followed."""
    angle: float = 0.0
    """Direction of the line against x (rad)."""
    centre_mm: float | None = None
    """Height of the dark centre (mm); only a `Contact` has it."""
    corner_mm: float | None = None
    """How far ahead in x the vertex of a corner is (mm); `None` without a corner."""


def sight_of(seen: Contact | Estimate) -> Sight:
    """The figures that the controller needs from a contact or an estimate.

    A corner's border is followed like an edge's. An estimate that says itself that it is wrong
    shows no line.

    Raises:
        ControlError: if it is neither.
    """
    if isinstance(seen, Contact):
        return _of_contact(seen)
    if not isinstance(seen, Estimate):
        raise ControlError(
            f"the input is {shown(seen)}; a Contact or an Estimate is needed, such as "
            "Processor(layout)(frame.values)"
        )
    # A curved line misfits its straight model, and is a line all the same.
    if seen.kind not in KINDS or not _BEARABLE.issuperset(seen.flags):
        return Sight()
    corner_mm = None
    if seen.vertex_mm is not None and abs(seen.opening_deg - 90.0) <= _CORNER_DEG:
        corner_mm = _ahead(seen.vertex_mm[0])
    return _line(seen.offset_mm, seen.angle_deg, None, corner_mm)


def _of_contact(seen: Contact) -> Sight:
    centre_mm = seen.centre_mm[1] if seen.centre_mm else None
    line = seen.line
    corner_mm = None
    if seen.shape == "cable" and seen.cable is not None:
        point_mm, angle_deg = seen.cable.axis_point_mm, seen.cable.angle_deg
    elif seen.shape == "corner" and seen.corner is not None:
        point_mm = seen.corner.vertex_mm
        if abs(seen.corner.opening_deg - 90.0) <= _CORNER_DEG:
            corner_mm = _ahead(point_mm[0])
        # Of both rays the one along the way, as a line.
        ray = min(seen.corner.directions_deg, key=lambda a: abs(math.sin(math.radians(a))))
        angle_deg = (ray + 90.0) % 180.0 - 90.0
    elif line is not None:
        point_mm, angle_deg = line.point_mm, line.angle_deg
    else:
        return Sight(centre_mm=centre_mm)
    turn = math.radians(angle_deg)
    offset_mm = point_mm[1] * math.cos(turn) - point_mm[0] * math.sin(turn)
    return _line(offset_mm, angle_deg, centre_mm, corner_mm)


def _line(
    offset_mm: float, angle_deg: float, centre_mm: float | None, corner_mm: float | None
) -> Sight:
    if abs(angle_deg) > _STEEPEST_DEG:
        return Sight(centre_mm=centre_mm, corner_mm=corner_mm)
    turn = math.radians(angle_deg)
    return Sight(offset_mm / math.cos(turn), turn, centre_mm, corner_mm)


def _ahead(vertex_mm: float) -> float | None:
    return vertex_mm if abs(vertex_mm) <= _CORNER_MM else None


SMOOTHING_S = 0.04
"""Time constant over which the turning of the line is averaged: two frames or so (s)."""
_MOST = math.radians(70.0)


class Lead:
    """`sight = lead(sight, dt_s)`: its angle goes on turning as it did, for `lead_s`."""

    def __init__(self, lead_s: float) -> None:
        """A lead that has seen nothing yet.

        Args:
            lead_s: how much later commands take effect; 0 leaves all as it is seen (s).
        """
        self.lead_s = lead_s
        self.reset()

    def reset(self) -> None:
        """Forget what was seen."""
        self._angle: float | None = None
        self._rate = 0.0

    def __call__(self, sight: Sight, dt_s: float) -> Sight:
        """Prediction from the input that came `dt_s` after the one before (s)."""
        if not self.lead_s or sight.height_mm is None:
            self.reset()
            return sight
        if self._angle is not None and dt_s > 0.0:
            fresh = 1.0 - math.exp(-dt_s / SMOOTHING_S)
            self._rate += fresh * ((sight.angle - self._angle) / dt_s - self._rate)
        self._angle = sight.angle
        ahead = sight.angle + self.lead_s * self._rate
        return replace(sight, angle=min(max(ahead, -_MOST), _MOST))
