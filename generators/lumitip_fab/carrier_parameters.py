"""Sections of the parameter file about what is outside the fingers."""

from typing import Annotated

from pydantic import Field

from lumitip_fab.entry import Name, Strict

Size = Annotated[float, Field(ge=5, le=200)]


class Breakout(Strict):
    """The board that the controller plugs into, and where the cables end."""

    enabled: bool
    """Whether it is made, with its holder."""
    socket: Name
    """Socket strip in `parts/strips.toml`; one for each row of the controller's pins."""
    board_mm: tuple[Size, Size]
    """Length, along the controller, and width (mm)."""
    hole_mm: float = Field(ge=1, le=5)
    """Diameter of its two screw holes (mm)."""
    hole_spacing_mm: float = Field(ge=5, le=180)
    """From hole to hole, of the board and of its holder alike (mm)."""


class Holder(Strict):
    """The printed holder that clips the breakout board to the gripper."""

    body_mm: float = Field(ge=20, le=200)
    """Diameter of the gripper's round body (mm)."""
    clearance_mm: float = Field(ge=0, le=2)
    """Cradle to that body, and tray to the board, each side (mm)."""
    wall_mm: float = Field(ge=0.8, le=10)
    """Arms and floor of the tray (mm)."""
    wrap_deg: float = Field(ge=91, le=130)
    """How far each arm reaches round the body, from the middle of the tray: beyond 90° it clips
    on (degrees)."""
    standoff_mm: float = Field(ge=2, le=20)
    """Room under the board for solder tails (mm)."""
    nut_mm: float = Field(ge=2, le=12)
    """Across flats of the nuts that hold the board's screws (mm)."""
    strap_hole_mm: float = Field(ge=1, le=10)
    """Diameter of the two holes in each arm, for screws of the gripper or a cable tie (mm)."""
    strap_spacing_mm: float = Field(ge=3, le=100)
    """From hole to hole (mm)."""
