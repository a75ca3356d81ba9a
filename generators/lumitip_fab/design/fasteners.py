"""What is screwed together, by thread."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Fastener:
    """A metric thread with its heads and nut, as the catalogue has them."""

    name: str
    """Of the thread, like M5."""
    thread_mm: float
    """Outer diameter."""
    hole_mm: tuple[float, float]
    """Clearance holes, fine and coarse."""
    cap_head_mm: float
    """Diameter of the head of a socket head cap screw."""
    countersunk_mm: float
    """Diameter of the head of a countersunk screw."""
    nut_mm: float
    """Of its nut, across flats."""
    nut_height_mm: float
