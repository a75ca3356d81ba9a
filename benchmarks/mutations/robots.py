"""URDF, xacro and MJCF: attributes changed, elements removed, values swapped."""

import re
from xml.etree import ElementTree

from numpy.random import Generator

from mutations.amounts import changed, cut_short
from mutations.damage import Mutators, NotApplicableError

ElementTree.register_namespace("xacro", "http://www.ros.org/wiki/xacro")
Element = ElementTree.Element
_LOOKS = ("color", "material", "texture")
"""Elements of a robot's looks, which nothing computes with."""
_NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?")
_LEAST = {"xyz": 3e-4, "rpy": 0.01, "pos": 3e-4}
"""Least change of an attribute, in m and rad: of a 0 there is no share."""
_LEAST_INERTIA = 1e-7
"""In kg m², 2 % of the diagonal: products near 0 may be anything much smaller."""


_UNREAD = frozenset({("visual", "name"), ("collision", "name")})
"""Names that no other element refers to."""


def _parsed(data: bytes) -> tuple[Element, list[Element]]:
    root = ElementTree.fromstring(data)
    return root, [e for e in root.iter() if e.tag not in _LOOKS]


def _written(root: Element) -> bytes:
    return b'<?xml version="1.0"?>\n' + ElementTree.tostring(root) + b"\n"


def _named(element: Element) -> str:
    tag = element.tag.rpartition("}")[2]
    return f"<{tag} {' '.join(f'{k}={v!r}' for k, v in element.attrib.items())}>"


def _number(data: bytes, rng: Generator) -> tuple[bytes, str]:
    root, elements = _parsed(data)
    values = [
        (e, k) for e in elements for k, v in e.attrib.items() if _NUMBER.fullmatch(v.split(" ")[0])
    ]
    element, key = values[int(rng.integers(len(values)))]
    words = element.attrib[key].split(" ")
    at = int(rng.integers(len(words)))
    least = _LEAST_INERTIA if element.tag == "inertia" else _LEAST.get(key, 0.0)
    before = _named(element)
    # "0" among lengths is 0.0: a whole metre more would be a coarse fault.
    exact = words[at] if "." in words[at] or not least else f"{words[at]}.0"
    words[at] = changed(exact, rng, least)
    element.set(key, " ".join(words))
    return _written(root), f"{before} has {key}={element.get(key)!r}"


def _word(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """Another word of the same attribute, or one with a letter more."""
    root, elements = _parsed(data)
    words = [
        (e, k)
        for e in elements
        for k, v in e.attrib.items()
        if not _NUMBER.match(v) and (e.tag, k) not in _UNREAD
    ]
    element, key = words[int(rng.integers(len(words)))]
    others = sorted({e.attrib[k] for e, k in words if k == key} - {element.attrib[key]})
    before = _named(element)
    new = others[int(rng.integers(len(others)))] if others else element.attrib[key] + "x"
    element.set(key, new)
    return _written(root), f"{before} has {key}={new!r}"


def _removed(data: bytes, rng: Generator) -> tuple[bytes, str]:
    root, elements = _parsed(data)
    pairs = [(p, c) for p in elements for c in p if c.tag not in _LOOKS]
    parent, child = pairs[int(rng.integers(len(pairs)))]
    parent.remove(child)
    return _written(root), f"{_named(child)} in {_named(parent)} is gone"


def _swapped(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """The values of one attribute in two elements of one tag in each other's place."""
    root, elements = _parsed(data)
    values = [(e, k) for e in elements for k in e.attrib if (e.tag, k) not in _UNREAD]
    element, key = values[int(rng.integers(len(values)))]
    others = [
        e
        for e, k in values
        if k == key and e.tag == element.tag and e.attrib[k] != element.attrib[k]
    ]
    if not others:
        raise NotApplicableError
    other = others[int(rng.integers(len(others)))]
    done = f"{key} of {_named(element)} and of {_named(other)} are swapped"
    element.attrib[key], other.attrib[key] = other.attrib[key], element.attrib[key]
    return _written(root), done


ROBOT: Mutators = {
    "number": _number,
    "word": _word,
    "remove": _removed,
    "swap values": _swapped,
    "truncate": cut_short,
}
