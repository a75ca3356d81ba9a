"""Types of names, and the sections on boards, breakout, holder, flange, module and compliant
fingers."""

import unicodedata
from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    Field,
    ValidationError,
    ValidatorFunctionWrapHandler,
    WrapValidator,
)

from lumitip_fab.catalogue.controllers import Signal
from lumitip_fab.catalogue.record import Name, Strict
from lumitip_fab.text import LONGEST, board_name

DEVICE_BYTES = 29
"""Longest Bluetooth name (bytes): the room in one scan response."""
_JOINERS = "\u200c\u200d"
"""Invisible, but part of how some scripts and emoji are written."""


def _writable(text: str) -> str:
    """The text itself, if every character is visible and keeps the direction of writing."""
    for character in text:
        category = unicodedata.category(character)
        if category[0] == "C" or category in ("Zl", "Zp"):
            if character in _JOINERS:
                continue
            called = unicodedata.name(character, "a control character")
            raise ValueError(
                f"is {text!r:.80}, which contains U+{ord(character):04X} ({called}); letters, "
                "digits, punctuation and spaces of any script are allowed"
            )
    if not board_name(text).strip():
        raise ValueError(f"is {text!r:.80}, which has no visible character")
    return text


def _short_enough(text: str) -> str:
    size = len(text.encode())
    if size > DEVICE_BYTES:
        raise ValueError(
            f"is {text!r:.80}, {size} bytes of UTF-8; a Bluetooth name has at most {DEVICE_BYTES}"
        )
    return text


Text = Annotated[str, Field(min_length=1, max_length=LONGEST), AfterValidator(_writable)]
DeviceName = Annotated[
    str,
    Field(min_length=1, max_length=DEVICE_BYTES),
    AfterValidator(_writable),
    AfterValidator(_short_enough),
]

Size = Annotated[float, Field(ge=5, le=200)]


def _number_or(word: str, least: int, most: int) -> WrapValidator:
    """One message for a value that is neither a number within limits nor the word."""

    def valid(value: Any, handler: ValidatorFunctionWrapHandler) -> Any:
        try:
            return handler(value)
        except ValidationError:
            raise ValueError(
                f"is {value!r:.80}; {word!r} or a number from {least} to {most} is allowed"
            ) from None

    return WrapValidator(valid)


Body = Annotated[
    Annotated[float, Field(ge=20, le=200)] | Literal["gripper"], _number_or("gripper", 20, 200)
]
Angle = Annotated[Annotated[float, Field(ge=0, le=45)] | Literal["auto"], _number_or("auto", 0, 45)]


class Board(Strict):
    """Margins and zones of the two boards, which share one outline."""

    side_margin_mm: float = Field(ge=1, le=50)
    """Outermost cell centres to the board's long edges (mm)."""
    tip_margin_mm: float = Field(ge=1, le=50)
    """First row of cell centres to the board's tip edge (mm)."""
    end_margin_mm: float = Field(ge=1, le=20)
    """Connector row to the board's gripper edge (mm)."""
    hole_mm: float = Field(ge=1, le=5)
    """Diameter of the holes for the locating pins (mm)."""
    hole_edge_mm: float = Field(ge=1, le=20)
    """Centre of the holes at the tip to the board's tip edge (mm)."""
    clearance_mm: float = Field(ge=0.1, le=2)
    """Smallest gap between land patterns of neighbouring parts (mm)."""
    channel_mm: float = Field(ge=0.5, le=20)
    """Routing channel after the cells and after each row of multiplexers (mm)."""
    track_mm: float = Field(ge=0.1, le=1)
    """Width of signal tracks (mm); outside the fingers 0.2 at least."""
    supply_track_mm: float = Field(ge=0.1, le=3)
    """Width of the tracks of a supply (mm)."""
    copper_gap_mm: float = Field(ge=0.1, le=1)
    """Smallest gap between copper of different nets (mm); outside the fingers 0.2 at least."""
    via_mm: float = Field(ge=0.3, le=2)
    """Diameter of vias (mm); outside the fingers 0.6 at least."""
    via_drill_mm: float = Field(ge=0.15, le=1)
    """Hole of vias (mm); outside the fingers 0.3 at least."""
    edge_gap_mm: float = Field(ge=0.2, le=2)
    """Copper to the edge of every board (mm)."""
    connector_side: Literal["gripper"]
    """Edge of the board with the connector."""
    panel: Literal["none", "rails"]
    """Whether boards too small to be assembled alone are also ordered as a panel, with rails and
    mouse bites (`rails`); boards of polyimide never are."""


class Protection(Strict):
    """Parts between the controller's pins and the wires that leave its board."""

    diode: Name
    """ESD diode from each of these wires to ground, in `parts/esd_diodes.toml`; "none": the pins
    are joined to the wires, without resistors and capacitors too. Without a flange a breakout with
    them also has fuse, MOSFET and TVS diode at its supply, those of `[flange]`."""
    resistor: Name
    """Package of the resistors, in `parts/resistors.toml`."""
    series_ohm: float = Field(ge=10, le=1e4)
    """Resistor between each signal's wire and its pin (ohm)."""
    capacitor: Name
    """Capacitor from each analog pin to ground, in `parts/capacitors.toml`, or "none". It
    lengthens the wait after a change of channel."""


class Breakout(Strict):
    """The board that the controller plugs into, and where the cables end."""

    enabled: bool
    """Whether it is made, with its holder."""
    socket: Name
    """Socket strip in `parts/strips.toml`; one for each row of the controller's pins."""
    board_mm: tuple[Size, Size]
    """Length, along the controller, and width (mm). Where fuse, MOSFET and TVS diode are on it, it
    is 5.08 mm wider than that."""
    hole_mm: float = Field(ge=1, le=9)
    """Diameter of its two screw holes (mm)."""
    hole_spacing_mm: float = Field(ge=5, le=180)
    """From hole to hole, of the board and of its holder alike (mm)."""
    indicator: Name
    """Power LED at the controller's supply, in `parts/indicators.toml`, or "none"."""
    feed_diode: Name
    """Schottky diode between the wire that feeds the controller and its pin, in
    `parts/schottky_diodes.toml`: USB, plugged into the controller, then feeds nothing else. "none":
    they are joined, and USB feeds the robot's supply backwards."""


class Holder(Strict):
    """The printed holder that clips the breakout board to the gripper."""

    body_mm: Body
    """Diameter of the gripper's round body (mm), or "gripper": that of its entry in
    `parts/grippers.toml`, and where that is not round there is no holder."""
    clearance_mm: float = Field(ge=0, le=2)
    """Cradle to that body, and tray to the board, each side (mm)."""
    wall_mm: float = Field(ge=0.8, le=10)
    """Arms and floor of the tray (mm)."""
    wrap_deg: float = Field(ge=91, le=130)
    """How far each arm reaches round the body, from the middle of the tray: beyond 90° it clips
    on (degrees)."""
    preload_mm: float = Field(ge=0, le=3)
    """How far the body in the cradle bends each arm out: a rib along the arm's end presses on it
    (mm)."""
    standoff_mm: float = Field(ge=2, le=20)
    """Room under the board for solder tails (mm)."""
    screw: Name
    """Thread of the board's screws, in `parts/fasteners.toml`; their nuts go into the holder."""
    strap_hole_mm: float = Field(ge=1, le=10)
    """Diameter of the two holes in each arm, for screws of the gripper (mm)."""
    strap_spacing_mm: float = Field(ge=3, le=100)
    """From hole to hole (mm)."""


class Flange(Strict):
    """The flange between robot and gripper, and its board: tool contacts, 5 V, cables."""

    enabled: bool
    """Whether it is made. Where the gripper's entry does not fit `coupling`, it cannot be."""
    coupling: Name
    """Coupling below the flange, in `parts/couplings.toml`."""
    clearance_mm: float = Field(ge=0.05, le=1)
    """Board to pocket, and both parts to coupling and gripper, each side (mm)."""
    tail_mm: float = Field(ge=0, le=5)
    """Room for solder tails under the board, to which they are cut (mm)."""
    web_mm: float = Field(ge=0.8, le=10)
    """Thickness of the upper part under the gripper (mm)."""
    contacts: Name
    """Spring contacts in `parts/strips.toml`, two rows."""
    signals: tuple[Signal, ...]
    """Signal of each contact of the coupling, in the order of their numbers: `SUPPLY`, `GND`, `NC`
    of one that is left open, and names of your own for lines that a header has too. The entry in
    `parts/couplings.toml` says what each contact carries."""
    header: Name
    """Headers for cables in `parts/strips.toml`, two rows."""
    headers: tuple[tuple[Signal, ...], tuple[Signal, ...]]
    """Signals of both headers, the lower one first, left to right seen from the gripper;
    `REGULATED` is the regulator's output, `SUPPLY` is behind the fuse of the sensor, and
    `SUPPLY_IN` before it, for the gripper."""
    regulator: Name
    """Switching regulator in `parts/regulators.toml`."""
    inductor: Name
    """In `parts/inductors.toml`."""
    input_capacitor: Name
    """In `parts/capacitors.toml`."""
    output_capacitor: Name
    """In `parts/capacitors.toml`; two of them."""
    boot_capacitor: Name
    """In `parts/capacitors.toml`."""
    fuse: Name
    """In `parts/fuses.toml`."""
    transistor: Name
    """P-channel MOSFET against reversed supplies in `parts/transistors.toml`."""
    resistor: Name
    """Package of the resistors at its gate in `parts/resistors.toml`."""
    gate_ohm: float = Field(ge=1e3, le=1e6)
    """Both resistors, which halve the supply for the gate (ohm)."""
    tvs: Name
    """TVS diode from the supply to ground, in `parts/tvs_diodes.toml`."""
    inrush_resistor: Name
    """Package of the resistor before the regulator, in `parts/pulse_resistors.toml`."""
    inrush_ohm: float = Field(ge=0.1, le=1000)
    """Resistor before the regulator and its input capacitor: it limits the current as the flange
    is plugged in, and damps the ringing with the cable's inductance (ohm)."""
    indicator: Name
    """Power LED at the board's output, in `parts/indicators.toml`, or "none"."""


class Module(Strict):
    """Parts beside a controller module on the flange's board."""

    regulator: Name
    """Linear regulator of its supply, in `parts/linear_regulators.toml`."""
    supply_capacitor: Name
    """At the regulator's input and output and at the USB supply, in `parts/capacitors.toml`."""
    capacitor: Name
    """At the module's supply, in `parts/capacitors.toml`."""
    crystal: Name
    """Crystal of 32.768 kHz, in `parts/crystals.toml`."""
    crystal_capacitor: Name
    """Two of them, in `parts/capacitors.toml`."""


class Flex(Strict):
    """A compliant finger; used where `backing.variant` is `flex`."""

    thread_hole_mm: float = Field(ge=1, le=5)
    """Diameter of the holes through which the board is tied to the plate (mm)."""
    interface_mm: float = Field(ge=5, le=100)
    """Length of the rigid interface along the finger, from the gripper end (mm)."""
    pad_mm: float = Field(ge=0.4, le=10)
    """Thickness of the interface's pad, which is glued to the plate (mm)."""
    standoff_mm: float = Field(ge=0, le=10)
    """How much farther the bolts are from the board than with a rigid finger (mm)."""
    groove_mm: float = Field(ge=0.8, le=5)
    """Width of the plate's groove for the interface's rim (mm)."""
    groove_depth_mm: float = Field(ge=0.3, le=5)
    """Depth of that groove (mm)."""
    glue_mm: float = Field(ge=0.05, le=0.5)
    """Gap between rim and groove, for glue (mm)."""
    lean_deg: float = Field(ge=0, le=5)
    """Added to the gripper's tilt, because the finger gives way when it grasps (degrees)."""
