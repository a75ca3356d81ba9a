"""Catalogue entries for ordering: PCB manufacturers and prices."""

from collections.abc import Mapping
from typing import Annotated, Literal, Self, get_args

from pydantic import Field, model_validator

from lumitip_fab.catalogue.record import Entry, Length, Sourced, Strict

Layers = Literal[
    "front_copper",
    "back_copper",
    "front_mask",
    "back_mask",
    "front_paste",
    "back_paste",
    "front_silk",
    "back_silk",
    "outline",
    "plated",
    "unplated",
    "stiffener",
]
BomField = Literal[
    "item",
    "refs",
    "quantity",
    "manufacturer",
    "part",
    "value",
    "footprint",
    "lcsc",
]
PositionField = Literal["ref", "value", "footprint", "part", "x_mm", "y_mm", "angle_deg", "side"]
Heading = Annotated[str, Field(min_length=1, max_length=40)]
Ending = Annotated[str, Field(pattern=r"^[A-Za-z0-9_.\-]{2,30}$")]


class Silk(Strict):
    """Smallest legible silkscreen of a PCB fab."""

    text_mm: Length
    """Height of the smallest letters."""
    line_mm: Length
    """Width of the thinnest lines."""
    gap_mm: Length
    """Least distance between silkscreen and pads."""


Side = Annotated[float, Field(ge=1, le=1000)]


class PanelLimits(Sourced):
    """Figures of a PCB fab that assembles boards and panels."""

    least_mm: tuple[Side, Side]
    """Smallest board or panel that it assembles."""
    most_mm: tuple[Side, Side]
    """Largest one."""
    rail_mm: Length
    """Least width of a rail."""
    fiducial_mm: Length
    """Diameter of a fiducial's copper."""
    fiducial_opening_mm: Length
    """Diameter of the mask's opening round it."""
    fiducial_edge_mm: Length
    """Panel's edge to that opening, at least."""
    tooling_mm: Length
    """Diameter of the unplated tooling holes."""
    gap_mm: Length
    """Width of a routed gap, which is that of the milling cutter."""
    bite_mm: Length
    """Diameter of the holes of a mouse bite."""
    bite_web_mm: Length
    """Board left between two of them."""
    bites: int = Field(ge=2, le=20)
    """Least number of them in a row."""
    tab_every_mm: Length
    """An edge has a tab for each such length, and two at least."""
    copper_mm: Length
    """Copper to a tab and to the holes of its mouse bite."""
    part_mm: Length
    """Mounted parts to a tab."""
    pad_mm: Length
    """Pads for wires, and unplated holes of a board, to a tab."""


class Fab(Entry):
    """A PCB fab: its names of files and columns, and its angles."""

    layers: Mapping[Layers, Ending]
    """End of the file name of each layer, after the board's name; a stiffener is of flexible boards
    alone."""
    bom: tuple[tuple[Heading, BomField], ...] = Field(min_length=1)
    """Heading and field of each column of the bill of materials."""
    positions: tuple[tuple[Heading, PositionField], ...] = Field(min_length=1)
    """Heading and field of each column of the placement list."""
    silk: Silk
    """Limits of its silkscreen."""
    panel: PanelLimits | None = None
    """Figures of its panels; none of a fab that takes every board alone."""
    remark: str = Field(default="", max_length=300)
    """Remark on ordering there, for the note in its zip."""
    sides: tuple[Heading, Heading]
    """Its names of front and back."""
    back_angle: Literal["from behind", "as KiCad"]
    """Direction in which the angle of a part on the back is counted."""
    rotations: Mapping[str, float]
    """Offset of the angle (degrees) of footprints, by the beginning of their name."""
    rotations_assumed: tuple[str, ...] = ()
    """Beginnings in `rotations` whose offset is assumed: the assembly note names these parts, and
    those that no beginning fits."""
    part_rotations: Mapping[str, float] = Field(default_factory=dict)
    """Offset (degrees) of single parts by their order number, in place of that of their footprint:
    how the house's own footprint of the part lies."""

    @model_validator(mode="after")
    def _layers_whole(self) -> Self:
        missing = sorted(set(get_args(Layers)) - set(self.layers))
        if missing:
            raise ValueError(f"layers has no {', '.join(missing)}; each is needed")
        if len(set(self.layers.values())) < len(self.layers):
            raise ValueError("layers has the same ending twice; each layer needs its own")
        return self

    @model_validator(mode="after")
    def _assumes_what_it_has(self) -> Self:
        unknown = sorted(set(self.rotations_assumed) - set(self.rotations))
        if unknown:
            raise ValueError(
                f"rotations_assumed has {', '.join(unknown)}, which rotations has not. Add it there"
            )
        return self


Price = Annotated[float, Field(ge=0, le=1e6)]


class Pack(Entry):
    """What one buys of something that is sold in packs; its price is in `prices.toml`."""

    manufacturer: str = Field(default="", max_length=64)
    """Manufacturer of the product; empty where any will do."""
    product: str = Field(default="", max_length=64)
    """Name or order number of the product."""
    pack: str = Field(min_length=1, max_length=64)
    """The pack, such as "roll of 33 m x 12 mm"."""
    holds: float = Field(gt=0, le=1e5)
    """Content of a pack, in `unit`."""
    unit: Literal["g", "m", "mL", "piece", "sheet"]
    """Unit of `holds`."""
    colours: tuple[Annotated[str, Field(pattern=r"^[A-Z]{2}$")], ...] = ()
    """Colours of a set of wires, by the codes of IEC 60757."""
    limit_c: float | None = Field(default=None, ge=20, le=400)
    """Highest temperature that it bears for hours, of wires their insulation (°C); none of what has
    it in a file of its own, or lies in no finger while the silicone cures."""


class BoardPrice(Strict):
    """One bare board."""

    each: Price
    """Whatever its size."""
    per_cm2: Price
    """By its area."""


class PlacingPrice(Strict):
    """Placing and soldering."""

    each: Price
    """Price of one part."""


class Prices(Sourced):
    """Prices of parts, in one currency."""

    currency: str = Field(pattern=r"^[A-Z]{3}$")
    """Three letters, such as EUR."""
    dated: str = Field(pattern=r"^\d{4}-\d{2}$")
    """Year and month of the prices."""
    each: Mapping[str, Price]
    """One piece, by name of the entry in another file of `parts/`."""
    board: BoardPrice
    placing: PlacingPrice
    pack: Mapping[str, Price]
    """A pack, by its name in `packs.toml`."""
