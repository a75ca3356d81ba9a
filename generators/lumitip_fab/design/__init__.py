"""`Design`: everything that is derived from the parameters, once. Types only.

Every length is in mm and in the sensor frame of the finger it belongs to, unless it says
otherwise: gripping face seen with the tip up, x to the right from the mean of the cell centres, y
towards the tip from the centre line of the columns, z out of the face from the film's outer face.
"""

from dataclasses import dataclass, replace

from lumitip.layout import Cell, Layout
from lumitip_fab.catalogue.current_sources import CurrentSource
from lumitip_fab.catalogue.electronics import (
    Chip,
    Led,
    Multiplexer,
    Photodetector,
    Resistor,
    ResistorArray,
)
from lumitip_fab.design.boards import (
    AtCells,
    Board,
    CellInput,
    Connector,
    Controller,
    Finger,
    Flexible,
    Grid,
    Part,
    Reading,
    Relief,
    Rules,
    Wiring,
    Zone,
)
from lumitip_fab.design.cabling import Cable, Cabling, Terminal, Wire
from lumitip_fab.design.clamp import Clamp
from lumitip_fab.design.electrical import Electrical
from lumitip_fab.design.feed import Feed
from lumitip_fab.design.fit_plate import FitPlate, Fits, PocketCorner
from lumitip_fab.design.gauge_card import GaugeCard, Target
from lumitip_fab.design.holder import Holder
from lumitip_fab.design.insert import Insert
from lumitip_fab.design.making import (
    Densities,
    Filament,
    HeatedPart,
    HeatStep,
    Interface,
    Letter,
    Mask,
    Printing,
    Sheet,
    Slicing,
)
from lumitip_fab.design.mould import Grip, Mould
from lumitip_fab.design.mount import (
    Closing,
    Fastener,
    Flange,
    Mount,
    Nose,
    System,
    ToolContact,
    Unsure,
)
from lumitip_fab.design.ordering import Bought, Fab, Pack, PartPrice, Purchase
from lumitip_fab.design.packages import Packages
from lumitip_fab.design.panel import Panel, PanelRules
from lumitip_fab.design.pcb import (
    AuxiliaryBoard,
    Component,
    Finish,
    Footprint,
    Note,
    Pad,
    Shroud,
    Tie,
)
from lumitip_fab.design.prop import Prop
from lumitip_fab.design.shape import Box, Cubic, Key, Outline, Point, Side, Stack, Tip
from lumitip_fab.design.strength import Strength
from lumitip_fab.design.tie_lug import TieLug
from lumitip_fab.text import board_name, page_name


@dataclass(frozen=True)
class Title:
    """Title block of drawings and boards."""

    name: str
    revision: str
    date: str = ""

    def on_boards(self) -> "Title":
        """As a silkscreen shows it."""
        return replace(self, name=board_name(self.name))

    def on_pages(self) -> "Title":
        """As a drawing and a PDF show it."""
        return replace(self, name=page_name(self.name))


@dataclass(frozen=True)
class Choice:
    """The value of an automatic field."""

    field: str
    value: str
    """As it would be written in a parameter file."""
    reason: str
    """In one line."""


@dataclass(frozen=True)
class Design:
    """A whole sensor. A generator's arguments are named after these fields."""

    title: Title
    grid: Grid
    layout: Layout
    stack: Stack
    outline: Outline
    tip: Tip
    keys: tuple[Key, ...]
    """Holes by which silicone and plate hold each other, alike for both fingers."""
    board: Board
    emitter: Finger
    receiver: Finger
    interfaces: tuple[Interface, ...]
    """Between a bendable plate and the gripper, alike for both fingers; none of rigid ones."""
    mount: Mount
    closing: Closing
    strength: Strength
    wiring: Wiring
    cabling: Cabling
    packages: Packages
    rules: Rules
    electrical: Electrical
    feed: Feed | None
    """Of the controller; none where no wire of a board feeds it."""
    mask: Mask
    mould: Mould
    clamps: tuple[Clamp, ...]
    """Holds a finger in its mould, alike for both fingers; none where there is no room for it."""
    gauge_cards: tuple[GaugeCard, ...]
    """The card by which a pair is accepted; none of compliant fingers or without room for it."""
    printing: Printing
    heat: tuple[HeatStep, ...]
    """Every step that heats something, in the order of work."""
    slicing: Slicing
    fit_plate: FitPlate
    densities: Densities
    controller: Controller
    fabs: tuple[Fab, ...]
    fasteners: tuple[Fastener, ...]
    """Every thread that holds something, once."""
    auxiliary_boards: tuple[AuxiliaryBoard, ...]
    """Boards outside the fingers."""
    panels: tuple[Panel, ...]
    """Panels of the boards that are too small to be assembled alone, if they are asked for."""
    holders: tuple[Holder, ...]
    """Holders of the breakout board; none without that board."""
    flanges: tuple[Flange, ...]
    """Printed parts round the flange's board; none without that board."""
    system: System
    purchase: Purchase
    parameters_hash: str
    choices: tuple[Choice, ...]
    """Automatic values of the parameter file, with their reasons."""

    @property
    def fingers(self) -> tuple[Finger, Finger]:
        """Both fingers, emitter first."""
        return self.emitter, self.receiver

    @property
    def threads(self) -> dict[str, Fastener]:
        """Catalogue data of each used thread."""
        return {fastener.name: fastener for fastener in self.fasteners}

    @property
    def regulated(self) -> tuple[AuxiliaryBoard, ...]:
        """The auxiliary boards with a switching regulator."""
        return tuple(auxiliary for auxiliary in self.auxiliary_boards if auxiliary.hot_loop)

    @property
    def entered(self) -> tuple[AuxiliaryBoard, ...]:
        """The auxiliary board that the supply enters through a fuse; none without it."""
        names = [plug_in.board for plug_in in self.electrical.plug_ins]
        return tuple(auxiliary for auxiliary in self.auxiliary_boards if auxiliary.name in names)

    @property
    def protecting(self) -> tuple[AuxiliaryBoard, ...]:
        """The auxiliary board with the protection of the controller's pins; none without it."""
        protection = self.electrical.protection
        return tuple(b for b in self.auxiliary_boards if protection and b.name == protection.board)

    @property
    def inserts(self) -> tuple[Insert, ...]:
        """The film on the floor of both moulds; none without it."""
        return self.mould.inserts

    @property
    def props(self) -> tuple[Prop, ...]:
        """The prop of both moulds; none where they stand level."""
        return self.mould.props

    @property
    def mould_accessories(self) -> tuple[Clamp | Prop, ...]:
        """Parts that are printed once for each mould."""
        return *self.clamps, *self.props

    @property
    def heat_steps(self) -> dict[str, HeatStep]:
        """The steps that heat something, by name."""
        return {step.name: step for step in self.heat}

    @property
    def layers(self) -> tuple[str, ...]:
        """The bodies of a finger, from the back."""
        return (
            *(("interface",) if self.interfaces else ()),
            "backing",
            "board",
            "silicone",
            "film",
        )

    @property
    def held(self) -> str:
        """The part that is bolted to the gripper."""
        return "interface" if self.interfaces else "backing"

    @property
    def cells(self) -> tuple[Cell, ...]:
        """Positions and inputs of the cells: the layout without its optics."""
        return self.layout.cells

    @property
    def reading(self) -> Reading:
        """Input of each cell."""
        cells = tuple(CellInput(c.index, c.mux, c.channel) for c in self.layout.cells)
        return Reading(self.layout.design_hash, self.layout.pitch_mm, cells)
