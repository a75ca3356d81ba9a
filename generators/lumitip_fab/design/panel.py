"""Panels: copies of a small board in a frame, as a PCB fab assembles them.

Frame of a panel: seen from its front, origin at the middle of its outline, x to the right, y up.
Its rails are the left and the right side; the copies are not turned. Every length is in mm.
"""

import math
from dataclasses import dataclass

from lumitip_fab.design.shape import Box, Point


@dataclass(frozen=True)
class PanelRules:
    """The strictest figures of all PCB fabs."""

    least_mm: Point
    """Smallest board or panel that is assembled."""
    most_mm: Point
    """Largest one."""
    rail_mm: float
    """Least width of a rail."""
    fiducial_mm: float
    """Diameter of a fiducial."""
    fiducial_opening_mm: float
    """Diameter of the mask's opening round it."""
    fiducial_edge_mm: float
    """Panel's edge to that opening, at least."""
    tooling_mm: float
    """Diameter of tooling holes."""
    gap_mm: float
    """Narrowest routed gap; half of it is the radius in its corners."""
    bite_mm: float
    """Diameter of the holes of a mouse bite."""
    bite_web_mm: float
    """Board left between two of them, and at the ends of the row."""
    bites: int
    """Number of them in a row."""
    tab_every_mm: float
    """An edge has a tab for each such length."""
    copper_mm: float
    """Copper to a tab and to the holes of its mouse bite."""
    part_mm: float
    """Mounted parts to a tab."""
    pad_mm: float
    """Pads for wires, and unplated holes of a board, to a tab."""

    @property
    def bite_inset_mm(self) -> float:
        """How far the holes of a mouse bite reach into the board: a third, so that what is left
        after breaking stands out little."""
        return self.bite_mm / 3

    @property
    def bite_row_mm(self) -> float:
        """First to last hole of a mouse bite, from middle to middle."""
        return (self.bites - 1) * (self.bite_mm + self.bite_web_mm)

    @property
    def tab_mm(self) -> float:
        """Width of a tab where it is narrowest: its corners, which a cutter rounds, leave a whole
        web beside the last hole of the mouse bite."""
        radius = self.gap_mm / 2
        outside = self.bite_mm / 2 - self.bite_inset_mm
        reach = math.sqrt(
            (radius + self.bite_web_mm + self.bite_mm / 2) ** 2 - (radius - outside) ** 2
        )
        return self.bite_row_mm + 2 * (reach - radius)

    @property
    def contact_mm(self) -> float:
        """Length of a board's edge that a tab takes, with its round corners."""
        return self.tab_mm + self.gap_mm


@dataclass(frozen=True)
class Panel:
    """Copies of a board between two rails, which two bars join to a frame."""

    board: str
    """Name of the board."""
    columns: int
    rows: int
    box: Box
    """Its outline."""
    inside: Box
    """Inner edge of its frame."""
    first: Point
    """Place of the lower left copy's origin."""
    pitch: Point
    """Copy to copy."""
    rail_mm: float
    """Width of its rails and bars."""
    tabs: int
    """On each of the two edges of a copy that face the rails."""
    rules: PanelRules

    @property
    def name(self) -> str:
        """Name of its folder and its files."""
        return f"{self.board}_panel"

    @property
    def copies(self) -> tuple[Point, ...]:
        """Origin of each copy: row by row from below, each from the left."""
        return tuple(
            (self.first[0] + column * self.pitch[0], self.first[1] + row * self.pitch[1])
            for row in range(self.rows)
            for column in range(self.columns)
        )


def in_copy(name: str, copy: int) -> str:
    """Name of a part or a net in a copy, which is counted from 1."""
    return f"{name}_{copy}"
