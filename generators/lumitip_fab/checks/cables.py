"""`cables.csv`, `cables.md` and `wiring.svg` as rows of wires."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from lumitip_fab.checks.readers.tables import table
from lumitip_fab.design.cabling import COLOURS, codes_of
from lumitip_fab.errors import OutputError

_SVG = "{http://www.w3.org/2000/svg}"
_NEAR_MM = 0.01
_ROW = re.compile(
    r"^\| (W\S+) \| ([A-Z]+ [a-z ]+) \| (\S+) \| (\S+) \| (\S+) \| ([\d.]+|–) \|$", re.MULTILINE
)
_HEADING = re.compile(r"^### (W\d+): (\w+) to (\w+), ([\d.]+) mm of ([\d.]+) mm²$", re.MULTILINE)


@dataclass(frozen=True)
class Row:
    """A wire of the list."""

    wire: str
    signal: str
    start: tuple[str, str]
    """Board and pad, such as `("emitter", "J1.1")`."""
    end: tuple[str, str]
    colour: str
    section_mm2: float
    length_mm: float
    current_ma: float

    @property
    def cable(self) -> str:
        """Such as W2 of W2.3."""
        return self.wire.rpartition(".")[0]


def read_list(path: Path) -> tuple[Row, ...]:
    """The wires of `cables.csv`.

    Raises:
        OutputError: if it is missing or is no such list.
    """
    try:
        return tuple(
            Row(
                each["wire"],
                each["signal"],
                (each["from_board"], each["from_pad"]),
                (each["to_board"], each["to_pad"]),
                each["colour"],
                _section_mm2(each["section_mm2"]),
                float(each["length_mm"]),
                float(each["current_ma"]),
            )
            for each in table(path.read_text(encoding="utf-8"))
        )
    except (OSError, ValueError, KeyError) as error:
        raise OutputError(f"{path}: cannot be read as a list of cables: {error!r:.120}") from error


def _section_mm2(text: str) -> float:
    """Of a wire's copper.

    Raises:
        ValueError: if it is no figure above zero.
    """
    if not 0 < (mm2 := float(text)) < math.inf:
        raise ValueError(f"section_mm2 is {text!r}; it must be above 0")
    return mm2


def read_note(text: str) -> dict[str, tuple[str, ...]]:
    """Each wire in `cables.md`: signal, both boards with their pads, colour with its name, length,
    current."""
    heads = {name: rows for name, *rows in _HEADING.findall(text)}
    rows: dict[str, tuple[str, ...]] = {}
    for wire, colour, start, signal, end, current in _ROW.findall(text):
        boards = heads.get(wire.rpartition(".")[0], ["", "", "", ""])
        rows[wire] = (signal, boards[0], start, boards[1], end, colour, *boards[2:], current)
    return rows


def text_of(path: Path) -> str:
    """The note.

    Raises:
        OutputError: if it cannot be read.
    """
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise OutputError(f"{path}: {error}") from error


def note_row(row: Row) -> tuple[str, ...]:
    """The expected row of a wire in the note."""
    current = f"{row.current_ma:.2f}" if row.current_ma else "–"
    names = [COLOURS.get(code, ("no colour",))[0] for code in codes_of(row.colour)]
    return (
        row.signal,
        *row.start,
        *row.end,
        f"{row.colour} {' with '.join(names)}",
        f"{row.length_mm:g}",
        f"{row.section_mm2:g}",
        current,
    )


@dataclass(frozen=True)
class Drawn:
    """A wire of the diagram: the pads on which its line ends, its inks and its label."""

    start: str
    end: str
    inks: tuple[str, ...]
    label: str


def read_diagram(path: Path) -> dict[str, Drawn]:
    """The wires of `wiring.svg`, by number.

    Raises:
        OutputError: if it cannot be read.
    """
    try:
        root = ElementTree.parse(path).getroot()
        pads = dict(_pads(root))
        return {
            group.get("id", ""): _drawn(group, pads)
            for group in root.iter(f"{_SVG}g")
            if group.get("class") == "wire"
        }
    except (OSError, ElementTree.ParseError, ValueError, TypeError, LookupError) as error:
        raise OutputError(f"{path}: cannot be read as a diagram: {error!r:.120}") from error


def _pads(root: ElementTree.Element) -> Iterator[tuple[str, tuple[float, float]]]:
    for group in root.iter(f"{_SVG}g"):
        circle = group.find(f"{_SVG}circle")
        if group.get("class") == "pad" and circle is not None:
            yield group.get("id", ""), (float(circle.get("cx", "")), float(circle.get("cy", "")))


def _drawn(group: ElementTree.Element, pads: dict[str, tuple[float, float]]) -> Drawn:
    lines = [p for p in group.iter(f"{_SVG}path") if p.get("class") in ("core", "stripe")]
    numbers = [float(n) for n in re.findall(r"-?\d+(?:\.\d+)?", lines[0].get("d", ""))]
    text = group.find(f"{_SVG}text")
    return Drawn(
        _at(pads, numbers[0], numbers[1]),
        _at(pads, numbers[-2], numbers[-1]),
        tuple(line.get("stroke", "") for line in lines),
        (text.text if text is not None else None) or "",
    )


def _at(pads: dict[str, tuple[float, float]], x: float, y: float) -> str:
    found = [p for p, at in pads.items() if abs(at[0] - x) + abs(at[1] - y) < _NEAR_MM]
    return "+".join(found)
