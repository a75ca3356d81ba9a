"""Where boards are ordered, and what each board house calls things."""

from dataclasses import dataclass

Pairs = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Fab:
    """A board house."""

    name: str
    layers: Pairs
    """What follows the board's name in the file of each layer: `(("front copper", ".GTL"), …)`."""
    bom: Pairs
    """Heading and field of each column of the bill of materials."""
    positions: Pairs
    """Heading and field of each column of the placement list."""
    sides: tuple[str, str]
    """What it calls front and back."""
    back_from_behind: bool
    """Whether angles of parts on the back count counter-clockwise as seen from there; else they
    are told as KiCad tells them."""
    rotations: tuple[tuple[str, float], ...]
    """What is added to the angle (degrees) of footprints whose name begins so."""
    remark: str
    """What to mind when ordering there; may be empty."""
