"""`Parameters`: everything a parameter file may say. Field docstrings become `schema.json`.

         x = 0
    ______|______        tip edge
   /      |      \
  |  .----|----.  |      shoulder (widest)
  |  | o  o  o |  |
  |  |  o   o  |  |      board, cells
  |  | o  o  o |  |
   | | parts   ||        waist (narrowest)
   | |.connect.||
   |_|__notch__|_|       gripper end
"""

import datetime
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from lumitip_fab.catalogue.record import Name, Strict
from lumitip_fab.config import sections
from lumitip_fab.config.mask import Mask

REVISION = r"^[A-Za-z0-9.\-]{1,8}$"
DATE = r"^([0-9]{4}-(0[1-9]|1[0-2])-(0[1-9]|[12][0-9]|3[01]))?$"
Gap = Annotated[float, Field(ge=0, le=20)]
Column = Annotated[int, Field(ge=1, le=256)]


class Grid(Strict):
    """The hexagonal grid of cells."""

    columns: tuple[Column, ...] = Field(min_length=1, max_length=256)
    """Cells of each column, from the left in the receiver's frame: any lengths, 3 cells or more."""
    pitch_mm: float = Field(ge=1.5, le=30)
    """Distance of a cell to each of its neighbours (mm)."""


class Stack(Strict):
    """Thickness of each layer of a finger, back to front."""

    floor_mm: float = Field(ge=0.4, le=10)
    """Floor of the pocket behind the board (mm)."""
    pcb_mm: float = Field(ge=0.1, le=3.2)
    """Board, and so the depth of its pocket where it lies in one; a flexible one is 0.11 to
    0.2 thick (mm)."""
    silicone_mm: float = Field(ge=0.5, le=10)
    """Silicone over the board (mm)."""
    film_mm: float = Field(ge=0.02, le=1)
    """Mask: thickness of the catalogue's film, or of all layers of a printed sheet (mm)."""


class Outline(Strict):
    """The silhouette of the gripping face: a smooth curve round the board."""

    tip_fraction: float = Field(ge=0.1, le=0.95)
    """Straight edge at the tip, as a fraction of the widest width."""
    tip_margin_mm: float = Field(ge=1, le=50)
    """Tip edge to the board (mm)."""
    shoulder_margin_mm: float = Field(ge=0, le=50)
    """Board edge to the outline at its widest point, on each side (mm)."""
    shoulder_at_mm: float = Field(ge=1, le=100)
    """Distance of the widest point from the tip edge (mm)."""
    waist_margin_mm: float = Field(ge=0, le=50)
    """Board edge to the outline at its narrowest point, on each side (mm)."""
    waist_at: float = Field(gt=0.3, lt=0.95)
    """Place of the narrowest point, as a fraction of the length from the tip."""
    end_margin_mm: float = Field(ge=1, le=50)
    """Board to the gripper end (mm)."""
    end_corner_mm: float = Field(ge=0.5, le=50)
    """Rounding at the corners of the gripper end; less where the wire notch needs the room (mm)."""


class Backing(Strict):
    """The printed part that carries the board."""

    variant: Literal["rigid", "flex"]
    """Rigid with a pocket for the board, or bendable: a plate, tied to a flexible board, with a
    rigid interface glued to its back (`flex`)."""
    material: Name
    """Name of a filament in `parts/filaments.toml`."""
    density_g_ml: float = Field(ge=0.5, le=3)
    """Density of that filament (g/mL)."""
    glue: Name
    """Name of a glue in `parts/adhesives.toml`, behind the board or on an interface."""
    flare_mm: float = Field(ge=1, le=200)
    """How far the coupling's 45° ramp flares out along the back, beyond where it would end (mm)."""
    flare_depth_mm: float = Field(ge=0.5, le=40)
    """Height over the plate's back at which the ramp turns into its flare (mm)."""
    key_mm: float = Field(ge=0, le=5)
    """Diameter of the countersunk holes through the plate beside the board, by which the silicone
    holds on (mm); 0 for none."""
    pocket_clearance_mm: float = Field(ge=0.10, le=0.30)
    """Gap between board and pocket on each side (mm)."""
    pin_clearance_mm: float = Field(ge=0.05, le=0.5)
    """Gap between a locating pin and its hole in the board, all round (mm)."""
    relief_clearance_mm: float = Field(ge=0.2, le=3)
    """Gap between a part on the back of the board and its relief, on each side (mm)."""
    tail_mm: float = Field(ge=0.5, le=5)
    """Room behind the board for solder tails and wires (mm)."""


class Finger(Strict):
    """The load that a finger bears."""

    rated_force_n: float = Field(ge=0.1, le=1000)
    """Force at the tip of each finger that it bears with all reserves, towards its back or
    sideways (N)."""
    bend_fraction: float = Field(gt=0, le=0.5)
    """Most that the tip may bend under that force, as a fraction of the finger's length."""


class Tip(Strict):
    """The wedge on the back of the tip that slides under cloth."""

    angle_deg: sections.Angle
    """Angle between the back of the plate and the wedge (°), 0 for none. "auto": that of start and
    edge."""
    slant_start_mm: float = Field(ge=0.5, le=50)
    """Distance from the tip edge at which the back begins to slant (mm)."""
    edge_mm: float = Field(ge=0.2, le=5)
    """Thickness left at the tip edge (mm)."""


class Coupling(Strict):
    """Coupling of finger and gripper."""

    gripper: Name
    """Name of a gripper in `parts/grippers.toml`."""


class Emitter(Strict):
    """The finger that shines."""

    led: Name
    """Name of an LED in `parts/leds.toml`."""
    current_ma: float = Field(ge=0.1, le=1000)
    """Target current of each string of LEDs (mA)."""
    string_leds: int = Field(ge=1, le=64)
    """Most LEDs in a string; behind a resistor fewer make its current depend less on supply and
    LEDs."""
    max_heat_w: float = Field(ge=0.05, le=20)
    """Most heat that LEDs, sources and resistors may leave in the finger (W)."""
    drive: Literal["source", "resistor"]
    """How the current of a string is set: a current source, which holds it whatever supply and
    temperature do, or a resistor."""
    source: Name
    """Name of a current source in `parts/current_sources.toml`."""
    resistor: Name
    """Package of the strings' resistors in `parts/resistors.toml`."""
    resistor_side: Literal["front", "back"]
    """Side of the board that carries the strings' resistors; those of current sources stand on the
    front."""
    switch: Name
    """N-channel MOSFET in `parts/transistors.toml` with which the controller turns the LEDs off, so
    that ambient light is subtracted; "none": they are always on."""


class Receiver(Strict):
    """The finger that sees."""

    photodetector: Name
    """Name of a photodetector in `parts/photodetectors.toml`."""
    multiplexer: Name
    """Name of a multiplexer in `parts/multiplexers.toml`."""
    load: Literal["each", "shared"]
    """Pull-ups: one for each photodetector, always connected, or one for each multiplexer."""
    pull_up_ohm: float = Field(ge=1e3, le=1e7)
    """Each pull-up (ohm)."""
    array: Name
    """Chip of the photodetectors' own pull-ups in `parts/resistor_arrays.toml`."""
    resistor: Name
    """Package of shared pull-ups in `parts/resistors.toml`."""
    capacitor: Name
    """Name of the capacitor at each multiplexer's supply in `parts/capacitors.toml`."""
    bulk_capacitor: Name
    """Capacitor beside the supply's wire, in `parts/capacitors.toml`, or "none"."""


class Controller(Strict):
    """The microcontroller that reads the receiver."""

    board: Name
    """Name of a controller in `parts/controllers.toml`, for the breakout or the flange's board."""
    name: sections.DeviceName
    """Bluetooth name of the device, in any script: at most 29 bytes of UTF-8, a scan response."""


class Supply(Strict):
    """Supply of the emitter, from the robot."""

    voltage_v: float = Field(gt=2, le=48)
    """Supply voltage (V)."""
    max_ma: float = Field(ge=0.1, le=5000)
    """Largest current that may be drawn for the LEDs (mA)."""


class Cables(Strict):
    """The wires from the fingers to supply and controller."""

    supply_mm: float = Field(ge=20, le=10000)
    """To the flange or a supply: from the controller's breakout, or from the fingers' gripper end
    where there is none (mm)."""
    controller_mm: float = Field(ge=20, le=2000)
    """Along the gripper, from the fingers' gripper end to the controller or its breakout (mm)."""
    slack_mm: float = Field(ge=0, le=1000)
    """Added to every wire for bends, stripping and strain relief (mm)."""
    section_mm2: float = Field(ge=0.01, le=2)
    """Copper of each wire, at least; what carries more current is thicker. 0.08 is AWG 28 (mm²)."""
    order: Literal["apart", "published"]
    """Wires of the receiver: `"apart"`, with the supplies between select and analog lines, or as
    published, with the last select line beside the first analog one."""


class Mould(Strict):
    """The mould in which the silicone is cast on a finger."""

    silicone: Name
    """Name of a silicone in `parts/silicones.toml`."""
    primer: Name
    """Name of a primer in `parts/primers.toml`, under the silicone; or `"none"`."""
    tape: Name
    """Name of a tape in `parts/tapes.toml`, which closes windows while the silicone is cast."""
    insert: Name
    """Name of a smooth film in `parts/films.toml`, which lies on the mould's floor in front of the
    cells, so that the silicone's face is as smooth; or `"none"`."""
    taper_length_mm: float = Field(ge=0.5, le=3.9)
    """Distance from the tip edge over which the silicone thins; the fingers touch first where it
    ends, at most 4 mm from the tip (mm)."""
    tip_silicone_mm: float = Field(ge=0.05, le=5)
    """Silicone left at the tip edge (mm)."""
    tip_lip_mm: float = Field(ge=0, le=2)
    """Silicone on the back of the tip edge, at least: the skin is wrapped round the tip, where
    plate and mould have room. 0: it ends at the edge (mm)."""
    wall_gap_mm: float = Field(ge=0.12, le=0.28)
    """Gap between the plate's rim and the mould's wall (mm)."""
    draft_deg: float = Field(ge=2, le=20)
    """Opening of the wall above the rim (degrees from the pull direction)."""
    wall_mm: float = Field(ge=1, le=20)
    """Wall and floor of the mould (mm)."""
    waste_fraction: float = Field(ge=0, le=2)
    """Silicone to mix beyond what the mould takes, as a fraction."""


class Printer(Strict):
    """The printer that makes the parts."""

    profile: Name
    """Name of a printer in `parts/printers.toml`."""
    min_wall_mm: float = Field(ge=0.2, le=5)
    """Thinnest wall that prints well (mm)."""
    fit_mm: float = Field(ge=-0.1, le=0.1)
    """Reading of the fit test plate: added to every gap between printed parts and boards, metal and
    gripper, and round the rim that a compliant finger is glued by, on each side; above zero all
    sits looser (mm)."""


def _in_calendar(date: str) -> str:
    try:
        return date and datetime.date.fromisoformat(date).isoformat()
    except ValueError:
        raise ValueError(f"is {date!r}; the calendar has no such day") from None


class Parameters(Strict):
    """A whole parameter file."""

    name: sections.Text
    """Name of the design, in any script; transliterated where a board or a page lacks its
    letters."""
    revision: Annotated[str, Field(pattern=REVISION)]
    """Revision of the design, on boards and drawings."""
    date: Annotated[str, Field(pattern=DATE), AfterValidator(_in_calendar)]
    """Date of the revision, such as "2026-11-28", in the title blocks of boards and schematics;
    empty for none. It is yours to change: the same file gives the same bytes on each day."""
    grid: Grid
    stack: Stack
    outline: Outline
    backing: Backing
    flex: sections.Flex
    finger: Finger
    tip: Tip
    coupling: Coupling
    board: sections.Board
    emitter: Emitter
    receiver: Receiver
    controller: Controller
    protection: sections.Protection
    supply: Supply
    wiring: Cables
    mask: Mask
    mould: Mould
    breakout: sections.Breakout
    holder: sections.Holder
    flange: sections.Flange
    module: sections.Module
    printer: Printer
