"""`Board` and what it consists of, between its circuit and its files."""

import uuid
from dataclasses import dataclass
from typing import Literal

from shapely import Polygon

from lumitip_fab.design import Box, Flexible, Point

Side = Literal["front", "back"]
SIDES: tuple[Side, Side] = ("front", "back")


@dataclass(frozen=True)
class Pad:
    """A pad in its footprint's frame: seen from the side that the part is on, y up."""

    number: str
    x_mm: float
    y_mm: float
    width_mm: float
    height_mm: float
    shape: Literal["rect", "circle"] = "rect"
    drill_mm: float = 0.0
    """Diameter of the plated hole; 0 for a surface-mount pad."""
    paste: bool = True
    """Whether solder paste is printed on it."""


@dataclass(frozen=True)
class Stroke:
    """A drawn polyline."""

    points: tuple[Point, ...]
    width_mm: float = 0.12


@dataclass(frozen=True)
class Text:
    """A centred line of text."""

    text: str
    x_mm: float
    y_mm: float
    height_mm: float = 0.8
    width_mm: float = 0.12
    """Stroke."""
    angle_deg: float = 0.0


@dataclass(frozen=True)
class Footprint:
    """A land pattern with its drawing, in its own frame."""

    name: str
    """By IPC-7351, such as `LEDC1608X60N`."""
    pads: tuple[Pad, ...]
    body: Box
    courtyard: Box
    height_mm: float
    silk: tuple[Stroke, ...] = ()
    """Outline and polarity mark."""


@dataclass(frozen=True)
class Component:
    """A part in its place."""

    ref: str
    value: str
    part: str
    """Order number; empty for bare copper: wire pads, test points and fiducials."""
    kind: str
    """`"led"`, `"photodetector"`, `"multiplexer"`, `"resistor"`, `"capacitor"`, `"connector"`,
    `"test point"` or `"fiducial"`."""
    footprint: Footprint
    x_mm: float
    y_mm: float
    angle_deg: float
    """Counter-clockwise, seen from the front."""
    side: Side
    nets: tuple[tuple[str, str], ...]
    """Net of each connected pad: `(("1", "GND"), ("2", "Q1"))`."""
    ref_text: Text | None = None
    """Reference on the silkscreen, in the footprint's frame; none where there is no room."""
    manufacturer: str = ""
    lcsc: str = ""
    """Number at the distributor LCSC, where it is known."""


@dataclass(frozen=True)
class NetClass:
    """Rules that a kind of net is routed by."""

    name: str
    track_mm: float
    clearance_mm: float
    via_mm: float
    via_drill_mm: float


@dataclass(frozen=True)
class Net:
    """A net and the name of its class."""

    name: str
    net_class: str


@dataclass(frozen=True)
class Placement:
    """A board before it has copper."""

    finger: str
    name: str
    revision: str
    design_hash: str
    outline: Box
    corner_mm: float
    """Radius of the outline's corners."""
    holes: tuple[Point, ...]
    """Centres of the unplated locating holes."""
    hole_mm: float
    keep_outs: tuple[Box, ...]
    """Where no copper may be on either side."""
    edge_clearance_mm: float
    """Copper to the board's edge and to unplated holes."""
    components: tuple[Component, ...]
    nets: tuple[Net, ...]
    classes: tuple[NetClass, ...]
    ground: str
    """Net that the pour belongs to."""
    silk: tuple[tuple[Side, Stroke], ...]
    texts: tuple[tuple[Side, Text], ...]
    """Silkscreen beyond the components' own."""
    flexible: Flexible | None = None
    """Layers and bend of a flexible board."""
    ground_only: tuple[Box, ...] = ()
    """Where the back carries no net but ground: under a regulator's hot loop."""


@dataclass(frozen=True)
class Track:
    """A straight piece of track."""

    net: str
    side: Side
    start: Point
    end: Point
    width_mm: float


@dataclass(frozen=True)
class Via:
    """A plated hole from front to back."""

    net: str
    x_mm: float
    y_mm: float
    diameter_mm: float
    drill_mm: float


@dataclass(frozen=True)
class Fill:
    """A filled part of the pour: an outline, with holes, of copper as it will be."""

    net: str
    side: Side
    area: Polygon


@dataclass(frozen=True)
class Routing:
    """Tracks and vias, with what it took to find them."""

    tracks: tuple[Track, ...]
    vias: tuple[Via, ...]
    iterations: int


@dataclass(frozen=True)
class BoardModel:
    """A finished board: everything that its files say."""

    placement: Placement
    routing: Routing
    fills: tuple[Fill, ...]


_NAMESPACE = uuid.UUID("408b861d-d571-5373-9831-97c1aafb6016")


def stable_uuid(*parts: str) -> str:
    """The UUID of a thing by its name, such as `stable_uuid("receiver", "symbol", "U1")`."""
    return str(uuid.uuid5(_NAMESPACE, "/".join(parts)))


THERMAL_GAP_MM = 0.25
"""Pour to a pad of its own net."""
THERMAL_SPOKE_MM = 0.3
"""Width of the bridges that join such a pad to the pour."""
MIN_WIDTH_MM = 0.2
"""The narrowest piece of pour."""
CLEARANCE_MM = 0.2
"""Pour to copper of other nets; more where a net class asks for more."""
LEAST_SPOKES = 1
"""Bridges that such a pad has at least: 0.3 mm of copper carry far more than any pad here needs."""


MASK_MM = 0.05
"""Opening round a pad, each side; vias are covered."""


def fiducial_margin_mm(component: Component) -> float:
    """Clear ring round a fiducial, for cameras: half its diameter more; 0 of other parts."""
    if component.kind != "fiducial":
        return 0.0
    return component.footprint.pads[0].width_mm / 2


def opening_mm(component: Component) -> float:
    """How far the mask stays from a part's pads."""
    return fiducial_margin_mm(component) or MASK_MM
