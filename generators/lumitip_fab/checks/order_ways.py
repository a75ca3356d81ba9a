"""How the parts of a board lie, by its file: the lines that an assembly note must have on it."""

import re
from collections.abc import Iterator
from itertools import groupby

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.readers.kicad_board import Part
from lumitip_fab.design.packages import KNOWN, OTHER
from lumitip_fab.text import listed, passage

TEXTS = "boards/fab/notes.txt"
"""Wording that both notes share with whoever writes them; the figures in it come from the board."""
_DIODES = ("DIO", "LED")
_LIES = {
    **{"SOP": "notch", "SOT": "dot", "Module": "pad", "Header": "bar"},
    **dict.fromkeys(("RESC", "CAPC", "INDC", "FUSC", "XTAL", "PinSocket"), "alike"),
}
"""Name of the line by the beginning of a land pattern's name."""


def lying(read: ReadBoard) -> Iterator[str]:
    """The lines on polarity and on leads, of all parts that a fab mounts."""
    mounted = read.assembled()
    parts = sorted((part for part in read.board.parts if part.ref in mounted), key=_place)
    at_cells = [part for part in parts if at_cell(read, part)]
    if read.finger:
        chip = read.design.packages.at_cells(read.finger)
        yield from _marked(read, at_cells, chip.marked, chip.mark_confidence)
    found: dict[str, list[str]] = {}
    confidence = {part.ref: part.mark_confidence for part in read.components}
    rest = (part for part in parts if part not in at_cells)
    for (_, _, lies), same in groupby(rest, key=lambda part: _kind(read, part)):
        run = list(same)
        if lies:
            found.setdefault(lies, []).append(_range(run))
        else:
            yield from _marked(read, run, "cathode", confidence.get(run[0].ref, ""))
    for lies, runs in found.items():
        known = lies in _LIES.values()
        text = passage(TEXTS, lies) if known else f"{{refs}}: unknown land pattern {lies}"
        yield text.format(refs=listed(runs))


def at_cell(read: ReadBoard, part: Part) -> bool:
    """Whether a part is an LED or a photodetector at a cell."""
    if not read.finger:
        return False
    return bool(re.fullmatch(rf"{read.finger.cells_hold.letter}\d+(_\d+)?", part.ref)) and (
        read.ordered(part.ref)[0] == read.design.packages.at_cells(read.finger).order_number
    )


def _place(part: Part) -> tuple[str, int, int]:
    """Letters, number and copy of a reference."""
    letters, number, copy = re.findall(r"^([A-Z]+)(\d+)(?:_(\d+))?$", part.ref)[0]
    return letters, int(number), int(copy or 0)


def _kind(read: ReadBoard, part: Part) -> tuple[str, str, str]:
    """Parts of one line, or of one range of it, share letters, a diode's order number, and how they
    lie."""
    letters, *_ = _place(part)
    if part.footprint.startswith(_DIODES):
        return letters, read.ordered(part.ref)[0], ""
    fits = [lies for start, lies in _LIES.items() if part.footprint.startswith(start)]
    return letters, "", fits[0] if fits else part.footprint


def _marked(read: ReadBoard, parts: list[Part], marked: str, confidence: str) -> Iterator[str]:
    """The lines on a part with a mark: its pads, and how far the mark is known."""
    second = confidence if confidence in KNOWN else "assumed"
    for name in ("pads", second) if confidence else ("pads",):
        yield passage(TEXTS, name).format(
            refs=_range(parts),
            part=read.ordered(parts[0].ref)[0],
            maker=dict(parts[0].fields).get("Manufacturer", ""),
            marked=marked,
            other=OTHER[marked],
            confidence=confidence,
        )


def _range(parts: list[Part]) -> str:
    """First and last reference."""
    return " to ".join(dict.fromkeys((parts[0].ref, parts[-1].ref)))
