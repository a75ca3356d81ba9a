"""Text of a board file."""

from lumitip_fab.boards.model import Text
from lumitip_fab.boards.pcb.sexpr import Node


def effects(text: Text, mirrored: bool) -> Node:
    """How a text is drawn: by its height, its stroke, and whether it is read from behind."""
    size = ("size", text.height_mm, text.height_mm)
    mirror = (("justify", "mirror"),) if mirrored else ()
    return ("effects", ("font", size, ("thickness", text.width_mm)), *mirror)
