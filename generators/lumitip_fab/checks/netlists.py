"""The netlists for ngspice: each is whole, and what has a part's name has the part's nets and value
on the board."""

from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path

from lumitip_fab.checks.board_read import names_of, ohm
from lumitip_fab.checks.readers.kicad_board import Part, read_board
from lumitip_fab.checks.readers.spice import Element, Netlist, figure, read_netlist
from lumitip_fab.checks.result import Measurement, Subject, unreadable
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError

READS = ("boards/*/*.cir", "boards/*/*.kicad_pcb")
_GROUND = "GND"
_MODELLED = frozenset("BCDLMQR")
"""First letters of elements that stand for a part, or for a property of it."""
_OF_PART = frozenset("DMQ")
"""Those whose last word is a model."""
_RELATIVE = ("reltol", 1e-4)
"""Error of a simulation that figures of three digits allow; ngspice by itself has 1e-3."""
_DEFAULTS = {"abstol": 1e-12, "vntol": 1e-6, "chgtol": 1e-14, "gmin": 1e-12, "trtol": 7.0}
"""Those of ngspice by itself, beyond which no netlist goes."""
_OF_BASES = {"abstol": 1e-15, "chgtol": 1e-17, "gmin": 1e-14}
"""Beside the base current of a detector in the dark, some 0.1 nA."""
_ROOM_C = 26.85
_RESISTANCE = 0.02
"""How far a resistor may be off its part's value: one may be taken at its worst."""


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every netlist beside a board."""
    if not any(outputs.glob("boards/*/*.cir")):
        yield unreadable("netlists.readable", "boards", "there is no netlist")
    for name in names_of(design):
        yield from measure_board(outputs, design, name)


def measure_board(outputs: Path, design: Design, name: str) -> Iterator[Measurement]:
    """Every netlist beside one board."""
    for path in sorted(outputs.glob(f"boards/{name}/*.cir")):
        of = Subject("netlists", path.relative_to(outputs).as_posix())
        try:
            found = read_netlist(path)
            board = read_board(path.parent / f"{path.parent.name}.kicad_pcb")
        except OutputError as error:
            yield unreadable("netlists.readable", of.subject, str(error))
            continue
        parts = {part.ref: part for part in board.parts}
        yield of.count("loose", list(_loose(found)), "nodes, models or figures lead nowhere")
        yield of.count("nets", list(_elsewhere(found, parts)), "parts on other nets")
        yield of.count("values", list(_other_values(found, parts)), "resistors have other values")
        yield of.count("options", list(_loosened(found, design)), "options of the simulator")


def _loose(found: Netlist) -> Iterator[str]:
    """Nodes that one element alone has, models and results that nothing defines."""
    uses = Counter(node for element in found.elements for node in element.nodes)
    uses.update(found.formulas)
    yield from sorted(node for node, number in uses.items() if number < 2)
    for element in found.elements:
        if element.name[0] in _OF_PART | {"S", "X"} and element.rest[0] not in found.models:
            yield f"{element.name} {element.rest[0]}"
    if not found.printed:
        yield "nothing is printed"
    yield from sorted({*found.printed} - found.defined)


def _loosened(found: Netlist, design: Design) -> Iterator[str]:
    """Tolerances that are too loose, temperatures that no figure is of, and other options."""
    bases = any(element.name[0] == "Q" for element in found.elements)
    most = dict([_RELATIVE]) | _DEFAULTS | (_OF_BASES if bases else {})
    known = {
        "temp": {_ROOM_C, *design.electrical.strings.temperatures_c},
        "tnom": {_ROOM_C},
    }
    for name, text in found.options:
        value = figure(text)
        if value not in known.get(name, ()) and not 0 < (value or 0.0) <= most.get(name, 0.0):
            yield f"{name} {text}"
    needed = {_RELATIVE[0], *(_OF_BASES if bases else ())}
    yield from (f"no {name}" for name in sorted(needed - {name for name, _ in found.options}))


def _modelled(found: Netlist, parts: Mapping[str, Part]) -> Iterator[tuple[Element, Part]]:
    """Elements that stand for a part of the board: `R1` for R1, and `CQ5` for a property of Q5."""
    for element in found.elements:
        if element.name[0] in _MODELLED:
            part = parts.get(element.name) or parts.get(element.name[1:])
            if part is not None:
                yield element, part


def _elsewhere(found: Netlist, parts: Mapping[str, Part]) -> Iterator[str]:
    nets = {t.net for part in parts.values() for t in part.terminals}
    for element, part in _modelled(found, parts):
        own = {terminal.net for terminal in part.terminals}
        nodes = {_GROUND if node == "0" else node for node in element.nodes}
        whole = element.name == part.ref and len(part.terminals) == 2 and nodes <= nets
        if not nodes & nets <= own or (whole and nodes != own):
            yield f"{element.name} at {', '.join(sorted(nodes & nets))}"


def _other_values(found: Netlist, parts: Mapping[str, Part]) -> Iterator[str]:
    for element, part in _modelled(found, parts):
        if element.name == part.ref and element.name[0] == "R":
            value = element.value
            wanted = ohm(part.value)
            if value is None or not abs(value - wanted) <= _RESISTANCE * wanted:
                yield f"{element.name} {' '.join(element.rest[:1])}, not {part.value}"
