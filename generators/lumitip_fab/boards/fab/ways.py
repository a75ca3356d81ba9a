"""How the parts of a board lie: the terminal at pad 1, and what may be turned."""

from collections.abc import Iterable, Iterator
from itertools import groupby

from lumitip_fab.boards.fab.order import TEXTS, assembled, natural
from lumitip_fab.boards.model import AT_CELLS, Placement
from lumitip_fab.design import Component
from lumitip_fab.design.packages import KNOWN, OTHER
from lumitip_fab.text import listed, passage

_DIODES = ("tvs diode", "esd diode", "schottky diode", "indicator")
_ALIKE = ("resistor", "resistor array", "capacitor", "inductor", "fuse", "crystal", "socket")
_LIES = {
    "multiplexer": "notch",
    **dict.fromkeys(("switch", "transistor", "current source", "regulator"), "dot"),
    "module": "pad",
    "header": "bar",
    **dict.fromkeys(_ALIKE, "alike"),
}
"""Name of the line by the kind of part: every kind but diodes, which have their own lines."""
MARKED_END = (*AT_CELLS, *_DIODES)
"""Kinds whose end at pad 1 is marked."""
MARKED_FIRST = tuple(kind for kind, lies in _LIES.items() if lies in ("notch", "dot", "pad"))
"""Kinds that have a mark at lead 1."""


def lying(board: Placement) -> Iterator[str]:
    """Lines on all parts that the PCB fab mounts."""
    of_cells: list[Component] = []
    rest: list[Component] = []
    for part in assembled(board):
        (of_cells if board.cells and part.kind in AT_CELLS else rest).append(part)
    if board.cells:
        chip = board.cells.part
        yield from _marked(of_cells, chip.marked, chip.mark_confidence)
    found: dict[str, list[str]] = {}
    for (_, _, lies), parts in groupby(rest, key=_kind):
        run = list(parts)
        if lies:
            found.setdefault(lies, []).append(range_of(run))
        else:
            yield from _marked(run, "cathode", run[0].mark_confidence)
    yield ""
    for lies in sorted(found, key=lambda lies: (lies == "alike", lies)):
        yield passage(TEXTS, lies).format(refs=listed(found[lies]))
    yield ""


def range_of(parts: Iterable[Component]) -> str:
    """First and last reference of parts that follow one another."""
    refs = [part.ref for part in parts]
    return refs[0] if len(refs) == 1 else f"{refs[0]} to {refs[-1]}"


def _kind(part: Component) -> tuple[str, str, str]:
    """Letters of its reference, a diode's order number, and how it lies, which of a diode its mark
    says."""
    letters, *_ = natural(part.ref)
    diode = part.kind in _DIODES
    return letters, part.part if diode else "", "" if diode else _LIES[part.kind]


def _marked(parts: list[Component], marked: str, confidence: str) -> Iterator[str]:
    """Which pad is which terminal, and how far the mark on the part itself is known; nothing of the
    latter where a band round the body shows it."""
    names = ["pads"]
    if confidence:
        names.append(confidence if confidence in KNOWN else "assumed")
    for name in names:
        yield passage(TEXTS, name).format(
            refs=range_of(parts),
            part=parts[0].part,
            maker=parts[0].manufacturer,
            marked=marked,
            other=OTHER[marked],
            confidence=confidence,
        )
