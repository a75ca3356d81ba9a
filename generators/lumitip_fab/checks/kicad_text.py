"""KiCad's files as nested lists."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Union

from lumitip_fab.errors import OutputError

Node = list[Union["Node", str]]
_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|[()]|[^\s()"]+')
_ESCAPE = re.compile(r"\\(.)", re.DOTALL)


def read_nodes(path: Path) -> Node:
    """The file's one expression: `["kicad_pcb", ["version", "20211014"], …]`.

    Raises:
        OutputError: if it cannot be read or is no such expression.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise OutputError(f"{path}: cannot be read: {error}") from error
    whole: Node = []
    open_: list[Node] = [whole]
    for token in _TOKEN.findall(text):
        if token == "(":
            open_.append([])
            open_[-2].append(open_[-1])
        elif token == ")":
            if len(open_) == 1:
                raise OutputError(f"{path}: is no KiCad file: a ')' too many")
            open_.pop()
        else:
            open_[-1].append(_ESCAPE.sub(r"\1", token[1:-1]) if token[0] == '"' else token)
    if len(open_) != 1 or len(whole) != 1 or not isinstance(whole[0], list) or not whole[0]:
        raise OutputError(f"{path}: is no KiCad file, or is cut short")
    return whole[0]


def children(node: Node, *names: str) -> Iterator[Node]:
    """The nodes below one that have any of these names."""
    for child in node:
        if isinstance(child, list) and child and child[0] in names:
            yield child


def child(node: Node, name: str) -> Node | None:
    """The first node below one that has a name."""
    return next(children(node, name), None)


def words(node: Node | None) -> list[str]:
    """The plain values of a node, without its name."""
    return [value for value in (node or [])[1:] if isinstance(value, str)]


def numbers(node: Node | None) -> tuple[float, ...]:
    """The values of a node that are numbers."""
    return tuple(float(value) for value in words(node) if _is_number(value))


def _is_number(value: str) -> bool:
    try:
        float(value)
    except ValueError:
        return False
    return True
