"""S-expressions as KiCad writes them."""

import re
from collections.abc import Iterator
from typing import Any

from sexpdata import Symbol

Value = str | int | float | tuple["Value", ...]
Node = tuple[Value, ...]
"""`("at", 1.0, 2.0)`: the first is the keyword; a `Quoted` is written between quotes."""

FORMAT = 20211014
"""Version of the file format: that of KiCad 6, which 6 to 10 open."""
_WIDTH = 160


class Quoted(str):
    """Text that is written between quotes."""

    __slots__ = ()


def number(value: float) -> str:
    """A length or an angle to 1 nm, without needless zeros and without minus zero."""
    digits = f"{value:.6f}".rstrip("0").rstrip(".")
    return "0" if digits in {"-0", ""} else digits


def written(node: Node) -> str:
    """A node as text that ends with a line feed."""
    return "\n".join(_lines(node, 0)) + "\n"


def _lines(node: Node, depth: int) -> Iterator[str]:
    """One line where it fits; else the keyword with its plain values, then a line per node."""
    indent = "  " * depth
    if not any(isinstance(v, tuple) for v in node):
        yield indent + _flat(node)
        return
    flat = _fitting(node, _WIDTH - len(indent))
    if flat is not None:
        yield indent + flat
        return
    plain = 0
    while plain < len(node) and not isinstance(node[plain], tuple):
        plain += 1
    yield indent + "(" + " ".join(_flat(v) for v in node[:plain])
    packed = ""
    for value in node[plain:]:
        text = _flat(value)
        if node[0] == "pts":  # points are many and short: as many on a line as fit
            if packed and len(indent) + len(packed) + len(text) + 3 > _WIDTH:
                yield f"{indent}  {packed}"
                packed = ""
            packed = f"{packed} {text}" if packed else text
        elif isinstance(value, tuple):
            yield from _lines(value, depth + 1)
        else:
            yield f"{indent}  {text}"
    if packed:
        yield f"{indent}  {packed}"
    yield indent + ")"


def _fitting(node: Node, room: int) -> str | None:
    """A node as one line of at most so many letters; no more of it is written than shows that it
    is longer."""
    written_so_far = ["(" + _flat(node[0])]
    room -= len(written_so_far[0]) + 1
    for value in node[1:]:
        text = _fitting(value, room - 1) if isinstance(value, tuple) else _flat(value)
        if text is None or len(text) + 1 > room:
            return None
        written_so_far.append(text)
        room -= len(text) + 1
    return " ".join(written_so_far) + ")"


def _flat(value: Value) -> str:
    if isinstance(value, tuple):
        return "(" + " ".join(_flat(v) for v in value) + ")"
    if isinstance(value, Quoted):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
        return f'"{escaped}"'
    if isinstance(value, bool):
        raise TypeError("write yes or no: KiCad's files know no other truth values")
    return number(value) if isinstance(value, int | float) else value


def as_node(tree: list[Any]) -> Node:
    """A tree of sexpdata or kicad-skip, in which `None` stands where something was deleted."""
    return tuple(_value(value) for value in tree if value is not None)


def _value(value: Any) -> Value:
    if isinstance(value, list):
        return as_node(value)
    if isinstance(value, Symbol) and re.fullmatch(r"[\w-]+", str(value)):
        return str(value)
    if type(value) is str:
        return Quoted(value)
    if isinstance(value, int | float):
        return value
    raise TypeError(f"{value!r} cannot stand in a schematic")
