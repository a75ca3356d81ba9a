"""`Board` and what it consists of, between its circuit and its files."""

import uuid
from dataclasses import dataclass, field

from shapely import Polygon

from lumitip_fab.design import Box, Component, Flexible, Led, Photodetector, Point, Side
from lumitip_fab.design.pcb import AUXILIARY_FINISH, Finish

SIDES: tuple[Side, Side] = ("front", "back")
GROUND = "GND"
SIGNAL, SUPPLY = "signal", "supply"
"""Classes of nets."""
AT_CELLS = ("led", "photodetector")
"""Kinds of parts that stand at cells."""


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
class PlacedComponent(Component):
    """A component as its board draws it."""

    courtyard: Box = field(kw_only=True)
    """Body and pads with half the gap that parts keep, in the footprint's frame."""
    shroud_yard: Box | None = None
    """The same of a box header's shroud, in the file that is written."""
    outline: tuple[Stroke, ...] = ()
    """Outline and polarity mark on the silkscreen, in the footprint's frame."""
    ref_text: Text | None = None
    """Reference on the silkscreen, in the footprint's frame; none where there is no room."""


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
class Cells:
    """Cells on a board's front, with a part at each."""

    at: tuple[Point, ...]
    pitch_mm: float
    part: Led | Photodetector
    """The part at each cell, as the catalogue has it."""
    gap_mm: float
    """Least gap between two of them."""


Slot = tuple[tuple[Point, float], ...]
"""A routed opening, counter-clockwise: its corners, which are square, each with its radius."""


@dataclass(frozen=True)
class Placement:
    """A board before it has copper."""

    name: str
    """Name of its folder and its files."""
    title: str
    revision: str
    date: str
    """Of the revision; empty for none."""
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
    """Copper to the board's edge."""
    hole_clearance_mm: float
    """Copper to unplated holes."""
    components: tuple[PlacedComponent, ...]
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
    caption: str = ""
    """Title beside the name of the whole design."""
    cells: Cells | None = None
    finish: Finish = AUXILIARY_FINISH
    thickness_mm: float = 1.6
    ties: tuple[tuple[Point, float], ...] = ()
    """Unplated holes for the threads that hold the cables, with their diameters."""
    slots: tuple[Slot, ...] = ()
    """Routed openings of a panel."""
    pours: tuple[tuple[str, Box], ...] = ()
    """Net and outline of the pour of each copy in a panel."""

    @property
    def poured(self) -> tuple[tuple[str, Box], ...]:
        """Net and outline of each pour; one on a board by itself."""
        return self.pours or ((self.ground, self.outline),)

    @property
    def unplated(self) -> tuple[tuple[Point, float], ...]:
        """Every unplated hole with its diameter."""
        return (*((at, self.hole_mm) for at in self.holes), *self.ties)


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
    solid: frozenset[tuple[str, str]] = frozenset()
    """Pads that the pour joins all round, by part and number of the pad."""


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
LEAST_SPOKES = 2
"""Bridges that such a pad has at least; a pad with room for fewer is joined all round."""


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
