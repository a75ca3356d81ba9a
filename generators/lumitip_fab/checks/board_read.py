"""`ReadBoard`: a board as its file has it, in the frame of its finger or its own."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.connections import Clusters
from lumitip_fab.checks.readers.kicad_board import Copper, KicadBoard, Part, Terminal, read_board
from lumitip_fab.checks.result import Subject
from lumitip_fab.design import (
    AtCells,
    AuxiliaryBoard,
    Box,
    Component,
    Design,
    Finger,
    Flexible,
    Pad,
    Point,
    Resistor,
    ResistorArray,
    Tie,
)
from lumitip_fab.design.frames import applied, board_page_to_sensor, on_board_page
from lumitip_fab.errors import OutputError

_VALUE = re.compile(r"(\d+)([RKM])(\d*)")
_CLOSED_MM = 1e-5  # ends of lines nearer than this meet
_POWER = {"R": 1.0, "K": 1e3, "M": 1e6}


def lands(board: KicadBoard, layer: str = "") -> Iterator[tuple[Part, Terminal, Copper]]:
    """Every pad that has copper, or copper on a layer, with its part."""
    for part in board.parts:
        for terminal in part.terminals:
            copper = terminal.copper
            if copper is not None and (not layer or layer in copper.layers):
                yield part, terminal, copper


@dataclass(frozen=True, eq=False)
class ReadBoard(Subject):
    """A board file with what it should be.

    What only some boards have is empty, or none, on the others.
    """

    board: KicadBoard
    design: Design
    of: Finger | AuxiliaryBoard
    """Its record in the design. The frame of a board beside the fingers is its own."""

    @property
    def finger(self) -> Finger | None:
        """The finger that it is in."""
        return self.of if isinstance(self.of, Finger) else None

    @property
    def auxiliary(self) -> AuxiliaryBoard | None:
        """The board beside the fingers."""
        return self.of if isinstance(self.of, AuxiliaryBoard) else None

    @property
    def name(self) -> str:
        """Name of its folder and its files."""
        return self.of.name

    @property
    def box(self) -> Box:
        """The box round its outline."""
        return self.auxiliary.box if self.auxiliary else self.design.board.box

    @property
    def hole_mm(self) -> float:
        """Diameter of its unplated holes."""
        return self.auxiliary.hole_mm if self.auxiliary else self.design.board.hole_mm

    @property
    def copy_ends(self) -> tuple[str, str]:
        """Ends of the references in its first and last copy; empty on a board by itself."""
        return "", ""

    @property
    def cells_hold(self) -> AtCells | None:
        """The parts at its cells."""
        return self.finger.cells_hold if self.finger else None

    @property
    def signals(self) -> tuple[str, ...]:
        """Signals at the pads of its cable, in their order."""
        return self.finger.connector.signals if self.finger else ()

    @property
    def supply(self) -> str:
        """Signal that feeds a finger's board, beside ground."""
        return self.finger.connector.supply if self.finger else ""

    @property
    def strings(self) -> tuple[tuple[int, ...], ...]:
        """LEDs of each of its series strings, by cell."""
        lit = self.cells_hold is not None and self.cells_hold.kind == "led"
        return self.design.wiring.strings if lit else ()

    @property
    def muxes(self) -> int:
        """Number of its multiplexers."""
        read = self.cells_hold is not None and self.cells_hold.kind == "photodetector"
        return self.design.wiring.muxes if read else 0

    @property
    def flexible(self) -> Flexible | None:
        """Its layers and its bend, if it bends."""
        return self.design.board.flexible if self.finger else None

    @property
    def components(self) -> tuple[Component, ...]:
        """Its parts, where the design has their places."""
        return self.auxiliary.components if self.auxiliary else ()

    @property
    def ties(self) -> tuple[Tie, ...]:
        """Strain relief of its cables."""
        return self.of.ties

    @property
    def screws(self) -> tuple[Terminal, ...]:
        """Unplated holes as wide as those for screws or pins; the others are for threads."""
        least = (self.hole_mm + max((tie.hole_mm for tie in self.ties), default=0.0)) / 2
        return tuple(hole for hole in self.holes if hole.drill_mm > least)

    @property
    def threads(self) -> tuple[Terminal, ...]:
        """The other unplated holes."""
        return tuple(hole for hole in self.holes if hole not in self.screws)

    @cached_property
    def clusters(self) -> Clusters:
        """Copper in connected groups."""
        return Clusters(self.board)

    @cached_property
    def parts(self) -> dict[str, Part]:
        """Parts by reference."""
        return {part.ref: part for part in self.board.parts}

    @cached_property
    def outline(self) -> BaseGeometry:
        """The board by its drawn edge, on the page."""
        edges = shapely.set_precision(np.array(self.board.edges, dtype=object), _CLOSED_MM)
        rings = shapely.polygonize([shapely.union_all(edges)])
        return shapely.union_all(shapely.get_parts(rings))

    @cached_property
    def holes(self) -> tuple[Terminal, ...]:
        """Unplated holes."""
        return tuple(
            t
            for part in self.board.parts
            for t in part.terminals
            if t.copper is None and t.drill_mm
        )

    def sensor(self, points: Any) -> NDArray[np.float64]:
        """Places on the page, in the sensor frame; shape `(n, 2)`."""
        flat = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        return applied(board_page_to_sensor(self.design.stack), flat)[:, :2]

    def group(self, ref: str, number: str | int) -> int | None:
        """The connected group of a part's pad; none where there is no such pad."""
        part = self.parts.get(ref)
        for terminal in part.terminals if part else ():
            if terminal.number == str(number) and terminal.copper is not None:
                return self.clusters.of(terminal.copper)
        return None

    def wire(self, signal: str) -> int | None:
        """The group of a signal at the cable, by the place of its pad in the row."""
        return self.group("J1", self.signals.index(signal) + 1) if signal in self.signals else None

    def assembled(self) -> set[str]:
        """References of the parts on the board that a PCB fab is to mount: all that are bought but
        those that the catalogue says are soldered on by hand."""
        by_hand = {device.ref for device in self.components if device.hand_soldered}
        return {part.ref for part in self.board.parts if part.bought} - by_hand

    def ordered(self, ref: str) -> tuple[str, str]:
        """Order number of a part and its number at LCSC from the catalogue, the latter empty where
        it is not known; a resistor's value is read from the board."""
        if not self.finger:
            parts = ((d.part, d.lcsc) for d in self.components if d.ref == ref)
            return next(parts, ("", ""))
        packages, part = self.design.packages, self.parts.get(ref)
        in_string = self.strings and ref != self.design.wiring.pull_down_ref
        if self.strings and packages.switch is not None and ref == "Q1":
            return packages.switch.order_number, packages.switch.lcsc
        if packages.bulk is not None and ref == f"C{self.muxes + 1}":
            return packages.bulk.order_number, packages.bulk.lcsc
        entries = {
            self.finger.cells_hold.letter: packages.at_cells(self.finger),
            "U": packages.source if self.strings else packages.multiplexer,
            "C": packages.capacitor,
            "R": packages.string_resistor if in_string else packages.pull_up,
        }
        entry = packages.array if ref.startswith("RN") else entries.get(ref[:1])
        if entry is None:
            return "", ""
        value = part.value if part else "?"
        if isinstance(entry, Resistor | ResistorArray):
            return entry.part(value), entry.lcsc_of(value)
        return entry.order_number, entry.lcsc


def names_of(design: Design) -> tuple[str, ...]:
    """Names of all boards: fingers first."""
    return (*(f.name for f in design.fingers), *(c.name for c in design.auxiliary_boards))


def path_of(name: str) -> str:
    """Path of a board's file below the output folder."""
    return f"boards/{name}/{name}.kicad_pcb"


def read_any(outputs: Path, design: Design, name: str) -> ReadBoard:
    """A board by its name.

    Raises:
        OutputError: if its file cannot be read.
        LookupError: if the design has no such board.
    """
    boards: tuple[Finger | AuxiliaryBoard, ...] = (*design.fingers, *design.auxiliary_boards)
    for of in boards:
        if of.name == name:
            board = read_board(outputs / path_of(name))
            return ReadBoard("board", path_of(name), board, design, of)
    raise LookupError(f"no board {name!r}")


def read_closed(outputs: Path, design: Design, name: str) -> ReadBoard:
    """A board by its name, with its outline.

    Raises:
        OutputError: if its file cannot be read, or has no closed edge.
        LookupError: if the design has no such board.
    """
    read = read_any(outputs, design, name)
    if read.outline.is_empty:
        raise OutputError("the board has no closed edge")
    return read


def on_page(box: Box) -> shapely.Polygon:
    """An area of a board on KiCad's page."""
    left, low = on_board_page((box.x_min_mm, box.y_max_mm))
    right, high = on_board_page((box.x_max_mm, box.y_min_mm))
    return shapely.box(left, low, right, high)


def placed(device: Component, land: Pad) -> Point:
    """Place of a part's pad on its board."""
    turn = math.radians(device.angle_deg)
    c, s = math.cos(turn), math.sin(turn)
    x = -land.x_mm if device.side == "back" else land.x_mm
    return (device.x_mm + x * c - land.y_mm * s, device.y_mm + x * s + land.y_mm * c)


def ohm(value: str) -> float:
    """Resistance of a value such as 150R or 4K99; NaN of any other text."""
    match = _VALUE.fullmatch(value)
    return float(f"{match[1]}.{match[3] or 0}") * _POWER[match[2]] if match else math.nan


def middle(part: Part | None) -> Point:
    """The middle of a part's pads on the page; NaN of none."""
    if part is None or not part.terminals:
        return math.nan, math.nan
    x, y = np.mean([t.at for t in part.terminals], axis=0)
    return float(x), float(y)
