"""The wires of the list of cables, and where they lead on the board of the controller."""

from collections.abc import Sequence
from dataclasses import dataclass

from lumitip_fab.checks.readers.kicad_board import KicadBoard, Part
from lumitip_fab.site.folder import CABLES, Folder


@dataclass(frozen=True)
class Way:
    """From the far end of a wire to the controller."""

    steps: tuple[str, ...]
    """A resistor in series, if there is one, and pads of sockets."""
    nets: tuple[str, ...]
    """The copper on the way, as `board:net`."""
    parts: tuple[str, ...]
    """Resistors on the way, as `board.reference`."""


class Wires:
    """The list of cables."""

    def __init__(self, folder: Folder) -> None:
        self.rows = folder.rows(CABLES)
        auxiliary = (board.name for board in folder.design.auxiliary_boards)
        self._boards = {name: folder.board(name) for name in auxiliary}

    def of(self, board: str, signal: str) -> dict[str, str] | None:
        """The wire that carries a signal from a board."""
        found = (r for r in self.rows if (r["from_board"], r["signal"]) == (board, signal))
        return next(found, None)

    def way(self, wire: dict[str, str]) -> Way:
        """From the far end of a wire to the controller; empty where it ends at no board."""
        board = self._boards.get(wire["to_board"])
        if board is None:
            return Way((), (), ())
        ref, _, pad = wire["to_pad"].partition(".")
        found = (t.net for p in board.parts if p.ref == ref for t in p.terminals if t.number == pad)
        net = next(found, "")
        return _way(wire["to_board"], board, net, ref) if net else Way((), (), ())


def _way(name: str, board: KicadBoard, net: str, without: str) -> Way:
    steps, nets, parts = [], [net], []
    for part in board.parts:
        others = [t.net for t in part.terminals if t.net != net]
        in_series = len(part.terminals) == 2 and len(others) == 1 and others[0].startswith(net)
        if part.ref.startswith("R") and in_series:
            steps.append(f"{part.ref} {part.value}")
            nets.append(others[0])
            parts.append(f"{name}.{part.ref}")
    sockets = (p for p in board.parts if p.ref.startswith("J") and p.ref != without)
    ends = [f"{part.ref}.{number}" for part in sockets for number in pads(part, nets[-1])]
    if ends:
        steps.append(", ".join(ends))
    return Way(tuple(steps), tuple(f"{name}:{each}" for each in nets), tuple(parts))


def pads(part: Part, net: str) -> Sequence[str]:
    """Numbers of the pads of a part that lie in a net."""
    return [t.number for t in part.terminals if t.net == net]
