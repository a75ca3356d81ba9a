"""The wiring diagram: the boards as boxes, their pads in order, every wire by number and colour.

    ┌──────────┐                        ┌────────────┐                  ┌────────┐
    │ emitter  ●──┤W1.1 BK├─────────────● J6      J7 ●──┤W3.1 BK├───────● supply │
    └──────────┘                        │  breakout  │                  └────────┘
    ┌──────────┐                        │            │
    │ receiver ●──┤W2.1 BK├─────────────● J5         │
    └──────────┘                        └────────────┘

Without a breakout, the fingers' cables end at the flange if the controller is on its board, else at
the supply and at the controller's pins, which stand in the order of its edges. A wire that switches
the LEDs then runs from the emitter to the controller, between the two.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from xml.sax.saxutils import escape

from lumitip_fab.design import Cable, Cabling, Terminal, Title, Wire
from lumitip_fab.design.cabling import COLOURS, codes_of

_ROW, _HEAD, _FOOT, _GAP, _TOP = 6.2, 15.5, 3.0, 8.0, 20.0
_MARGIN, _LABEL = 8.0, 44.0
_LEFT = (8.0, 44.0)  # edges of the boxes in each column; near, for the manual's page shrinks all
_MIDDLE = (114.0, 168.0)
_RIGHT = (238.0, 278.0)
_SMALL = 4.6  # height of the least letters
_INK, _FAINT, _PAPER = "#1a1a1a", "#5a6b7a", "#f4f6f8"
_BOLD = 'text-anchor="middle" font-weight="bold"'
_CENTRED = 'text-anchor="middle"'


@dataclass(frozen=True)
class Run:
    """A cable with the edges of the boxes between which it runs, and its first row's height."""

    cable: Cable
    start_x: float
    end_x: float
    top: float

    def start_y(self, wire: Wire) -> float:
        """Height of the pad at its start."""
        return _row_y(self.top, [w.start for w in self.cable.wires], wire.start)

    def end_y(self, wire: Wire) -> float:
        """Height of the pad at its end."""
        return _row_y(self.top, [w.end for w in self.cable.wires], wire.end)


def diagram(title: Title, cabling: Cabling) -> str:
    """An SVG in mm."""
    runs = tuple(_runs(cabling))
    bottom = max(run.top + _height(run.cable) for run in runs)
    width = max(right for _, right in (_edges(run)[1] for run in runs)) + _MARGIN
    height = bottom + 13 + _MARGIN / 2
    name, drawn = (f"{t.name} {t.revision}: wiring" for t in (title, title.on_pages()))
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}mm" height="{height:g}mm" '
        f'viewBox="0 0 {width:g} {height:g}" font-family="Helvetica, Arial, sans-serif">',
        f"<title>{escape(name)}</title>",
        f'<rect width="{width:g}" height="{height:g}" fill="#fff"/>',
        _text(_LEFT[0], 14, drawn, 6, _INK, 'font-weight="bold"'),
        *_boxes(runs),
        *(line for run in runs for wire in run.cable.wires for line in _wire(run, wire)),
        *(line for run in runs for line in _ends(run)),
        _text(_LEFT[0], bottom + 7, "Stranded copper, colours by IEC 60757.", _SMALL, _FAINT),
        _text(
            _LEFT[0],
            bottom + 12.5,
            "Pad 1 is square: on a finger's board the leftmost, seen from the front, tip up.",
            _SMALL,
            _FAINT,
        ),
        "</svg>",
    ]
    return "\n".join(lines) + "\n"


def _runs(cabling: Cabling) -> Iterator[Run]:
    """The fingers' cables below each other, the supply's beside the first."""
    emitter, receiver, *others = cabling.cables
    switching = [cable for cable in others if cable.start.board == emitter.start.board]
    further = [cable for cable in others if cable not in switching]
    beside = max((_height(cable) for cable in further), default=0.0)
    top = _TOP
    for cable in (emitter, *switching, receiver):
        yield Run(cable, _LEFT[1], _MIDDLE[0], top)
        top += max(_height(cable), beside if cable is emitter else 0.0) + _GAP
    for cable in further:
        yield Run(cable, _MIDDLE[1], _RIGHT[0], _TOP)


def _height(cable: Cable) -> float:
    return _HEAD + _ROW * len(cable.wires) + _FOOT


def _row_y(top: float, pads: list[Terminal], pad: Terminal) -> float:
    row = sorted(pads, key=lambda each: each.order).index(pad)
    return top + _HEAD + _ROW * (row + 0.5)


def _edges(run: Run) -> tuple[tuple[float, float], tuple[float, float]]:
    """Edges of the boxes at both ends of a cable."""
    return (_LEFT, _MIDDLE) if run.start_x == _LEFT[1] else (_MIDDLE, _RIGHT)


def _boxes(runs: tuple[Run, ...]) -> Iterator[str]:
    """A box for each board, around all that ends on it."""
    spans: dict[tuple[tuple[float, float], str], list[float]] = {}
    for run in runs:
        start, end = _edges(run)
        for edges, board in ((start, run.cable.start.board), (end, run.cable.end.board)):
            spans.setdefault((edges, board), []).extend((run.top, run.top + _height(run.cable)))
    for (edges, board), heights in spans.items():
        yield _box(edges, min(heights), max(heights), board)
    if any(_edges(run)[1] == _RIGHT for run in runs):
        receiver, middle = runs[1], sum(_MIDDLE) / 2
        for i, words in enumerate(("the controller", "plugs into", "J1 and J2")):
            y = receiver.top + _HEAD + 8 + 6 * i
            yield _text(middle + 10, y, words, _SMALL, _FAINT, _CENTRED)


def _wire(run: Run, wire: Wire) -> Iterator[str]:
    """Straight to its label, then a curve to the pad; an outline, without which white is lost."""
    start, end = run.start_y(wire), run.end_y(wire)
    label = run.start_x + 6
    bend = label + _LABEL
    middle = (bend + run.end_x) / 2
    path = (
        f"M{run.start_x:g},{start:g}L{bend:g},{start:g}"
        f"C{middle:g},{start:g} {middle:g},{end:g} {run.end_x:g},{end:g}"
    )
    base, *stripe = codes_of(wire.colour)
    current = f" {wire.current_ma:.3g} mA" if wire.current_ma else ""
    yield f'<g class="wire" id="{wire.number}" fill="none">'
    yield f'<path d="{path}" stroke="{_INK}" stroke-width="1.5"/>'
    yield f'<path class="core" d="{path}" stroke="{COLOURS[base][1]}" stroke-width="1.1"/>'
    for code in stripe:
        yield (
            f'<path class="stripe" d="{path}" stroke="{COLOURS[code][1]}" stroke-width="1.1" '
            'stroke-dasharray="2 2"/>'
        )
    yield (
        f'<rect x="{label:g}" y="{start - 2.7:g}" width="{_LABEL:g}" height="5.4" rx="1" '
        f'fill="#fff" stroke="{_INK}" stroke-width=".2"/>'
    )
    words = f"{wire.number} {wire.colour}{current}"
    yield _text(label + _LABEL / 2, start + 1.6, words, _SMALL, _INK, _CENTRED)
    yield "</g>"


def _ends(run: Run) -> Iterator[str]:
    """Pads, the names of their connectors, and what the cable is."""
    cable, middle = run.cable, run.start_x + 6 + _LABEL / 2
    yield _text(middle, run.top + 7, cable.name, 5, _INK, _BOLD)
    yield _text(
        middle,
        run.top + 12.5,
        f"{cable.length_mm:g} mm, {cable.section_mm2:g} mm²",
        _SMALL,
        _FAINT,
        _CENTRED,
    )
    for x, side, pads in (
        (run.start_x, -1, [(w.start, run.start_y(w)) for w in cable.wires]),
        (run.end_x, 1, [(w.end, run.end_y(w)) for w in cable.wires]),
    ):
        yield _text(
            x + side * 3,
            run.top + _HEAD - 1.5,
            pads[0][0].connector,
            _SMALL,
            _FAINT,
            f'text-anchor="{_anchor(side)}"',
        )
        yield from (_pad(pad, x, y, side) for pad, y in pads)


def _pad(pad: Terminal, x: float, y: float, side: int) -> str:
    """A pad on the edge of a box; its words run into the box, the number next to the edge."""
    words: Iterable[str] = dict.fromkeys((pad.pin, pad.name))
    lines = [
        _text(
            x + side * (3 + 7.5 * i), y + 1.6, word, _SMALL, _INK, f'text-anchor="{_anchor(side)}"'
        )
        for i, word in enumerate(words)
    ]
    ring = f'r="1.3" fill="#d9b44a" stroke="{_INK}" stroke-width=".3"'
    return (
        f'<g class="pad" id="{escape(pad.board)}.{escape(pad.label)}">'
        f'<circle cx="{x:g}" cy="{y:g}" {ring}/>{"".join(lines)}</g>'
    )


def _anchor(side: int) -> str:
    return "end" if side < 0 else "start"


def _box(edges: tuple[float, float], top: float, bottom: float, name: str) -> str:
    left, right = edges
    return (
        f'<rect x="{left:g}" y="{top:g}" width="{right - left:g}" height="{bottom - top:g}" '
        f'rx="2" fill="{_PAPER}" stroke="{_INK}" stroke-width=".4"/>'
        + _text((left + right) / 2, top + 7, name.capitalize(), 5.2, _INK, _BOLD)
    )


def _text(x: float, y: float, text: str, size: float, ink: str, style: str = "") -> str:
    return (
        f'<text x="{x:g}" y="{y:g}" font-size="{size:g}" fill="{ink}" {style}>{escape(text)}</text>'
    )
