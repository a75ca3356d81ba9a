"""Symbols of the schematics, drawn here so that no library is needed. y up, in mm."""

import math

from lumitip_fab.boards.kicad.sexpr import Node, Quoted, Value
from lumitip_fab.design import Point

LIBRARY = "lumitip"
GRID_MM = 1.27
PITCH_MM = 2.54
"""From pin to pin of contacts and chips."""
PIN_MM = 2.54
_TURNS = 4  # of a coil
_FONT = ("effects", ("font", ("size", 1.27, 1.27)))
HIDDEN: Node = ("effects", ("font", ("size", 1.27, 1.27)), "hide")


TWO_TERMINALS = (
    "resistor",
    "capacitor",
    "fuse",
    "inductor",
    "crystal",
    "tvs diode",
    "indicator",
)
"""Kinds of parts that are drawn upright, the first terminal at the top, or turned."""
_BAR = (-1.778, 0.762), (-1.27, 1.27), (1.27, 1.27), (1.778, 1.778)
_TRIANGLE = (-1.27, -1.27), (1.27, -1.27), (0, 1.27), (-1.27, -1.27)


def two_terminals(kind: str) -> tuple[str, Node]:
    """Name and symbol of a part of these kinds."""
    name, body, half_mm = {
        "resistor": ("R", [box(-1.016, -2.54, 1.016, 2.54)], 2.54),
        "capacitor": ("C", _plates(2.032, 0.762), 0.762),
        "fuse": ("F", [box(-0.762, -2.54, 0.762, 2.54), line((0, 2.54), (0, -2.54))], 2.54),
        "inductor": ("L", [_coil()], 2.54),
        "tvs diode": ("D", [line(*_BAR), line(*_TRIANGLE)], 1.27),
        "indicator": ("LED", [*_lamp(), *_rays((1.5, -0.6), away=True)], 1.27),
        "crystal": ("Y", [box(-1.27, -0.635, 1.27, 0.635), *_plates(1.27, 1.27)], 1.27),
    }[kind]
    reach = 3.81 - half_mm
    pins = [pin("1", 0, 3.81, 270, reach), pin("2", 0, -3.81, 90, reach)]
    return name, symbol("D" if kind == "indicator" else name, body, pins)


def hand_drawn() -> dict[str, Node]:
    """The symbols of a board whose supplies are drawn as symbols, by name."""
    return {
        **dict(map(two_terminals, ("resistor", "capacitor"))),
        "TestPoint": test_point(),
        **power_symbols(),
    }


def test_point() -> Node:
    """A test point above its pin."""
    return symbol("TP", [circle(0, 3.302, 0.762)], [pin("1", 0, 0, 90, 2.54)])


def power_symbols() -> dict[str, Node]:
    """The flag of a supply from outside, and ground, by name."""
    return {
        "PWR_FLAG": _power(
            "PWR_FLAG",
            [
                line((0, 0), (0, 1.27)),
                line((0, 1.27), (-1.016, 1.905), (0, 2.54), (1.016, 1.905), (0, 1.27)),
            ],
            "power_out",
            90,
        ),
        "GND": _power(
            "GND",
            [
                line((0, 0), (0, -1.27)),
                line((-1.27, -1.27), (1.27, -1.27), (0, -2.54), (-1.27, -1.27)),
            ],
            "power_in",
            270,
        ),
    }


def supply(name: str) -> Node:
    """The symbol of a supply, which names its net."""
    return _power(
        name,
        [line((0, 0), (0, 2.54)), line((-0.762, 1.27), (0, 2.54), (0.762, 1.27))],
        "power_in",
        90,
    )


def led(marked: str) -> Node:
    """An LED, its anode to the left."""
    anode, cathode = ("1", "2") if marked == "anode" else ("2", "1")
    body = [
        line((-1.27, 1.27), (-1.27, -1.27), (1.27, 0), (-1.27, 1.27)),
        line((1.27, 1.27), (1.27, -1.27)),
        *_rays((-0.5, 1.6), away=True),
    ]
    pins = [pin(anode, -3.81, 0, 0, 2.54, "A"), pin(cathode, 3.81, 0, 180, 2.54, "K")]
    return symbol("D", body, pins)


def phototransistor(marked: str) -> Node:
    """A phototransistor, its emitter to the left and its open collector to the right."""
    collector, emitter = ("1", "2") if marked == "collector" else ("2", "1")
    body = [
        circle(0, 0.635, 2.54),
        line((-1.27, 1.27), (1.27, 1.27)),
        line((0.635, 1.27), (1.905, 0), (2.54, 0)),
        line((-0.635, 1.27), (-1.905, 0), (-2.54, 0)),
        line((-1.27, 0.0), (-1.905, 0), (-1.905, 0.635)),
        *_rays((-1.4, 4.9), away=False),
    ]
    pins = [
        pin(emitter, -5.08, 0, 0, 2.54, "E"),
        pin(collector, 5.08, 0, 180, 2.54, "C", "open_collector"),
    ]
    return symbol("Q", body, pins)


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


def _power(net: str, body: list[Node], kind: str, angle: int) -> Node:
    end = pin("1", 0, 0, angle, 0, net, kind)
    return (
        "symbol",
        ("power",),
        ("pin_numbers", "hide"),
        ("pin_names", ("offset", 0), "hide"),
        *_frame("#PWR"),
        ("symbol", "0_1", *body),
        ("symbol", "1_1", end),
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


def line(*points: Point) -> Node:
    """A line along some points."""
    return ("polyline", ("pts", *(("xy", *p) for p in points)), *_stroke())


def box(x0: float, y0: float, x1: float, y1: float, fill: str = "none") -> Node:
    """A rectangle between two corners."""
    return ("rectangle", ("start", x0, y0), ("end", x1, y1), *_stroke(fill))


def circle(x: float, y: float, radius: float) -> Node:
    """A circle round a place."""
    return ("circle", ("center", x, y), ("radius", radius), *_stroke())


def _rays(start: Point, away: bool) -> list[Node]:
    """Two short arrows of light, from a place up to the right or down to the right."""
    found = []
    turn = math.radians(60 if away else -60)
    cos, sin = math.cos(turn), math.sin(turn)
    for shift in (0.0, 1.1):
        x, y = start[0] + shift, start[1]
        tip = (x + 1.6 * cos, y + 1.6 * sin)
        found.append(line((x, y), tip))
        for side in (150, -150):
            a = turn + math.radians(side)
            found.append(line(tip, (tip[0] + 0.6 * math.cos(a), tip[1] + 0.6 * math.sin(a))))
    return found


def _lamp() -> list[Node]:
    """A diode, its cathode at the top."""
    return [line((-1.27, 1.27), (1.27, 1.27)), line(*_TRIANGLE)]


def _plates(half_mm: float, apart_mm: float) -> list[Node]:
    return [line((-half_mm, y), (half_mm, y)) for y in (apart_mm, -apart_mm)]


def _coil() -> Node:
    """Half circles, one below the other."""
    radius = 2.54 / _TURNS
    angles = [math.radians(step * 15) for step in range(13)]
    return line(
        *(
            (radius * math.sin(a), 2.54 - (2 * turn + 1) * radius + radius * math.cos(a))
            for turn in range(_TURNS)
            for a in angles
        )
    )
