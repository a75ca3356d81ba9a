"""Boards of the fingers, their parts and connections.

Every length is in mm and in the sensor frame of the finger it belongs to, unless it says
otherwise.
"""

from dataclasses import dataclass
from typing import Literal

from lumitip_fab.design.pcb import FINGER_FINISH, Finish, Tie
from lumitip_fab.design.shape import Box, Point, Side

GLUE_FILM_MM = 0.1
"""Thin film of glue between board and floor, or pad and plate (assumed)."""
_OFF_SHARE, _OFF_MM = 0.1, 0.1


def thickness_off_mm(thickness_mm: float) -> float:
    """How far a board of FR-4 is off its thickness as PCB fabs sell it: ±10 % from 1 mm on, ±0.1 mm
    below (jlcpcb.com, capabilities)."""
    return _OFF_SHARE * thickness_mm if thickness_mm >= 1.0 else _OFF_MM


@dataclass(frozen=True)
class Grid:
    """The grid of the parameter file; the cells are in `Design.layout`."""

    columns: tuple[int, ...]
    pitch_mm: float


@dataclass(frozen=True)
class Flexible:
    """A board of polyimide with copper on both sides, each under a coverlay."""

    bend: Box
    """Where it bends: there are no vias."""
    stiffener: Box
    """Where a stiffener is glued to its back."""
    stiffener_mm: float
    core_mm: float
    copper_mm: float
    """Thickness of the copper on each side."""
    coverlay_mm: float
    """Thickness of the coverlay on each side, with its adhesive."""


@dataclass(frozen=True)
class Board:
    """Outline shared by both boards, and the pocket that holds one."""

    box: Box
    hole_mm: float
    pocket: Box
    """On the pocket's floor."""
    roof_mm: float
    """How much farther the pocket's end at the tip reaches at the rim: it rises at 45° as printed,
    so that nothing hangs over."""
    pocket_clearance_mm: float
    pin_mm: float
    """Diameter of the pocket's locating pins, which stand at the board's holes."""
    flexible: Flexible | None
    """Layers and bend of a flexible board; none for a rigid one."""


@dataclass(frozen=True)
class Part:
    """A part on a board: land pattern with body, seen from the front whatever its side."""

    name: str
    kind: str
    x_mm: float
    y_mm: float
    size_x_mm: float
    size_y_mm: float
    height_mm: float
    side: Side
    """`"front"` (under the silicone) or `"back"`."""

    @property
    def box(self) -> Box:
        """Its land pattern with body."""
        dx, dy = self.size_x_mm / 2, self.size_y_mm / 2
        return Box(self.x_mm - dx, self.x_mm + dx, self.y_mm - dy, self.y_mm + dy)


@dataclass(frozen=True)
class Zone:
    """A region of a board kept for a purpose; placement works inside it or fails."""

    name: str
    box: Box


@dataclass(frozen=True)
class Connector:
    """A row of through-hole pads for wires."""

    signals: tuple[str, ...]
    """Signal of each pad, left to right in the finger's frame."""
    supply: str
    """That of these which feeds the finger's board, beside ground."""
    pads: tuple[Point, ...]
    pitch_mm: float
    pad_mm: float
    drill_mm: float


@dataclass(frozen=True)
class Relief:
    """Room in the pocket's floor for parts on the back of the board."""

    box: Box
    depth_mm: float
    """Below the pocket's floor; the floor's thickness where it is a window."""
    through: bool
    """Whether it is a window through the plate."""


@dataclass(frozen=True)
class AtCells:
    """The parts at the cells of a finger."""

    kind: Literal["led", "photodetector"]
    letter: str
    x_sign: float
    """Part i is at this times the x of cell i of the layout: the fingers face each other."""

    def ref(self, cell: int) -> str:
        """Reference of the part at a cell."""
        return f"{self.letter}{cell + 1}"


@dataclass(frozen=True)
class Finger:
    """One finger, in its own sensor frame."""

    name: str
    """`"emitter"` or `"receiver"`."""
    cells_hold: AtCells
    cells: tuple[Point, ...]
    """LED or photodetector of each cell, in frame order."""
    turned: bool
    """Whether the terminals of LEDs or photodetectors lie along y instead of x."""
    holes: tuple[Point, ...]
    """Holes of the board and pins of the pocket."""
    connector: Connector
    parts: tuple[Part, ...]
    zones: tuple[Zone, ...]
    reliefs: tuple[Relief, ...]
    notch: Box
    """Opening through the plate behind the connector, to beyond the gripper end."""
    window: Box
    """Opening of mask and film over the connector."""
    ties: tuple[Tie, ...] = ()
    """Strain relief of its cable; none where there is no room."""
    finish: Finish = FINGER_FINISH

    def body_name(self, part: Part) -> str:
        """Name of a part's body in scenes: both boards have a U1."""
        return f"{self.name}.{part.name}"


@dataclass(frozen=True)
class CellInput:
    """The input that reads a cell."""

    index: int
    """Index of the cell."""
    mux: int
    channel: int


@dataclass(frozen=True)
class Reading:
    """Inputs of the cells: the layout without positions and optics."""

    design_hash: str
    pitch_mm: float
    cells: tuple[CellInput, ...]


@dataclass(frozen=True)
class Wiring:
    """Connections beyond the layout."""

    multiplexer: str
    muxes: int
    select_pins: tuple[str, ...]
    adc_pins: tuple[str, ...]
    apart: bool
    """Whether the receiver's supplies lie between its select and analog wires."""
    pulled_up_ohm: tuple[tuple[str, float], ...]
    """Pins of these that have a pull-up on the controller, with its resistance."""
    strings: tuple[tuple[int, ...], ...]
    """LEDs of each series string, by cell."""
    resistor: str
    """Package of the strings' resistors."""
    resistor_ohm: tuple[float, ...]
    """Resistor that carries the current of each string."""
    set_ohm: tuple[float, ...]
    """Resistor at the SET of each string's current source; empty without sources."""
    current_ma: tuple[float, ...]
    """Nominal current of each string."""
    supply_v: float
    pull_up_ohm: float
    own_pull_ups: bool
    """Whether each photodetector has its own pull-up; else each multiplexer has one at its
    output."""
    pull_ups: int
    emitter_pin: str | None
    """Pin of the controller that switches the LEDs, high is on; none where they are always on."""
    pull_down_ohm: float
    """From the gate of the LEDs' switch to ground."""

    @property
    def pull_down_ref(self) -> str:
        """Reference of that resistor, after those of the strings."""
        return f"R{len(self.resistor_ohm) + len(self.set_ohm) + 1}"


@dataclass(frozen=True)
class Rules:
    """Design rules of tracks, vias and gaps."""

    part_gap_mm: float
    """Between land patterns."""
    track_mm: float
    supply_track_mm: float
    copper_gap_mm: float
    via_mm: float
    via_drill_mm: float
    edge_gap_mm: float
    """Copper to the board's edge."""
    hole_gap_mm: float
    """Copper to unplated holes."""
    silk_text_mm: float
    """Height of the smallest letters that every PCB fab prints legibly."""
    silk_line_mm: float
    """Width of the thinnest lines."""
    silk_gap_mm: float
    """Silkscreen to pads."""


@dataclass(frozen=True)
class Controller:
    """The microcontroller board."""

    title: str
    """Title for documents."""
    name: str
    """Its Bluetooth name."""
    adc_bits: int
