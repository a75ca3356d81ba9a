"""A `.kicad_sch` of one sheet as a circuit: what its wires, labels and power symbols join.

Places are on the sheet: mm, y down.
"""

import math
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from lumitip_fab.checks.readers.kicad_shapes import (
    Node,
    child,
    children,
    numbers,
    read_nodes,
    title_block,
    words,
)
from lumitip_fab.errors import OutputError

Point = tuple[int, int]
"""In units of 0.0001 mm, so that ends that meet are equal."""


@dataclass(frozen=True)
class Pin:
    """A pin of a symbol."""

    number: str
    name: str
    kind: str
    at: Point


@dataclass(frozen=True)
class Symbol:
    """A part."""

    ref: str
    value: str
    footprint: str
    fields: tuple[tuple[str, str], ...]
    """Everything that is written of it, by name."""
    placed: bool
    """Whether it is not marked as left out."""
    in_bom: bool
    """Whether KiCad's own bill of materials has it."""
    pins: tuple[Pin, ...]
    """Those of its first unit, in their places."""


@dataclass(frozen=True)
class Sheet:
    """Contents of a sheet."""

    symbols: tuple[Symbol, ...]
    nets: dict[str, set[str]]
    """Pins on each net: `{"GND": {"Q1.2", …}, …}`; nets without a name are called `"?"`."""
    title_block: dict[str, str]
    """As `kicad_shapes.title_block` has it."""


def read_sheet(path: Path) -> Sheet:
    """Read a schematic.

    Raises:
        OutputError: if it cannot be read or is no schematic.
    """
    whole = read_nodes(path)
    if whole[0] != "kicad_sch":
        raise OutputError(f"{path}: is no schematic")
    library = _library(whole)
    joined = _Joined(list(_wires(whole)))
    symbols: list[Symbol] = []
    pins: list[tuple[str, Point]] = []
    names: list[tuple[str, Point]] = [
        (words(label)[0], _point(*numbers(child(label, "at"))[:2]))
        for label in children(whole, "global_label")
    ]
    for symbol in children(whole, "symbol"):
        shape = library[words(child(symbol, "lib_id"))[0]]
        fields = {words(p)[0]: words(p)[1] for p in children(symbol, "property")}
        unit = int(numbers(child(symbol, "unit"))[0])
        placed = [_placed(pin, symbol) for pin in _pins(shape, unit)]
        if child(shape, "power") is not None:
            names += [(fields["Value"], pin.at) for pin in placed if pin.kind == "power_in"]
            continue
        footprint = fields["Footprint"].rpartition(":")[2]  # without its library
        if unit == 1:
            placed_at_all = words(child(symbol, "dnp")) in ([], ["no"])
            own = fields["Reference"], fields["Value"], footprint
            in_bom = words(child(symbol, "in_bom")) in ([], ["yes"])
            texts = tuple(fields.items())
            symbols.append(Symbol(*own, texts, placed_at_all, in_bom, tuple(placed)))
        pins += [(f"{fields['Reference']}.{pin.number}", pin.at) for pin in placed]
    return Sheet(tuple(symbols), _nets(joined, names, pins), title_block(whole))


def _nets(
    joined: "_Joined", names: list[tuple[str, Point]], pins: list[tuple[str, Point]]
) -> dict[str, set[str]]:
    for at in [at for _, at in names]:
        joined.meet(at)
    for first, second in _same_name(names):
        joined.join(first, second)
    named = {joined.root(at): name for name, at in sorted(names, reverse=True)}
    found: dict[str, set[str]] = defaultdict(set)
    for pin, at in pins:
        found[named.get(joined.root(at), "?")].add(pin)
    return dict(found)


def _same_name(names: list[tuple[str, Point]]) -> Iterator[tuple[Point, Point]]:
    """Places that share a name are one net, wherever they are."""
    first: dict[str, Point] = {}
    for name, at in names:
        yield first.setdefault(name, at), at


class _Joined:
    """Places in groups that wires join."""

    def __init__(self, wires: list[tuple[Point, Point]]) -> None:
        self.wires = wires
        self.parent: dict[Point, Point] = {}
        for start, end in wires:
            self.join(start, end)

    def root(self, at: Point) -> Point:
        """The place that stands for a group."""
        while self.parent.setdefault(at, at) != at:
            self.parent[at] = at = self.parent[self.parent[at]]
        return at

    def join(self, one: Point, other: Point) -> None:
        """Make one group of two."""
        self.parent[self.root(one)] = self.root(other)

    def meet(self, at: Point) -> None:
        """Join a place, which may be within a wire, with the wires that pass it."""
        for start, end in self.wires:
            along = math.dist(start, at) + math.dist(at, end)
            if math.isclose(along, math.dist(start, end), rel_tol=1e-9):
                self.join(start, at)


def _wires(whole: Node) -> Iterator[tuple[Point, Point]]:
    for wire in children(whole, "wire"):
        ends = [_point(*numbers(xy)) for xy in children(child(wire, "pts") or [], "xy")]
        yield ends[0], ends[1]


def _library(whole: Node) -> dict[str, Node]:
    return {words(s)[0]: s for s in children(child(whole, "lib_symbols") or [], "symbol")}


def _pins(shape: Node, unit: int) -> Iterator[Node]:
    """Pins of a unit of a symbol. A unit is called NAME_1_1, NAME_2_1 …; NAME_0_1 is in all."""
    for drawing in children(shape, "symbol"):
        if int(words(drawing)[0].split("_")[-2]) in (0, unit):
            yield from children(drawing, "pin")


def _placed(pin: Node, symbol: Node) -> Pin:
    """A pin of a symbol on the sheet; libraries are y up, and turns counter-clockwise."""
    x, y = numbers(child(pin, "at"))[:2]
    left, top, angle = numbers(child(symbol, "at"))
    turn = math.radians(angle)
    cos, sin = round(math.cos(turn)), round(math.sin(turn))
    number, name = (words(child(pin, key))[0] for key in ("number", "name"))
    at = _point(left + x * cos - y * sin, top - x * sin - y * cos)
    return Pin(number, name, words(pin)[0], at)


def _point(x: float, y: float) -> Point:
    return round(x * 1e4), round(y * 1e4)
