"""The parts that protect controller and supply, as the manual has them where a design has them."""

from collections import defaultdict
from collections.abc import Iterator, Sequence

from lumitip_fab.design import AuxiliaryBoard, Component, Design
from lumitip_fab.docs.wiring import ends_of_fingers
from lumitip_fab.text import listed, passage, runs

ESD, TVS, FUSE, MOSFET = "esd diode", "tvs diode", "fuse", "transistor"
SCHOTTKY = "schottky diode"
CONTROLLER = "3V3"
"""Net of the supply of controller and photodetectors."""


def protection_note(board: AuxiliaryBoard, design: Design) -> str:
    """Paragraphs on a board's ESD diodes with their resistors, on its TVS diode with its fuse, and
    on the diode before the controller; empty without any."""
    return "".join(f"\n\n{text}" for text in _of(board, design))


def boards_of_later(design: Design) -> list[AuxiliaryBoard]:
    """Boards that are shown and tested after the first test: the flange's, unless wires of the
    fingers end on it."""
    near = ends_of_fingers(design)
    return [b for b in design.auxiliary_boards if b.name == "flange" and b.name not in near]


def _of(board: AuxiliaryBoard, design: Design) -> Iterator[str]:
    kinds: dict[str, list[Component]] = defaultdict(list)
    for part in board.components:
        kinds[part.kind].append(part)
    if diodes := kinds[ESD]:
        lines = {net for diode in diodes for _, net in diode.nets} - {*board.supplies}
        held = [
            part
            for part in board.components
            if part.kind == "resistor" and {net for _, net in part.nets} & lines
        ]
        limited = (
            _text("protected_series", resistors=runs(part.ref for part in held)) if held else ""
        )
        yield _text(
            "protected_esd",
            board=board.name,
            diodes=runs(part.ref for part in diodes),
            limited=limited,
            pads=listed(_pads(board, diodes)),
            before="the wires are on" if board.module else "wires and controller are on",
            missing=_text("protected_module" if board.module else "protected_plain"),
        )
    for part in kinds[TVS]:
        melts = "".join(_text("protected_fuse", fuse=fuse) for fuse in kinds[FUSE])
        where = "the first test"
        if board.name == "flange":
            later = board in boards_of_later(design)
            where = "its test" if later else 'step "Try the flange board"'
        ends = "".join(
            _text("protected_reversed", part=mosfet, supply_v=design.wiring.supply_v)
            for mosfet in kinds[MOSFET]
        )
        yield _text(
            "protected_tvs", board=board.name, part=part, melts=melts, where=where, reversed=ends
        )
    yield from _fed(board, design, kinds[SCHOTTKY])


def _pads(board: AuxiliaryBoard, diodes: Sequence[Component]) -> list[str]:
    """Pads that a diode is on; on a board with a module no supply, which other parts are on too."""
    nets = dict.fromkeys(net for diode in diodes for _, net in diode.nets if net != "GND")
    others = {*board.supplies, CONTROLLER} if board.module else set()
    return [net for net in nets if net not in others]


def _fed(board: AuxiliaryBoard, design: Design, diodes: Sequence[Component]) -> Iterator[str]:
    """The diode before the controller, and the names of the pads at its ends."""
    feed = design.feed
    for part in diodes:
        assert feed is not None
        (_, behind), (_, before) = part.nets
        ends = {
            net: next(
                d.ref for d in board.components if d.kind == kind and net in dict(d.nets).values()
            )
            for net, kind in ((before, "wires"), (behind, "socket"))
        }
        yield _text("protected_feed", feed=feed, part=part, cable=ends[before], socket=ends[behind])


def _text(name: str, /, **values: object) -> str:
    """A passage of the manual with its values."""
    return passage("docs/chapters.md", name).format(**values)
