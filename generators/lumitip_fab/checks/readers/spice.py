"""Netlists for ngspice: elements, nodes and what is printed."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from lumitip_fab.errors import OutputError

NODES = {"B": 2, "C": 2, "D": 2, "I": 2, "L": 2, "M": 3, "Q": 3, "R": 2, "S": 4, "V": 2, "G": 4}
"""How many nodes follow the name of an element, by its first letter; of an X all but the last."""
_OF_EXPRESSION = re.compile(r"\bv\((\w+)(?:,(\w+))?\)", re.IGNORECASE)
_FIGURE = re.compile(r"([-+]?\d*\.?\d+(?:e[-+]?\d+)?)(meg|[tgkmunpf])?", re.IGNORECASE)
_POWERS = {"t": 12, "g": 9, "meg": 6, "k": 3, "": 0, "m": -3, "u": -6, "n": -9, "p": -12, "f": -15}


@dataclass(frozen=True)
class Element:
    """A line of the circuit."""

    name: str
    nodes: tuple[str, ...]
    rest: tuple[str, ...]
    """Words behind the nodes."""

    @property
    def value(self) -> float | None:
        """Its value in V, A, ohm, farad or henry; none where it is a formula or a model."""
        return figure(self.rest[0]) if self.rest else None


@dataclass(frozen=True)
class Netlist:
    """A netlist with the commands that run it."""

    elements: tuple[Element, ...]
    """Those outside subcircuits."""
    formulas: frozenset[str]
    """Nodes whose voltage a formula reads."""
    models: frozenset[str]
    """Models and subcircuits that it defines."""
    defined: frozenset[str]
    """Names that its commands compute."""
    printed: tuple[str, ...]
    options: tuple[tuple[str, str], ...]
    """Options of the simulator with their values, in the order of the file."""


def read_netlist(path: Path) -> Netlist:
    """The netlist of a file.

    Raises:
        OutputError: if it is missing, has no end, or a line of the circuit is too short.
    """
    try:
        lines = path.read_text(encoding="utf-8").splitlines()[1:]  # the first is a title
    except (OSError, UnicodeDecodeError) as error:
        raise OutputError(f"cannot be read: {error}") from error
    words = [line.split() for line in lines if line.strip() and not line.startswith("*")]
    if not words or words[-1] != [".end"]:
        raise OutputError("has no end")
    elements, models, defined, printed = [], set(), set(), []
    options: list[tuple[str, str]] = []
    inside = ""
    for first, *rest in words:
        match first.lower():
            case ".control" | ".subckt":
                inside = first.lower()
                models |= {*rest[:1]} if inside == ".subckt" else set()
            case ".endc" | ".ends":
                inside = ""
            case ".model":
                models |= {*rest[:1]}
            case ".option" | ".options" | ".opt" | "option":
                options += _pairs(rest)
            case "let":
                defined |= {*rest[:1]}
            case "meas":
                defined |= {*rest[1:2]}
            case "print":
                printed += rest
            case word if not inside and not word.startswith("."):
                elements.append(_element(first, rest))
    texts = [word for element in elements for word in element.rest]
    formulas = {node for text in texts for pair in _OF_EXPRESSION.findall(text) for node in pair}
    return Netlist(
        tuple(elements),
        frozenset(formulas - {""}),
        frozenset(models),
        frozenset(defined),
        tuple(printed),
        tuple(options),
    )


def _pairs(words: list[str]) -> Iterator[tuple[str, str]]:
    """Each `name=value`, however it is spaced."""
    for word in re.sub(r"\s*=\s*", "=", " ".join(words)).split():
        name, _, value = word.partition("=")
        yield name.lower(), value


def figure(text: str) -> float | None:
    """A figure with its power as ngspice reads it; none where there is none."""
    found = _FIGURE.match(text)
    if found is None:
        return None
    scale: float = 10.0 ** _POWERS[(found[2] or "").lower()]
    return float(found[1]) * scale


def _element(name: str, words: list[str]) -> Element:
    count = len(words) - 1 if name[0].upper() == "X" else NODES.get(name[0].upper(), 0)
    if not 0 < count < len(words) + (name[0].upper() == "V"):
        raise OutputError(f"{name} is no element with nodes and a value")
    return Element(name, tuple(words[:count]), tuple(words[count:]))
