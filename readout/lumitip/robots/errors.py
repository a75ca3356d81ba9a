"""What can go wrong with a robot arm."""
# ruff: noqa: N818 - named by what happened, as in `lumitip.errors`

from lumitip.errors import LumitipError

WHY = {
    "closed": "the program closed it",
    "connection": "the connection to the arm stands still or is cut",
    "corner": "the tracer came to a corner",
    "emergency": "the emergency stop is pressed",
    "error": "sending to the arm failed",
    "force": "the force on the tool changed by more than `force_n`",
    "lost": "the tracer lost the line",
    "program": "the control program no longer runs on the arm's controller",
    "protective": "the arm is in a protective stop",
    "speed": "the arm is faster than it was told",
    "stale": "no fresh frame came within `stale_s`",
    "travel": "the fingertip is further than `travel_mm` from where it began",
    "turn": "the fingertip has turned by more than `turn_deg`",
}
"""Every reason for which an arm is stopped."""


class ArmError(LumitipError):
    """An arm that cannot be reached, or limits or a mount that cannot be so."""


class ArmStopped(ArmError):
    """The arm was stopped and takes no more commands: open it anew."""

    def __init__(self, reason: str, detail: str = "") -> None:
        more = f" ({detail})" if detail else ""
        super().__init__(
            f"the arm was stopped: {WHY.get(reason, reason)}{more}; look at it, then open it anew"
        )
        self.reason = reason
        """A key of `WHY`."""
