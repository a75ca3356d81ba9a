"""The kinds of edit of `docs/ranges.md`: each draws the fields that a user would write."""

from collections.abc import Callable
from dataclasses import dataclass
from random import Random

from acceptance.grids import draw_cells, draw_columns
from acceptance.limits import BENCH, crossed, inputs, least_silicone_mm, nut_has_room
from acceptance.limits import Values as Fields
from acceptance.names import DEVICES, NAMES, REVISIONS
from acceptance.parts import Table, bends, bypasses, entries

E24 = (33, 36, 39, 43, 47, 51, 56, 62, 68, 75, 82, 91, 100, 110, 120, 130, 150, 160, 180, 200, 220)


@dataclass(frozen=True)
class Kind:
    """A kind of edit."""

    name: str
    weight: float
    draw: Callable[[Random, Table, str], Table]
    """The fields to write, beside those that are written already and over a preset."""


def _steps(random: Random, low: float, high: float, step: float) -> float:
    return round(low + step * random.randint(0, round((high - low) / step)), 4)


def _some(random: Random, choices: dict[str, Callable[[], object]]) -> Table:
    """One of the fields, or several."""
    names = list(choices)
    count = random.choice((1, 1, 1, 2, len(names)))
    chosen = random.sample(names, min(count, len(names)))
    return {name: choices[name]() for name in names if name in chosen}


def _grid(random: Random, _: Table, base: str) -> Table:
    """A grid, with a pitch or without, that a page takes."""
    cells = draw_cells(random)
    while True:
        edits: Table = {"grid.columns": draw_columns(random, cells)}
        if random.random() < 0.6:
            edits |= _pitch(random, edits, base)
        count = sum(edits["grid.columns"])
        boards = [board for board in entries("controllers") if board != BENCH]
        if count > max(inputs(b, list(entries("multiplexers").values())) for b in boards):
            edits["controller.board"] = BENCH
        if not crossed(Fields(edits, base)):
            return edits


def _pitch(random: Random, _: Table, _base: str) -> Table:
    return {"grid.pitch_mm": _steps(random, 3.5, 10.0, 0.1)}


def _hole(random: Random, edits: Table, base: str) -> Table:
    pitch = Fields(edits, base)["grid.pitch_mm"]
    hole = round(pitch * random.uniform(0.3, 0.55), 1)
    hole = min(max(hole, round(0.3 * pitch + 0.05, 1)), round(0.55 * pitch - 0.05, 1))
    both: Table = {"mask.hole_mm": hole}
    if random.random() < 0.3:
        both["mask.hole_shape"] = random.choice(("hexagon", "circle"))
    return both


def _silicone(random: Random, edits: Table, base: str) -> Table:
    least = max(0.8, least_silicone_mm(Fields(edits, base)))
    return {"stack.silicone_mm": round(random.uniform(least + 0.05, 4.0), 1)}


def _layers(random: Random, _: Table, _base: str) -> Table:
    return _some(
        random,
        {
            "stack.pcb_mm": lambda: random.choice((0.8, 1.0, 1.2, 1.6, 2.0)),
            "stack.floor_mm": lambda: _steps(random, 0.8, 2.5, 0.1),
        },
    )


def _optics(random: Random, _: Table, _base: str) -> Table:
    return _some(
        random,
        {
            "emitter.led": lambda: random.choice(list(entries("leds"))),
            "receiver.photodetector": lambda: random.choice(list(entries("photodetectors"))),
        },
    )


def _pull_up(random: Random, _: Table, _base: str) -> Table:
    return {"receiver.pull_up_ohm": 1000 * random.choice(E24)}


def _load(random: Random, _: Table, _base: str) -> Table:
    return {"receiver.load": random.choice(("auto", "auto", "shared"))}


def _supply(random: Random, _: Table, _base: str) -> Table:
    volts = random.choice((5.0, 9.0, 12.0, 24.0))
    edits: Table = {"supply.voltage_v": volts}
    if volts == 5.0:
        edits["flange.enabled"] = False
    elif random.random() < 0.4:
        edits["flange.enabled"] = random.choice((True, False))
    if random.random() < 0.2:
        edits["supply.max_ma"] = _steps(random, 250, 1000, 50)
    return edits


def _boards(random: Random, _: Table, _base: str) -> Table:
    return _some(
        random,
        {
            "breakout.enabled": lambda: random.random() < 0.3,
            "flange.enabled": lambda: random.random() < 0.3,
            "emitter.switch": lambda: random.choice(("auto", "none")),
            "breakout.indicator": lambda: random.choice(("auto", "none")),
            "breakout.feed_diode": lambda: random.choice(("auto", "none")),
            "flange.indicator": lambda: random.choice(("auto", "none")),
            "receiver.bulk_capacitor": lambda: random.choice(("auto", "none")),
            "protection.diode": lambda: random.choice(("auto", "none")),
        },
    )


def _entry(field: str, kind: str) -> Callable[[Random, Table, str], Table]:
    return lambda random, _, _base: {field: random.choice(list(entries(kind)))}


SMALL = ("0603", "0805", "1206")
"""Packages of pull-ups, which stand with a capacitor beside a multiplexer of 7.3 mm."""


def _passives(random: Random, _: Table, _base: str) -> Table:
    packages = list(entries("resistors"))
    return _some(
        random,
        {
            "emitter.resistor": lambda: random.choice(packages),
            "receiver.resistor": lambda: random.choice(SMALL),
            "receiver.capacitor": lambda: random.choice(bypasses()),
        },
    )


def _controller(random: Random, _: Table, _base: str) -> Table:
    return {"controller.board": random.choice([b for b in entries("controllers") if b != BENCH])}


def _flange(random: Random, _: Table, _base: str) -> Table:
    kinds = {
        "flange.fuse": "fuses",
        "flange.regulator": "regulators",
        "flange.inductor": "inductors",
        "flange.transistor": "transistors",
        "flange.coupling": "couplings",
    }
    field = random.choice(list(kinds))
    named = {n: e for n, e in entries(kinds[field]).items() if e.get("channel", "P") == "P"}
    return {field: random.choice(list(named))}


def _cables(random: Random, _: Table, _base: str) -> Table:
    return _some(
        random,
        {
            "wiring.supply_mm": lambda: _steps(random, 100, 2000, 50),
            "wiring.controller_mm": lambda: _steps(random, 80, 600, 10),
            "wiring.slack_mm": lambda: _steps(random, 20, 100, 5),
        },
    )


def _margins(random: Random, _: Table, _base: str) -> Table:
    return _some(
        random,
        {
            "outline.tip_margin_mm": lambda: _steps(random, 5.5, 9.0, 0.1),
            "outline.shoulder_margin_mm": lambda: _steps(random, 6.5, 11.0, 0.1),
            "outline.waist_margin_mm": lambda: _steps(random, 2.4, 4.0, 0.1),
            "outline.end_margin_mm": lambda: _steps(random, 4.5, 9.0, 0.1),
            "outline.tip_fraction": lambda: _steps(random, 0.45, 0.6, 0.01),
            "board.side_margin_mm": lambda: _steps(random, 5.2, 8.7, 0.1),
        },
    )


def _tip(random: Random, _: Table, _base: str) -> Table:
    if random.random() < 0.5:
        return {"tip.angle_deg": _steps(random, 0, 45, 1)}
    return {"tip.edge_mm": _steps(random, 0.5, 1.6, 0.05)}


def _material(random: Random, _: Table, _base: str) -> Table:
    return {"backing.material": random.choice([f for f in entries("filaments") if not bends(f)])}


def _flex(random: Random, _: Table, _base: str) -> Table:
    return {
        "backing.variant": "flex",
        "backing.material": random.choice([f for f in entries("filaments") if bends(f)]),
        "stack.pcb_mm": _steps(random, 0.11, 0.2, 0.01),
        "stack.floor_mm": _steps(random, 1.5, 2.5, 0.1),
    }


def _printer(random: Random, _: Table, _base: str) -> Table:
    return _some(
        random,
        {
            "printer.profile": lambda: random.choice(list(entries("printers"))),
            "printer.fit_mm": lambda: _steps(random, -0.1, 0.1, 0.01),
        },
    )


def _casting(random: Random, _: Table, _base: str) -> Table:
    films = entries("films").items()
    clear = [name for name, film in films if not film.get("opaque")]
    smooth = [name for name, film in films if film.get("smooth")]
    return _some(
        random,
        {
            "mould.silicone": lambda: random.choice(list(entries("silicones"))),
            "mask.film": lambda: random.choice(clear),
            "mould.insert": lambda: random.choice(smooth),
        },
    )


def _mask(random: Random, _: Table, _base: str) -> Table:
    return _some(
        random,
        {
            "mask.measured_ruler_mm": lambda: [_steps(random, 98, 102, 0.1) for _ in range(2)],
            "mask.flap_mm": lambda: _steps(random, 12.0, 16.0, 0.5),
        },
    )


def _holder(random: Random, _: Table, _base: str) -> Table:
    return {"holder.screw": random.choice([s for s in entries("fasteners") if nut_has_room(s)])}


def _names(random: Random, _: Table, _base: str) -> Table:
    return _some(
        random,
        {
            "name": lambda: random.choice(NAMES),
            "revision": lambda: random.choice(REVISIONS),
            "controller.name": lambda: random.choice(DEVICES),
        },
    )


KINDS = (
    Kind("grid", 25, _grid),
    Kind("pitch", 5, _pitch),
    Kind("hole", 5, _hole),
    Kind("silicone", 5, _silicone),
    Kind("layers", 3, _layers),
    Kind("optics", 5, _optics),
    Kind("pull-up", 2, _pull_up),
    Kind("load", 4, _load),
    Kind("supply", 6, _supply),
    Kind("boards", 4, _boards),
    Kind("multiplexer", 3, _entry("receiver.multiplexer", "multiplexers")),
    Kind("passives", 3, _passives),
    Kind("controller", 4, _controller),
    Kind("flange", 2, _flange),
    Kind("cables", 2, _cables),
    Kind("gripper", 6, _entry("coupling.gripper", "grippers")),
    Kind("margins", 5, _margins),
    Kind("tip", 3, _tip),
    Kind("material", 3, _material),
    Kind("flex", 3, _flex),
    Kind("printer", 3, _printer),
    Kind("casting", 3, _casting),
    Kind("mask", 3, _mask),
    Kind("holder", 2, _holder),
    Kind("names", 5, _names),
)
WITH_A_PRESET = frozenset(
    ("names", "silicone", "cables", "casting", "printer", "mask", "supply"),
)
