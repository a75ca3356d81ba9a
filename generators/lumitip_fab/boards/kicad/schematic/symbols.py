"""Symbols of the schematics, drawn here so that no library is needed. y up, in mm."""

import math

from lumitip_fab.boards.kicad.sexpr import Node, Quoted, Value
from lumitip_fab.design import Multiplexer, Point

LIBRARY = "lumitip"
GRID_MM = 1.27
ROW_MM = 7.62
"""Between the pins that a row of parts hangs on."""
SIDE_MM = 10.16
"""Half the width of a multiplexer's body."""
PIN_MM = 2.54
_FONT = ("effects", ("font", ("size", 1.27, 1.27)))
HIDDEN: Node = ("effects", ("font", ("size", 1.27, 1.27)), "hide")


def hand_drawn() -> dict[str, Node]:
    """The symbols that every board draws on, by name."""
    return {
        "R": symbol(
            "R",
            [box(-1.016, -2.54, 1.016, 2.54)],
            [pin("1", 0, 3.81, 270, 1.27), pin("2", 0, -3.81, 90, 1.27)],
        ),
        "C": symbol(
            "C",
            [line((-2.032, 0.762), (2.032, 0.762)), line((-2.032, -0.762), (2.032, -0.762))],
            [pin("1", 0, 3.81, 270, 3.048), pin("2", 0, -3.81, 90, 3.048)],
        ),
        "TestPoint": symbol("TP", [_circle(0, 3.302, 0.762)], [pin("1", 0, 0, 90, 2.54)]),
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


def resistor_array(resistors: int) -> Node:
    """Separate resistors, each a unit that is drawn by itself."""
    body, *_ = (v for v in hand_drawn()["R"] if isinstance(v, tuple) and v[0] == "symbol")
    frame = symbol("RN", [], [])[:-2]
    units = (
        (
            "symbol",
            f"{i}_1",
            *body[2:],
            pin(str(i), 0, 3.81, 270, 1.27),
            pin(str(2 * resistors + 1 - i), 0, -3.81, 90, 1.27),
        )
        for i in range(1, resistors + 1)
    )
    return (*frame, *units)


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
    """A phototransistor, its emitter to the left and its collector to the right."""
    collector, emitter = ("1", "2") if marked == "collector" else ("2", "1")
    body = [
        _circle(0, 0.635, 2.54),
        line((-1.27, 1.27), (1.27, 1.27)),
        line((0.635, 1.27), (1.905, 0), (2.54, 0)),
        line((-0.635, 1.27), (-1.905, 0), (-2.54, 0)),
        line((-1.27, 0.0), (-1.905, 0), (-1.905, 0.635)),
        *_rays((-1.4, 4.9), away=False),
    ]
    pins = [pin(emitter, -5.08, 0, 0, 2.54, "E"), pin(collector, 5.08, 0, 180, 2.54, "C")]
    return symbol("Q", body, pins)


def multiplexer(mux: Multiplexer) -> Node:
    """A multiplexer: inputs to the left, output and select lines to the right."""
    pins = [
        pin(str(lead), *at, angle, PIN_MM, name, "input" if name[0] in "SE~" else kind)
        for name, lead, at, angle, kind in mux_pins(mux)
    ]
    top = mux_half_mm(mux)
    return symbol("U", [box(-SIDE_MM, -top, SIDE_MM, top, fill="background")], pins, shown=True)


def mux_half_mm(mux: Multiplexer) -> float:
    """Half the height of a multiplexer's body."""
    return (mux.channels + 1) / 2 * ROW_MM


def mux_pins(mux: Multiplexer) -> list[tuple[str, int, Point, int, str]]:
    """Name, lead, place of its outer end, angle and kind of each pin."""
    first, top = (mux.channels - 1) / 2 * ROW_MM, mux_half_mm(mux) + PIN_MM
    side = SIDE_MM + PIN_MM
    pins: list[tuple[str, int, Point, int, str]] = [
        (f"Y{i}", lead, (-side, first - i * ROW_MM), 0, "passive")
        for i, lead in enumerate(mux.input_leads)
    ]
    pins.append(("Z", mux.output, (side, first), 180, "passive"))
    pins += [
        (f"S{i}", lead, (side, first - 2 * ROW_MM - i * 5.08), 180, "input")
        for i, lead in enumerate(mux.select)
    ]
    pins.append(("VCC", mux.supply, (0, top), 270, "power_in"))
    pins += [
        ("GND", mux.ground, (-5.08, -top), 90, "power_in"),
        ("~{E}", mux.enable, (5.08, -top), 90, "input"),
    ]
    if mux.negative is not None:
        pins.append(("VEE", mux.negative, (0, -top), 90, "power_in"))
    return pins


def wires(ways: int, pitch_mm: float = ROW_MM) -> Node:
    """A row of contacts numbered from 1, first at the top."""
    return contacts(tuple(str(i + 1) for i in range(ways)), pitch_mm)


def contacts(numbers: tuple[str, ...], pitch_mm: float) -> Node:
    """A row of contacts with these numbers, first at the top."""
    ways = len(numbers)
    first = (ways - 1) / 2 * pitch_mm
    pins = [
        pin(number, 5.08, first - i * pitch_mm, 180, PIN_MM, number)
        for i, number in enumerate(numbers)
    ]
    half = ways / 2 * pitch_mm
    dots = [_circle(1.27, first - i * pitch_mm, 0.762) for i in range(ways)]
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
) -> Node:
    """A pin whose outer end is at (x, y); it reaches `length` from there towards `angle`."""
    return (
        "pin",
        kind,
        "line",
        ("at", x, y, angle),
        ("length", length),
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


def _circle(x: float, y: float, radius: float) -> Node:
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
