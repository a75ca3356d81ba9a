"""Boards with their components, each in a frame of its own.

Frame of a board outside the fingers: seen from its front, origin at the middle of its outline, x to
the right, y up. Every length is in mm.
"""

import math
from dataclasses import dataclass
from typing import Literal

from lumitip_fab.design.shape import Box, Point, Side


@dataclass(frozen=True)
class Pad:
    """A pad in its footprint's frame: seen from the side that the part is on, y up."""

    number: str
    x_mm: float
    y_mm: float
    width_mm: float
    height_mm: float
    round: bool = False
    drill_mm: float = 0.0
    """Diameter of the plated hole; 0 for a surface-mount pad."""
    paste: bool = True
    """Whether solder paste is printed on it."""


Form = Literal[
    "bare", "chip", "array", "leaded", "socket", "springs", "header", "box header", "module"
]
"""Kinds of bodies; bare copper has none."""


@dataclass(frozen=True)
class Shroud:
    """The shroud of a right-angle box header in its footprint's frame; the plug goes in from +y."""

    box: Box
    notch_mm: float
    """Width of the notch in the middle of its upper wall."""


MODELS = "boards/models"
"""Folder of the 3D models, below the output folder."""


@dataclass(frozen=True)
class Footprint:
    """A land pattern with the part's body, in its own frame."""

    name: str
    """By IPC-7351, such as `LEDC1608X60N`, where that has a name for it."""
    pads: tuple[Pad, ...]
    body: Box
    """Body over the pads; the whole body, but for a box header's shroud."""
    height_mm: float
    """Above the board; 0 for bare copper."""
    form: Form = "bare"
    lead_tips_mm: float = 0.0
    """Outer ends of the leads of both rows; 0 for other forms."""
    shroud: Shroud | None = None

    @property
    def model(self) -> str:
        """File name of its 3D model; empty for bare copper."""
        return "" if self.form == "bare" else f"{self.name}.step"


@dataclass(frozen=True)
class Finish:
    """Properties that are ordered with a board and are in none of its layers."""

    mask: str
    """Colour and gloss of the solder mask."""
    surface: str
    """Finish of the pads."""
    copper_um: float
    """Thickness of the copper on each side."""
    reason: str
    """Reason for the colour; empty where any colour does."""


FINGER_FINISH = Finish(
    mask="matte black",
    surface="ENIG",
    copper_um=35.0,
    reason="the board must not reflect infrared light. No other colour, no gloss, and no "
    "silkscreen beyond what is drawn",
)
AUXILIARY_FINISH = Finish(mask="any colour", surface="ENIG", copper_um=35.0, reason="")


@dataclass(frozen=True)
class Component:
    """A part, or bare copper, in its place on a board."""

    ref: str
    value: str
    part: str
    """Order number; empty for bare copper: wire pads, test points and fiducials."""
    kind: str
    """`"led"`, `"resistor"`, `"socket"`, `"wires"` …, which decides its outline and its symbol."""
    footprint: Footprint
    x_mm: float
    y_mm: float
    angle_deg: float
    """Counter-clockwise, seen from the front."""
    side: Side
    """Side of its body: a part on the `"back"` is mirrored in x before it is turned."""
    nets: tuple[tuple[str, str], ...]
    """Net of each connected pad: `(("1", "GND"), ("2", "Q1"))`."""
    manufacturer: str = ""
    lcsc: str = ""
    """Number at the distributor LCSC; empty where it is not known."""
    datasheet: str = ""
    """Address of the maker's data sheet; empty where it is not known."""
    pins: tuple[str, ...] = ()
    """Name of each pad, in the order of the pads; empty where a part has no names."""
    hand_soldered: bool = False
    """Whether it is soldered on by hand after the PCB fab has mounted the rest."""
    mark_confidence: str = ""
    """Confidence in the cathode of an LED to look at, which its mark is taken for; empty of other
    parts."""
    rating: str = ""
    """Rating that a part of the same value may not have, such as `"35 V"`; empty of most parts."""

    @property
    def data_page(self) -> str:
        """Address of its data sheet, or of the distributor's page that leads to it."""
        shop = f"https://www.lcsc.com/product-detail/{self.lcsc}.html" if self.lcsc else ""
        return self.datasheet or shop

    @property
    def assembled(self) -> bool:
        """Whether a PCB fab mounts it: no bare copper, and not soldered on by hand."""
        return bool(self.part) and not self.hand_soldered

    @property
    def body_on_board(self) -> Box:
        """The upright rectangle round its body, with a box header's shroud, in its place."""
        boxes = [self.footprint.body]
        if self.footprint.shroud:
            boxes.append(self.footprint.shroud.box)
        turn = math.radians(self.angle_deg)
        c, s = round(math.cos(turn), 9), round(math.sin(turn), 9)
        mirror = -1 if self.side == "back" else 1
        corners = [
            (self.x_mm + mirror * x * c - y * s, self.y_mm + mirror * x * s + y * c)
            for box in boxes
            for x in (box.x_min_mm, box.x_max_mm)
            for y in (box.y_min_mm, box.y_max_mm)
        ]
        xs, ys = zip(*corners, strict=True)
        return Box(min(xs), max(xs), min(ys), max(ys))

    @property
    def contacts(self) -> bool:
        """Whether it is rows of contacts, where someone plugs or solders: their names are printed
        beside them."""
        return self.kind in ("socket", "header", "wires")


@dataclass(frozen=True)
class Note:
    """A line that is printed on an auxiliary board's front."""

    text: str
    at: Point
    """Its middle."""
    height_mm: float
    angle_deg: float


@dataclass(frozen=True)
class Tie:
    """Strain relief of a cable: two unplated holes for a thread round it."""

    ref: str
    """The row of wire pads that the cable ends at."""
    holes: tuple[Point, Point]
    hole_mm: float
    web_mm: float
    """Board that is left between a hole and the edge, at least."""


@dataclass(frozen=True)
class AuxiliaryBoard:
    """A board with everything on it: what its files must hold."""

    name: str
    """Name of its folder and its files."""
    title: str
    """Title on its silkscreen."""
    title_at: Point
    """Near which its title stands."""
    box: Box
    corner_mm: float
    """Radius of the outline's corners."""
    holes: tuple[Point, ...]
    """Centres of its screw holes."""
    hole_mm: float
    ties: tuple[Tie, ...]
    """One for each row of wire pads that a cable ends at."""
    components: tuple[Component, ...]
    notes: tuple[Note, ...]
    supplies: tuple[str, ...]
    """Nets that are routed wide; ground is one of them."""
    keep_outs: tuple[Box, ...]
    """Areas without copper on either side, under an antenna."""
    hot_loop: tuple[tuple[str, str], ...]
    """Pads round which the current of a switching regulator jumps, by part and number of the
    pad: from its input over the capacitor back to its ground; empty without a regulator."""
    finish: Finish = AUXILIARY_FINISH

    @property
    def module(self) -> Component | None:
        """The controller that is soldered on; none on other boards."""
        return next((part for part in self.components if part.kind == "module"), None)

    @property
    def nets(self) -> tuple[str, ...]:
        """Every net once, ground first."""
        used = (net for part in self.components for _, net in part.nets)
        return tuple(dict.fromkeys((*self.supplies, *used)))
