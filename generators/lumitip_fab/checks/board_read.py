"""`Read` and `ReadAuxiliary`: a board as its file has it, in the frame of its finger or its own."""

import math
import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.readers.copper import Clusters
from lumitip_fab.checks.readers.kicad_board import KicadBoard, Part, Terminal, read_board
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import (
    AuxiliaryBoard,
    Design,
    Finger,
    Point,
    Resistor,
    ResistorArray,
    Tie,
)
from lumitip_fab.design.frames import applied, board_page_to_sensor

_VALUE = re.compile(r"(\d+)([RKM])(\d*)")
_CLOSED_MM = 1e-5  # ends of lines nearer than this meet
_POWER = {"R": 1.0, "K": 1e3, "M": 1e6}


@dataclass(frozen=True, eq=False)
class ReadBoard:
    """A board file with what it should be."""

    subject: str
    board: KicadBoard
    design: Design

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

    @property
    def ties(self) -> tuple[Tie, ...]:
        """Strain relief by the design."""
        raise NotImplementedError

    @property
    def screw_mm(self) -> float:
        """Diameter of the holes for screws or pins by the design."""
        raise NotImplementedError

    @property
    def screws(self) -> tuple[Terminal, ...]:
        """Unplated holes as wide as those for screws or pins; the others are for threads."""
        least = (self.screw_mm + max((tie.hole_mm for tie in self.ties), default=0.0)) / 2
        return tuple(hole for hole in self.holes if hole.drill_mm > least)

    @property
    def threads(self) -> tuple[Terminal, ...]:
        """The other unplated holes."""
        return tuple(hole for hole in self.holes if hole not in self.screws)

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

    def figure(
        self, check: str, measured: float, low: float, high: float, unit: str = "mm", note: str = ""
    ) -> Measurement:
        """A measurement of this file."""
        return Measurement(f"board.{check}", self.subject, float(measured), low, high, unit, note)

    def count(self, check: str, wrong: list[str], unit: str) -> Measurement:
        """How many things are wrong, of which there may be none; the first few are named."""
        note = "; ".join(wrong[:4]) + (" …" if len(wrong) > 4 else "")
        return self.figure(check, len(wrong), 0, 0, unit, note)


@dataclass(frozen=True, eq=False)
class Read(ReadBoard):
    """The board of a finger."""

    finger: Finger

    @property
    def name(self) -> str:
        """Name of its folder and its files."""
        return self.finger.name

    @property
    def ties(self) -> tuple[Tie, ...]:
        """Strain relief by the design."""
        return self.finger.ties

    @property
    def screw_mm(self) -> float:
        """Diameter of the holes for the locating pins by the design."""
        return self.design.board.hole_mm

    def wire(self, signal: str) -> int | None:
        """The group of a signal at the connector, by the place of its pad in the row."""
        signals = self.finger.connector.signals
        return self.group("J1", signals.index(signal) + 1) if signal in signals else None

    def ordered(self, ref: str) -> tuple[str, str]:
        """Order number of a part and its number at LCSC from the catalogue, the latter empty where
        it is not known; a resistor's value is read from the board."""
        packages, part = self.design.packages, self.parts.get(ref)
        lights = self.finger.cells_hold.kind == "led"
        entries = {
            self.finger.cells_hold.letter: packages.at_cells(self.finger),
            "U": packages.multiplexer,
            "C": packages.capacitor,
            "R": packages.string_resistor if lights else packages.pull_up,
        }
        entry = packages.array if ref.startswith("RN") else entries.get(ref[:1])
        if entry is None:
            return "", ""
        value = part.value if part else "?"
        if isinstance(entry, Resistor | ResistorArray):
            return entry.part(value), entry.lcsc_of(value)
        return entry.order_number, entry.lcsc


@dataclass(frozen=True, eq=False)
class ReadAuxiliary(ReadBoard):
    """An auxiliary board; its own frame stands for the sensor frame."""

    auxiliary: AuxiliaryBoard

    @property
    def name(self) -> str:
        """Name of its folder and its files."""
        return self.auxiliary.name

    @property
    def ties(self) -> tuple[Tie, ...]:
        """Strain relief by the design."""
        return self.auxiliary.ties

    @property
    def screw_mm(self) -> float:
        """Diameter of the screw holes by the design."""
        return self.auxiliary.hole_mm

    def ordered(self, ref: str) -> tuple[str, str]:
        """Order number of a part and its number at LCSC, which is empty where it is not known."""
        parts = ((d.part, d.lcsc) for d in self.auxiliary.components if d.ref == ref)
        return next(parts, ("", ""))


def names_of(design: Design) -> tuple[str, ...]:
    """Names of all boards: fingers first."""
    return (*(f.name for f in design.fingers), *(c.name for c in design.auxiliary_boards))


def path_of(name: str) -> str:
    """Path of a board's file below the output folder."""
    return f"boards/{name}/{name}.kicad_pcb"


def read_any(outputs: Path, design: Design, name: str) -> Read | ReadAuxiliary:
    """The board of a finger, or one beside the fingers.

    Raises:
        OutputError: if its file cannot be read.
        LookupError: if the design has no such board.
    """
    for finger in design.fingers:
        if finger.name == name:
            return Read(path_of(name), read_board(outputs / path_of(name)), design, finger)
    return read_auxiliary(outputs, design, name)


def read_auxiliary(outputs: Path, design: Design, name: str) -> ReadAuxiliary:
    """An auxiliary board.

    Raises:
        OutputError: if its file cannot be read.
        LookupError: if the design has no such auxiliary board.
    """
    auxiliary = next(
        (auxiliary for auxiliary in design.auxiliary_boards if auxiliary.name == name), None
    )
    if auxiliary is None:
        raise LookupError(f"no auxiliary board {name!r}")
    return ReadAuxiliary(path_of(name), read_board(outputs / path_of(name)), design, auxiliary)


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
