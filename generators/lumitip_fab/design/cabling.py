"""The wires between the boards, from the fingers to the supply, and the colours of their
insulation."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from lumitip_fab.design.pcb import AuxiliaryBoard, Component

COLOURS = {
    "BK": ("black", "#1a1a1a"),
    "BN": ("brown", "#8a5a2b"),
    "RD": ("red", "#d11f2e"),
    "OG": ("orange", "#f07d13"),
    "YE": ("yellow", "#e6c200"),
    "GN": ("green", "#1f9d48"),
    "BU": ("blue", "#2463c4"),
    "VT": ("violet", "#8446b0"),
    "GY": ("grey", "#8d949b"),
    "WH": ("white", "#ffffff"),
    "PK": ("pink", "#f09bb8"),
    "TQ": ("turquoise", "#2bb9b4"),
}
"""Name and ink of each colour, by its code."""


INPUT_END = "_IN"
"""Ends the name of the net of the contacts' supply before the fuse, such as `24V_IN`."""
INSULATION_MM = ((1.31, 0.38), (math.inf, 0.51))
"""Thickness up to a section (mm²): 15 mils of PVC to AWG 16, 20 beyond, as in UL's AWM style 10236.
That the wire is of such a kind is assumed."""
STRANDED = 1.15  # diameter of strands over that of solid copper of the same section


THREAD_MM = 0.5
"""Waxed thread of the strain relief: the product in `packs.toml`."""

STRIP_MM = 4.0
"""Bare end of a wire: through a board, with what is cut off above the joint (assumed)."""

SLOT_MM, SLOT_MM2, SLOT_A = 1.25, 0.09, 1.0
"""Insulation, section and current, at most, of a wire in a socket for flat cable, whose slots are
1.27 mm apart and made for AWG 28. Insulation and section are assumed: the maker's drawing was not
read. The current is the rule of thumb for such cable and its sockets in "Ribbon Cable Current
Rating" of Mosaic Industries."""


def outer_mm(section_mm2: float) -> float:
    """Diameter of a wire with its insulation."""
    wall = next(thick for most, thick in INSULATION_MM if section_mm2 <= most)
    return STRANDED * math.sqrt(4 * section_mm2 / math.pi) + 2 * wall


def awg(section_mm2: float) -> int:
    """The even gauge nearest to a section, by ASTM B258: the trade's equivalent."""
    diameter_mm = math.sqrt(4 * section_mm2 / math.pi)
    return 2 * round((36 - 39 * math.log(diameter_mm / 0.127, 92)) / 2)


def codes_of(colour: str) -> tuple[str, ...]:
    """The codes in a colour such as `"GN"` or, striped, `"WHGN"`: ground first."""
    return tuple(colour[i : i + 2] for i in range(0, len(colour), 2))


def named(colour: str) -> str:
    """A colour in words, such as `"green"` or `"white with green"`."""
    return " with ".join(COLOURS[code][0] for code in codes_of(colour))


@dataclass(frozen=True)
class Terminal:
    """End of a wire."""

    board: str
    """`"emitter"`, `"receiver"`, an auxiliary board, `"controller"` or `"supply"`."""
    connector: str
    """Such as `"J1"`; empty where a board has single pins."""
    pin: str
    """Number of the pad, or name of the pin."""
    name: str
    """Text printed there."""
    order: int
    """Its place among the pins of that connector, from 1."""

    @property
    def label(self) -> str:
        """Such as `"J1.3"`, or the pin alone."""
        return f"{self.connector}.{self.pin}" if self.connector else self.pin


@dataclass(frozen=True)
class Wire:
    """A wire with both its ends."""

    number: str
    """Unique, such as `"W2.3"`: the third wire of the second cable."""
    signal: str
    """Its net."""
    start: Terminal
    end: Terminal
    colour: str
    """Codes of IEC 60757, such as `"GN"` or `"WHGN"`."""
    current_ma: float
    """Largest; 0 of signals."""


@dataclass(frozen=True)
class Cable:
    """Wires that run together."""

    name: str
    least_mm: float
    """Least length: its path and the slack."""
    length_mm: float
    """To cut each wire to."""
    added_mm: float
    """More than the least length, rounded up: until no bend is too tight."""
    section_mm2: float
    """Copper of each wire."""
    wires: tuple[Wire, ...]

    @property
    def start(self) -> Terminal:
        """One end of its first wire."""
        return self.wires[0].start

    @property
    def end(self) -> Terminal:
        """The other end of its first wire."""
        return self.wires[0].end


@dataclass(frozen=True)
class Loop:
    """The part of a finger's cable that moves with it, from the tie at the finger to the place
    where it is held along the gripper."""

    cable: str
    run_mm: float
    """Between both ends along the tool axis."""
    length_mm: float
    radius_mm: float
    """The smallest bend radius while the gripper closes and opens, estimated."""
    at_mm: float
    """How far the finger is from closed where that is."""
    outer_mm: float
    """Diameter of one of its wires, with its insulation."""
    least_mm: float
    """The smallest radius that it may have."""


@dataclass(frozen=True)
class Cabling:
    """All cables, and the parts of their lengths."""

    cables: tuple[Cable, ...]
    loops: tuple[Loop, ...]
    """Of each cable that moves with a finger."""
    travel_mm: float
    """Travel of a finger, from closed to open."""
    supply_mm: float
    """Way to the supply: from the controller's breakout, or from the fingers where it has none."""
    controller_mm: float
    """From the fingers' gripper end to the controller."""
    beyond_mm: float
    """So much farther the emitter's cable goes: its pads are at the breakout's other end."""
    slack_mm: float
    step_mm: float
    """Lengths are multiples of it."""
    most_a_per_mm2: float
    """Largest current density."""
    bend_ratio: float
    """Least bend radius of a moving wire, by its outer diameter."""
    most_drop: float
    """Largest drop of voltage over the wires, both ways, as a share of the LEDs' supply."""


def front_headers(board: AuxiliaryBoard) -> list[Component]:
    """Headers of a board that cables are plugged into."""
    return [part for part in board.components if part.kind == "header" and part.side == "front"]


def plugged_headers(
    cables: Iterable[Cable], auxiliary_boards: Iterable[AuxiliaryBoard]
) -> list[str]:
    """References of the flange's headers that a cable is plugged into, sorted."""
    wires = (wire for cable in cables for wire in cable.wires)
    ends = {wire.end.connector for wire in wires if wire.end.board == "flange"}
    flanges = (board for board in auxiliary_boards if board.name == "flange")
    headers = {part.ref for board in flanges for part in board.components if part.kind == "header"}
    return sorted(ends & headers)
