"""The way from a wire to the controller's supply pin."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Feed:
    """The way from a wire to the controller's supply pin."""

    board: str
    diode: str | None
    """In the catalogue; none where wire and pin are joined."""
    wire: str
    """Name of the wire."""
    pin: str
    """Name of the controller's pin."""
    wire_v: float
    """Least voltage at the wire's end."""
    drawn_ma: float
    """Largest current of the controller."""
    drop_v: float
    """Largest forward voltage of the diode at that current; 0 without one."""
    least_v: float
    """With which the controller works."""
