"""`Design`: everything that is derived from the parameters, once. Types only.

Every length is in mm and in the sensor frame of the finger it belongs to, unless it says
otherwise: gripping face seen with the tip up, origin at the mean of the cell centres on the
film's outer face, x to the right, y towards the tip, z out of the face.
"""

from dataclasses import dataclass

from lumitip.layout import Layout
from lumitip_fab.design.boards import (
    Board,
    Connector,
    Controller,
    Finger,
    Grid,
    Part,
    Relief,
    Wiring,
    Zone,
)
from lumitip_fab.design.gripper import Closing, Mount, Nose
from lumitip_fab.design.making import Mask, Mould, Printing
from lumitip_fab.design.shape import Box, Cubic, Outline, Point, Stack, Tip

__all__ = [
    "Board",
    "Box",
    "Closing",
    "Connector",
    "Controller",
    "Cubic",
    "Design",
    "Finger",
    "Grid",
    "Mask",
    "Mould",
    "Mount",
    "Nose",
    "Outline",
    "Part",
    "Point",
    "Printing",
    "Relief",
    "Stack",
    "Tip",
    "Title",
    "Wiring",
    "Zone",
]


@dataclass(frozen=True)
class Title:
    """What goes on drawings and boards."""

    name: str
    revision: str


@dataclass(frozen=True)
class Design:
    """A whole sensor. A generator's arguments are named after these fields."""

    title: Title
    grid: Grid
    layout: Layout
    stack: Stack
    outline: Outline
    tip: Tip
    board: Board
    emitter: Finger
    receiver: Finger
    mount: Mount
    closing: Closing
    wiring: Wiring
    mask: Mask
    mould: Mould
    printing: Printing
    controller: Controller
    parameters_hash: str

    @property
    def fingers(self) -> tuple[Finger, Finger]:
        """Both fingers, emitter first."""
        return self.emitter, self.receiver
