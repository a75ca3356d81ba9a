"""Symbols of the schematics: those of `symbols.kicad_sym`, so that no library of KiCad is needed,
and what is drawn for one part. y up, in mm."""

from functools import lru_cache
from pathlib import Path

import sexpdata

from lumitip_fab.boards.kicad.sexpr import Node, Quoted, Value, as_node
from lumitip_fab.boards.model import GROUND

LIBRARY = "lumitip"
GRID_MM = 1.27
PITCH_MM = 2.54
"""From pin to pin of contacts and chips."""
PIN_MM = 2.54
_FONT = ("effects", ("font", ("size", 1.27, 1.27)))
HIDDEN: Node = ("effects", ("font", ("size", 1.27, 1.27)), "hide")


TWO_TERMINALS = {
    "resistor": "R",
    "capacitor": "C",
    "fuse": "F",
    "inductor": "L",
    "crystal": "Y",
    "tvs diode": "D",
    "esd diode": "Z",
    "schottky diode": "VD",
    "indicator": "LED",
}
"""Symbols of parts that are drawn upright, the first terminal at the top, or turned."""


def two_terminals(kind: str) -> tuple[str, Node]:
    """Name and symbol of a part of these kinds."""
    return TWO_TERMINALS[kind], drawn(TWO_TERMINALS[kind])


def hand_drawn() -> dict[str, Node]:
    """The symbols of a board whose supplies are drawn as symbols, by name."""
    return {name: drawn(name) for name in ("R", "C", "TestPoint", "PWR_FLAG", GROUND)}


def supply(net: str) -> Node:
    """The symbol that names a net: of ground, of the flag of a supply from outside, or others."""
    return drawn(net) if net in ("PWR_FLAG", GROUND) else drawn("SUPPLY", NET=net)


def polar(name: str, marked: str) -> Node:
    """The symbol of an LED or a phototransistor, whose marked terminal is the first."""
    first = {"anode": "AK", "cathode": "KA", "collector": "CE", "emitter": "EC"}[marked]
    return drawn(name, **dict(zip(first, "12", strict=True)))


def drawn(name: str, **words: str) -> Node:
    """A symbol of the file, with the words that take the place of `{KEY}` there."""
    return tuple(_filled(value, words) for value in _library()[name])


@lru_cache
def _library() -> dict[str, Node]:
    """The symbols of the file by name; the drawings in them are without it, see `named`."""
    file = Path(__file__).with_name("symbols.kicad_sym")
    whole = as_node(sexpdata.loads(file.read_text(encoding="utf-8")))
    shapes = (value for value in whole if isinstance(value, tuple) and value[0] == "symbol")
    return {
        str(name): ("symbol", *(_plain(str(name), value) for value in parts))
        for _, name, *parts in shapes
    }


def _plain(name: str, value: Value) -> Value:
    if isinstance(value, tuple) and value[0] == "symbol":
        return ("symbol", str(value[1]).removeprefix(f"{name}_"), *value[2:])
    return value


def _filled(value: Value, words: dict[str, str]) -> Value:
    if isinstance(value, tuple):
        return tuple(_filled(inner, words) for inner in value)
    return Quoted(value.format_map(words)) if isinstance(value, Quoted) else value


def contacts(numbers: tuple[str, ...], pitch_mm: float) -> Node:
    """A row of contacts with these numbers, first at the top."""
    ways = len(numbers)
    first = (ways - 1) / 2 * pitch_mm
    pins = [
        pin(number, 5.08, first - i * pitch_mm, 180, PIN_MM, number)
        for i, number in enumerate(numbers)
    ]
    half = ways / 2 * pitch_mm
    dots = [circle(1.27, first - i * pitch_mm, 0.762) for i in range(ways)]
    return symbol("J", [box(-2.54, -half, 2.54, half, fill="background"), *dots], pins)


def named(name: str, shape: Node, library: bool) -> Node:
    """A symbol under its name: plain in a library file, with the library's name in a sheet."""
    whole = Quoted(name if library else f"{LIBRARY}:{name}")
    return ("symbol", whole, *(_unit(name, v) for v in shape[1:]))


def _unit(name: str, value: Value) -> Value:
    """The drawing inside a symbol, under the symbol's name."""
    if isinstance(value, tuple) and value[0] == "symbol":
        return ("symbol", Quoted(f"{name}_{value[1]}"), *value[2:])
    return value


def symbol(prefix: str, body: list[Node], pins: list[Node], shown: bool = False) -> Node:
    """A symbol without its name yet; `shown` are numbers and names of its pins."""
    hide = () if shown else (("pin_numbers", "hide"),)
    names: Node = (
        ("pin_names", ("offset", 1.016)) if shown else ("pin_names", ("offset", 0), "hide")
    )
    return (
        "symbol",
        *hide,
        names,
        *_frame(prefix),
        ("symbol", "0_1", *body),
        ("symbol", "1_1", *pins),
    )


def _frame(prefix: str) -> tuple[Node, ...]:
    properties = (("Reference", prefix), ("Value", ""), ("Footprint", ""), ("Datasheet", ""))
    return (
        ("in_bom", "yes"),
        ("on_board", "yes"),
        *(
            (
                "property",
                Quoted(key),
                Quoted(value),
                ("id", i),
                ("at", 0, 0, 0),
                HIDDEN if i else _FONT,
            )
            for i, (key, value) in enumerate(properties)
        ),
    )


def pin(
    number: str,
    x: float,
    y: float,
    angle: int,
    length: float,
    name: str = "~",
    kind: str = "passive",
    hide: bool = False,
) -> Node:
    """A pin whose outer end is at (x, y); it reaches `length` from there towards `angle`."""
    return (
        "pin",
        kind,
        "line",
        ("at", x, y, angle),
        ("length", length),
        *(("hide",) if hide else ()),
        ("name", Quoted(name), _FONT),
        ("number", Quoted(number), _FONT),
    )


def _stroke(fill: str = "none") -> tuple[Node, Node]:
    return (
        ("stroke", ("width", 0.2), ("type", "default"), ("color", 0, 0, 0, 0)),
        ("fill", ("type", fill)),
    )


def box(x0: float, y0: float, x1: float, y1: float, fill: str = "none") -> Node:
    """A rectangle between two corners."""
    return ("rectangle", ("start", x0, y0), ("end", x1, y1), *_stroke(fill))


def circle(x: float, y: float, radius: float) -> Node:
    """A circle round a place."""
    return ("circle", ("center", x, y), ("radius", radius), *_stroke())
