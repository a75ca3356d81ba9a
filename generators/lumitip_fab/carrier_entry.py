"""Catalogue entries of what carriers hold: sockets, and how a controller plugs into them."""

from typing import Annotated

from pydantic import Field

from lumitip_fab.entry import Entry, Length, Strict

PinName = Annotated[str, Field(pattern=r"^[A-Z0-9]{1,6}$")]


class Strip(Entry):
    """A row of contacts in plated holes."""

    manufacturer: str = Field(min_length=1, max_length=64)
    """Who makes it, for the bill of materials; "any" where it does not matter."""
    order_number: str = Field(min_length=1, max_length=64)
    """What to order."""
    lcsc: str = Field(default="", pattern=r"^(C[1-9]\d*)?$")
    """Number at the distributor LCSC; empty where it is not known."""
    ways: int = Field(ge=1, le=64)
    """Contacts in a row."""
    pitch_mm: Length
    """From contact to contact."""
    pad_mm: Length
    """Diameter of the copper round a hole."""
    drill_mm: Length
    """Diameter of a hole."""
    height_mm: Length
    """Above the board."""


class Plug(Strict):
    """How a controller board stands on two socket strips, its USB plug to the left.

    ```
         rows[1][0] … rows[1][-1]
    USB ▐                        ▌
         rows[0][0] … rows[0][-1]
    ```
    """

    rows: tuple[
        Annotated[tuple[PinName, ...], Field(min_length=2, max_length=64)],
        Annotated[tuple[PinName, ...], Field(min_length=2, max_length=64)],
    ]
    """Names of the pins of both rows from left to right, the lower row first."""
    spacing_mm: Length
    """From row to row."""
    body_mm: tuple[Length, Length]
    """Length and width of the controller board."""
    ground: PinName
    """Its ground pins."""
    supply: PinName
    """Pin that takes the regulated supply."""
    regulated: PinName
    """Pin that feeds the receiver."""
