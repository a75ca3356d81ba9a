"""`Tracer`: a law with limits, which detects the loss of the line and corners."""

import math
from dataclasses import replace

from lumitip import arguments
from lumitip.control.laws import Command, ControlError, Law, Limits, Sight
from lumitip.estimation import KINDS, Estimate
from lumitip.processing import Contact
from lumitip.values import shown

SMOOTHING_S = 0.04
"""Time constant of the mean turning rate of the line, about two frames (s)."""
_LARGEST = math.radians(70.0)  # predicted angle
_ARRIVED_MM = 0.3
_APPROACH_PER_S = 6.0
_STEEPEST_DEG = 80.0  # a line across the way of the finger cannot be followed
_CORNER_DEG = 30.0  # largest deviation of a corner from a right angle; flatter ones are curves
_CORNER_MM = 13.0  # a vertex further from the middle is not seen by enough cells
_BEARABLE = frozenset({"misfit", "unfinished", "bright", "ambiguous", "dead"})
MOST_MISFIT = 60.0
"""Of the cells from the fitted line, root mean square (of 255): the published bent cable, which is
fitted straight, has 18 to 29, a cloth with three dead cells at times more than 40, and another
shape, or cells at random, 63 and more."""


def sight_of(seen: Contact | Estimate) -> Sight:
    """The line to follow in a contact or an estimate.

    The border of a corner is followed like an edge. An estimate with other flags than misfit,
    unfinished, bright, ambiguous and dead, or whose cells are beyond `MOST_MISFIT`, has no line.

    Raises:
        ControlError: if `seen` is neither.
    """
    if isinstance(seen, Contact):
        return _of_contact(seen)
    if not isinstance(seen, Estimate):
        raise ControlError(
            f"the input is {shown(seen)}; a Contact or an Estimate is needed, such as "
            "Processor(layout)(frame.values)"
        )
    # A curved line misfits its straight model, but is a line.
    bearable = _BEARABLE.issuperset(seen.flags) and not seen.rms_counts > MOST_MISFIT
    if seen.kind not in KINDS or not bearable:
        return Sight()
    corner_mm = seen.vertex_mm and _corner_mm(seen.vertex_mm[0], seen.opening_deg)
    return _line(seen.offset_mm, seen.angle_deg, None, corner_mm)


def _of_contact(seen: Contact) -> Sight:
    centre_mm = seen.centre_mm[1] if seen.centre_mm else None
    corner_mm = None
    if seen.shape == "cable" and seen.cable is not None:
        point_mm, angle_deg = seen.cable.axis_point_mm, seen.cable.angle_deg
    elif seen.shape == "corner" and seen.corner is not None:
        point_mm = seen.corner.vertex_mm
        corner_mm = _corner_mm(point_mm[0], seen.corner.opening_deg)
        # The line of the ray that is closer to the direction of motion.
        ray = min(seen.corner.directions_deg, key=lambda a: abs(math.sin(math.radians(a))))
        angle_deg = (ray + 90.0) % 180.0 - 90.0
    elif seen.line is not None:
        point_mm, angle_deg = seen.line.point_mm, seen.line.angle_deg
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


def _corner_mm(vertex_x_mm: float, opening_deg: float) -> float | None:
    """Distance in x to a vertex; `None` if it is far away, or its angle is no right angle."""
    near = abs(opening_deg - 90.0) <= _CORNER_DEG and abs(vertex_x_mm) <= _CORNER_MM
    return vertex_x_mm if near else None


class Lead:
    """`sight = lead(sight, dt_s)`: prediction of the line's angle, which goes on turning."""

    def __init__(self, lead_s: float) -> None:
        """A lead without history.

        Args:
            lead_s: delay of the commands, the time to predict; 0 changes nothing (s).
        """
        self.lead_s = lead_s
        self.reset()

    def reset(self) -> None:
        """Forget the history."""
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
        return replace(sight, angle=min(max(ahead, -_LARGEST), _LARGEST))


class Tracer:
    """`command = tracer(contact_or_estimate, dt_s)`: follows the line in its input.

    Without a line it slows down for `slow_s`, then searches on the side where the line went and on
    the other side for `search_s`, then stops with the reason `"lost"`. A line that is seen takes
    off as much of the time without one as it lasts: single frames do not keep a trace alive.
    With `corner_at_mm` it stops at a corner that was ahead, with the vertex at that place.
    """

    def __init__(
        self,
        law: Law,
        limits: Limits | None = None,
        slow_s: float = 0.15,
        search_s: float = 1.0,
        search_mm_s: float = 15.0,
        corner_at_mm: float | None = None,
        corner_frames: int = 2,
        lead_s: float = 0.0,
    ) -> None:
        """A tracer without history.

        Args:
            law: control law while the line is seen.
            limits: largest velocities.
            slow_s: time without a line before the search (s).
            search_s: longest search (s).
            search_mm_s: speed of the search (mm/s).
            corner_at_mm: x at which the vertex of a corner ends the trace (mm); `None` passes
                corners.
            corner_frames: frames in a row with a corner before it counts.
            lead_s: delay from a frame to the effect of its command; the line's angle is predicted
                by this time (s).

        Raises:
            ControlError: if an argument is invalid.
        """
        if not callable(law):
            raise ControlError(f"law is {shown(law)}; a law like LineLaw(80.0) is needed")
        self.law = law
        limits = Limits() if limits is None else limits
        self.limits = arguments.instance(limits, Limits, "limits", ControlError)
        self.slow_s, self.search_s, self.search_mm_s, ahead_s = (
            arguments.number(value, name, 0.0, error=ControlError)
            for value, name in (
                (slow_s, "slow_s"),
                (search_s, "search_s"),
                (search_mm_s, "search_mm_s"),
                (lead_s, "lead_s"),
            )
        )
        if corner_at_mm is not None:
            corner_at_mm = arguments.number(corner_at_mm, "corner_at_mm", error=ControlError)
        self.corner_at_mm = corner_at_mm
        self.corner_frames = arguments.count(corner_frames, "corner_frames", error=ControlError)
        self._lead = Lead(ahead_s)
        self.reset()

    def reset(self) -> None:
        """Forget the history."""
        self._last = Command()
        self._lead.reset()
        self._unseen_s = 0.0
        self._side = 1.0
        self._corners = 0
        self._ahead = False
        self._ended = ""

    def __repr__(self) -> str:
        return f"<Tracer of {self.law!r}, {self._ended or self._last.state}>"

    def __call__(self, seen: Contact | Estimate, dt_s: float) -> Command:
        """The command for a frame that came `dt_s` after the one before (s).

        Raises:
            ControlError: if `seen` is no contact and no estimate, or the time is below 0.
        """
        dt_s = arguments.number(dt_s, "dt_s", 0.0, error=ControlError)
        if self._ended:
            return Command(state="stop", reason=self._ended)
        sight = self._lead(sight_of(seen), dt_s)
        self._corners = self._corners + 1 if sight.corner_mm is not None else 0
        command = self.law(sight)
        if command is None:
            return self._without_line(dt_s)
        self._unseen_s = max(0.0, self._unseen_s - dt_s)
        command = self.limits.of(self._before_corner(command, sight))
        if command.state == "stop":
            self._ended = command.reason
        else:
            self._last = command
            self._side = 1.0 if command.lateral_mm_s >= 0.0 else -1.0
        return command

    def _before_corner(self, command: Command, sight: Sight) -> Command:
        """Slow down towards a corner, so that the finger stands still there."""
        if self.corner_at_mm is None or sight.corner_mm is None:
            return command
        if self._corners < self.corner_frames:
            return command
        ahead_mm = sight.corner_mm - self.corner_at_mm
        if ahead_mm <= _ARRIVED_MM:
            # One that was behind when it was first seen is left behind.
            return Command(state="stop", reason="corner") if self._ahead else command
        self._ahead = True
        return command.scaled(
            min(1.0, _APPROACH_PER_S * ahead_mm / max(command.forward_mm_s, 1e-9))
        )

    def _without_line(self, dt_s: float) -> Command:
        self._unseen_s += dt_s
        if self._unseen_s <= self.slow_s:
            share = 1.0 - self._unseen_s / self.slow_s if self.slow_s else 0.0
            return replace(self._last.scaled(share), state="slow")
        searching_s = self._unseen_s - self.slow_s
        if searching_s <= self.search_s:
            # A third of the time on the side where the line went, the rest on the other side.
            side = self._side if searching_s < self.search_s / 3.0 else -self._side
            return Command(0.0, side * self.search_mm_s, 0.0, "search")
        self._ended = "lost"
        return Command(state="stop", reason="lost")
