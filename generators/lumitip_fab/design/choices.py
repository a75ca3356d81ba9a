"""What the program chose where the parameter file leaves it the choice."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Choice:
    """The value of an automatic field."""

    field: str
    value: str
    """As it would be written in a parameter file."""
    reason: str
    """In one line."""
