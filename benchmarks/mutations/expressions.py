"""KiCad's files: nodes of s-expressions removed, repeated and moved, numbers and words changed."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from numpy.random import Generator

from mutations.amounts import LEAST_MM, Span, changed, cut_short, put
from mutations.damage import Mutators, NotApplicableError

_TOKEN = re.compile(r'\(|\)|"(?:[^"\\]|\\.)*"|[^\s()"]+')
_NUMBER = re.compile(r"[-+]?\d+\.?\d*")
_IDENTITY = frozenset(
    ("tstamp", "uuid", "id", "version", "generator", "path", "date", "options", "descr")
) | {"sheet_instances", "symbol_instances"}
"""Nodes that KiCad makes anew or ignores when it saves a file."""
_LOOKS = frozenset({"effects", "font", "stroke", "color", "paper", "fill", "grid_origin"})
"""Size and colour of texts and lines in a drawing, and where its grid begins: no board differs."""
_DENSE = frozenset({"filled_polygon"})
"""Poured copper: of its hundreds of corners one makes a spike thinner than a fab can etch."""
_PLACED = frozenset(
    ("segment", "via", "footprint", "pad", "gr_line", "gr_arc", "gr_poly", "gr_text", "zone")
) | {"wire", "label", "fp_line"}
"""Nodes of which another one, elsewhere, is a fault; a copy in the same place looks the same."""


@dataclass
class Node:
    """A node, its atoms after the name, and the nodes in it."""

    name: str
    start: int
    end: int = 0
    atoms: list[Span] = field(default_factory=list)
    nodes: list["Node"] = field(default_factory=list)


def parsed(text: str) -> Node:
    """The outermost node of a text."""
    root = Node("", 0)
    stack = [root]
    opened = False
    for token in _TOKEN.finditer(text):
        if token[0] == "(":
            node = Node("", token.start())
            stack[-1].nodes.append(node)
            stack.append(node)
            opened = True
        elif token[0] == ")":
            stack.pop().end = token.end()
            opened = False
        elif opened:
            stack[-1].name, opened = token[0], False
        else:
            stack[-1].atoms.append(token.span())
    return root.nodes[0]


def _within(text: str, node: Node) -> Iterator[Node]:
    """All nodes in a node that matter; of a hidden text it matters what it says, not where."""
    for inner in node.nodes:
        if inner.name in _IDENTITY | _LOOKS or _says_nothing(text, inner):
            continue
        yield inner
        if inner.name not in _DENSE and not _is_hidden(text, inner):
            yield from _within(text, inner)


def _is_hidden(text: str, node: Node) -> bool:
    if node.name not in {"property", "fp_text"}:
        return False
    effects = [a for n in node.nodes if n.name == "effects" for a in n.atoms]
    return any(text[slice(*a)] == "hide" for a in (*node.atoms, *effects))


def _says_nothing(text: str, node: Node) -> bool:
    """An empty property, or a text in whose place KiCad puts the part's own."""
    words = [text[slice(*a)] for a in node.atoms]
    return node.name in {"property", "fp_text"} and bool({'""', '"REF**"'} & set(words))


def _drawn(nodes: list[Node], rng: Generator) -> Node:
    """One of some nodes; each name as often as another."""
    names = sorted({n.name for n in nodes})
    if not names:
        raise NotApplicableError
    name = names[int(rng.integers(len(names)))]
    alike = [n for n in nodes if n.name == name]
    return alike[int(rng.integers(len(alike)))]


def _is_number(text: str, span: Span) -> bool:
    return bool(_NUMBER.fullmatch(text[slice(*span)]))


def _number(data: bytes, rng: Generator) -> tuple[bytes, str]:
    text = data.decode()
    nodes = [n for n in _within(text, parsed(text)) if any(_is_number(text, a) for a in n.atoms)]
    node = _drawn(nodes, rng)
    numbers = [a for a in node.atoms if _is_number(text, a)]
    span = numbers[int(rng.integers(len(numbers)))]
    # Layers, nets and pins have whole numbers; every other number is a length or an angle.
    whole = node.name in {"net", "number", "id", "unit", "0", "31"}
    old = text[slice(*span)]
    return put(
        text,
        span,
        changed(old if whole or "." in old else f"{old}.0", rng, 0 if whole else LEAST_MM),
    )


def _word(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """Another word of the same kind of node, or one with a letter more."""
    text = data.decode()
    nodes = [
        n for n in _within(text, parsed(text)) if any(not _is_number(text, a) for a in n.atoms)
    ]
    node = _drawn(nodes, rng)
    words = [(i, a) for i, a in enumerate(node.atoms) if not _is_number(text, a)]
    place, span = words[int(rng.integers(len(words)))]
    old = text[slice(*span)]
    alike = {
        text[slice(*n.atoms[place])]
        for n in nodes
        if n.name == node.name
        and len(n.atoms) > place
        and (
            place == 0
            or n.atoms[0] == node.atoms[0]
            or text[slice(*n.atoms[0])] == text[slice(*node.atoms[0])]
        )
    }
    others = sorted(alike - {old})
    new = (
        others[int(rng.integers(len(others)))]
        if others
        else (f'{old[:-1]}x"' if old.endswith('"') else f"{old}x")
    )
    return put(text, span, new)


def _removed(data: bytes, rng: Generator) -> tuple[bytes, str]:
    text = data.decode()
    node = _drawn(list(_within(text, parsed(text))), rng)
    new, done = put(text, (node.start, node.end), "")
    return new, done[:300]


def _doubled(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """A second segment, via, pad or line, some distance from the first."""
    text = data.decode()
    node = _drawn([n for n in _within(text, parsed(text)) if n.name in _PLACED], rng)
    places = [
        n for n in _within(text, node) if n.name in {"at", "start", "end", "mid", "center", "xy"}
    ]
    if node.name in {"footprint", "pad", "via", "gr_text", "label"}:
        places = [n for n in node.nodes if n.name == "at"]
    by, copy = round(float(rng.uniform(0.5, 4)), 2), text[node.start : node.end]
    for place in sorted(places, key=lambda n: -n.start):
        low, high = place.atoms[0]
        moved = f"{float(text[low:high]) + by:g}"
        copy = copy[: low - node.start] + moved + copy[high - node.start :]
    new = text[: node.end] + "\n  " + copy + text[node.end :]
    return new.encode(), f"a second one {by:g} mm beside it: {text[node.start : node.end][:150]}"


def _moved(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """A whole node of the board moved: a footprint, a via, a track, a text."""
    text = data.decode()
    node = _drawn(
        [n for n in _within(text, parsed(text)) if any(c.name == "at" for c in n.nodes)], rng
    )
    at = next(c for c in node.nodes if c.name == "at")
    span = at.atoms[int(rng.integers(2))]
    old = text[slice(*span)]
    return put(text, span, changed(old if "." in old else f"{old}.0", rng, LEAST_MM))


KICAD: Mutators = {
    "number": _number,
    "word": _word,
    "remove": _removed,
    "duplicate": _doubled,
    "move": _moved,
    "truncate": cut_short,
}
