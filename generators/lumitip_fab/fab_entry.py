"""Board houses in the catalogue."""

from collections.abc import Mapping
from typing import Annotated, Literal, Self, get_args

from pydantic import Field, model_validator

from lumitip_fab.entry import Entry, Length, Strict

Layers = Literal[
    "front_copper", "back_copper", "front_mask", "back_mask", "front_paste", "back_paste",
    "front_silk", "back_silk", "outline", "plated", "unplated", "stiffener",
]  # fmt: skip
BomField = Literal[
    "item", "refs", "quantity", "manufacturer", "part", "value", "footprint", "lcsc",
]  # fmt: skip
PositionField = Literal["ref", "value", "footprint", "part", "x_mm", "y_mm", "angle_deg", "side"]
Heading = Annotated[str, Field(min_length=1, max_length=40)]
Ending = Annotated[str, Field(pattern=r"^[A-Za-z0-9_.\-]{2,30}$")]


class Silk(Strict):
    """What a board house prints legibly."""

    text_mm: Length
    """Height of the smallest letters."""
    line_mm: Length
    """Width of the thinnest lines."""
    gap_mm: Length
    """Least distance between silkscreen and pads."""


class Fab(Entry):
    """A board house: what it calls files and columns, and how it counts angles."""

    layers: Mapping[Layers, Ending]
    """What follows the board's name in the file of each layer; a stiffener is of flexible boards
    alone."""
    bom: tuple[tuple[Heading, BomField], ...] = Field(min_length=1)
    """Heading and field of each column of the bill of materials."""
    positions: tuple[tuple[Heading, PositionField], ...] = Field(min_length=1)
    """Heading and field of each column of the placement list."""
    silk: Silk
    """What its silkscreen shows."""
    remark: str = Field(default="", max_length=300)
    """What to mind when ordering there, for the note in its zip."""
    sides: tuple[Heading, Heading]
    """What it calls front and back."""
    back_angle: Literal["from behind", "as KiCad"]
    """How the angle of a part on the back is counted."""
    rotations: Mapping[str, float]
    """What is added to the angle (degrees) of footprints whose name begins so."""

    @model_validator(mode="after")
    def _layers_whole(self) -> Self:
        missing = sorted(set(get_args(Layers)) - set(self.layers))
        if missing:
            raise ValueError(f"layers without {', '.join(missing)} given, each is needed")
        if len(set(self.layers.values())) < len(self.layers):
            raise ValueError("layers with the same ending given, each needs its own")
        return self
