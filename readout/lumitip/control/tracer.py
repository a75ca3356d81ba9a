"""`Tracer`: a law with limits, that notices when the line is lost and when a corner comes."""

from dataclasses import replace

from lumitip import arguments
from lumitip.control.command import Command, ControlError, Limits
from lumitip.control.laws import Law
from lumitip.control.sight import Lead, Sight, sight_of
from lumitip.estimation import Estimate
from lumitip.processing import Contact
from lumitip.values import shown


class Tracer:
    """`command = tracer(contact_or_estimate, dt_s)`: follows the line in its input.

    Without a line it goes on as before, slower and slower, for `slow_s`; then it searches sideways
    where the line went, and back, for `search_s`; then it stops with the reason `"lost"`. With
    `corner_at_mm` it ends at a corner: it comes to rest with the vertex there.
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
        """A tracer that has seen nothing yet.

        Args:
            law: what to do while the line is seen.
            limits: largest velocities.
            slow_s: how long the line may be out of sight before the search (s).
            search_s: how long the search may take (s).
            search_mm_s: its speed (mm/s).
            corner_at_mm: where the vertex of a corner is to be at the end, in x (mm); `None` goes
                on past corners.
            corner_frames: frames in a row that make a corner.
            lead_s: how much later a command takes effect than its frame was taken; the line's
                angle is predicted ahead by this time (s).

        Raises:
            ControlError: if a time is below 0, a count below 1, or something is of another kind.
        """
        if not callable(law):
            raise ControlError(f"law is {shown(law)}; a law like LineLaw(80.0) is needed")
        self.law = law
        self.limits = arguments.instance(
            Limits() if limits is None else limits, Limits, "limits", ControlError
        )
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
        """Forget what was seen."""
        self._last = Command()
        self._lead.reset()
        self._unseen_s = 0.0
        self._side = 1.0
        self._corners = 0
        self._ended = ""

    def __call__(self, seen: Contact | Estimate, dt_s: float) -> Command:
        """The command that follows from what a frame says, `dt_s` after the one before (s).

        Raises:
            ControlError: if that is no contact and no estimate, or the time is below 0.
        """
        dt_s = arguments.number(dt_s, "dt_s", 0.0, error=ControlError)
        if self._ended:
            return Command(state="stop", reason=self._ended)
        sight = self._lead(sight_of(seen), dt_s)
        self._corners = self._corners + 1 if sight.corner_mm is not None else 0
        command = self.law(sight)
        if command is None:
            return self._without_line(dt_s)
        self._unseen_s = 0.0
        command = self.limits.of(self._before_corner(command, sight))
        if command.state == "stop":
            self._ended = command.reason
        else:
            self._last = command
            self._side = 1.0 if command.lateral_mm_s >= 0.0 else -1.0
        return command

    def _before_corner(self, command: Command, sight: Sight) -> Command:
        """Slower towards a corner, so that the finger stands still when it is there."""
        if self.corner_at_mm is None or sight.corner_mm is None:
            return command
        if self._corners < self.corner_frames:
            return command
        ahead_mm = sight.corner_mm - self.corner_at_mm
        if ahead_mm <= _ARRIVED_MM:
            return Command(state="stop", reason="corner")
        share = min(1.0, _APPROACH_PER_S * ahead_mm / max(command.forward_mm_s, 1e-9))
        return replace(
            command,
            forward_mm_s=command.forward_mm_s * share,
            lateral_mm_s=command.lateral_mm_s * share,
            rotation_rad_s=command.rotation_rad_s * share,
        )

    def _without_line(self, dt_s: float) -> Command:
        self._unseen_s += dt_s
        if self._unseen_s <= self.slow_s:
            share = 1.0 - self._unseen_s / self.slow_s if self.slow_s else 0.0
            last = self._last
            return Command(
                last.forward_mm_s * share,
                last.lateral_mm_s * share,
                last.rotation_rad_s * share,
                "slow",
            )
        searching_s = self._unseen_s - self.slow_s
        if searching_s <= self.search_s:
            # A third of the time on the side where the line went, the rest past the other side.
            side = self._side if searching_s < self.search_s / 3.0 else -self._side
            return Command(0.0, side * self.search_mm_s, 0.0, "search")
        self._ended = "lost"
        return Command(state="stop", reason="lost")


_ARRIVED_MM = 0.3
_APPROACH_PER_S = 6.0
