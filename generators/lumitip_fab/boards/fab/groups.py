"""Parts of a finger's board that work together: those of a string of LEDs, and the photodetectors
that a multiplexer reads."""

import re
from collections import defaultdict
from typing import Any

from lumitip_fab.boards.fab.order import bought, natural
from lumitip_fab.boards.model import AT_CELLS, Placement
from lumitip_fab.design import Component

_STRING = re.compile(r"S(\d+)_")
"""Beginning of the nets within a string."""


def groups(board: Placement, pins: tuple[str, ...]) -> list[dict[str, Any]]:
    """Name and references of each group; none of a board without cells.

    Args:
        board: with its parts.
        pins: analog inputs of the controller.
    """
    if board.cells is None:
        return []
    parts = bought(board)
    return [
        {"name": name, "refs": [part.ref for part in sorted(of, key=lambda p: natural(p.ref))]}
        for name, of in (*_strings(parts).items(), *_read(parts, pins).items())
    ]


def _strings(parts: list[Component]) -> dict[str, list[Component]]:
    found: dict[int, list[Component]] = defaultdict(list)
    for part in parts:
        numbers = {int(on[1]) for _, net in part.nets if (on := _STRING.match(net))}
        for number in numbers:
            found[number].append(part)
    return {f"string {number}": found[number] for number in sorted(found)}


def _read(parts: list[Component], pins: tuple[str, ...]) -> dict[str, list[Component]]:
    found = {}
    for mux in (part for part in parts if part.kind == "multiplexer"):
        nets = {net for _, net in mux.nets}
        pin = next(net for net in pins if net in nets)
        cells = [p for p in parts if p.kind in AT_CELLS and nets & {p.ref}]
        found[f"{mux.ref}, read at {pin}"] = cells
    return found
