"""The netlists for ngspice: each is whole, and what has a part's name has the part's nets and value
on the board."""

from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path

from lumitip_fab.checks.board_read import names_of, ohm
from lumitip_fab.checks.readers.kicad_board import Part, read_board
from lumitip_fab.checks.readers.spice import Element, Netlist, read_netlist
from lumitip_fab.checks.result import Measurement, Subject, unreadable
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError

READS = ("boards/*/*.cir", "boards/*/*.kicad_pcb")
_GROUND = "GND"
_MODELLED = frozenset("BCDLMQR")
"""First letters of elements that stand for a part, or for a property of it."""
_OF_PART = frozenset("DMQ")
"""Those whose last word is a model."""
_RESISTANCE = 0.02
"""How far a resistor may be off its part's value: one may be taken at its worst."""


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every netlist beside a board."""
    if not any(outputs.glob("boards/*/*.cir")):
        yield unreadable("netlists.readable", "boards", "there is no netlist")
    for name in names_of(design):
        yield from measure_board(outputs, design, name)


def measure_board(outputs: Path, _design: Design, name: str) -> Iterator[Measurement]:
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
