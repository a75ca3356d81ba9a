"""Firmware, and the notes and manual that people read."""

import re

from numpy.random import Generator

from mutations.amounts import (
    cut_short,
    doubled,
    number_changed,
    one_of,
    put,
    removed,
    spans,
    swapped,
    word_changed,
)
from mutations.damage import Mutators

# A comment is read by nobody who uses the fingertip: its numbers and words may differ.
_COMMENT = re.compile(r"//.*|/\*(?:.|\n)*?\*/")
_LINE = re.compile(r"^(?!\s*(?://|$)).*\n", re.MULTILINE)
_C_NUMBER = re.compile(r"(?<![\w.])(?:0x[0-9a-fA-F]+|\d+)(?![\w.])")
_C_NAME = re.compile(r"\b(?!(?:include|define|ifdef|ifndef|endif|pragma|once)\b)[A-Za-z_]\w{2,}\b")
_SIGN = re.compile(r"[{}();,<>=+\-*/|]")
_INCLUDE_ONCE = re.compile(r"#pragma once|#include <[^>]+>|//.*")


def _c_number(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """A number of the code, hexadecimal ones too, changed by one or more."""
    text = data.decode()
    span = one_of(list(spans(text, _C_NUMBER, _COMMENT)), rng)
    old = text[slice(*span)]
    value = int(old, 0) if old.startswith("0x") else int(old)
    new = value + max(1, round(value * rng.uniform(0.03, 0.5)))
    return put(text, span, hex(new) if old.startswith("0x") else str(new))


SOURCE: Mutators = {
    "number": _c_number,
    "word": word_changed(_C_NAME, _COMMENT),
    "remove": removed(_LINE, _INCLUDE_ONCE),
    "syntax": removed(_SIGN, _COMMENT),
    "swap words": swapped(_C_NAME, _COMMENT),
    "truncate": cut_short,
}

# What a reader of the note sees; links and pictures are text too.
_PARAGRAPH = re.compile(r"(?:^.*\S.*\n)+", re.MULTILINE)
_UNIT = re.compile(r"(?<=\d )(?:mm|g|min|h|V|mA|N|ml)\b|(?<=\d )°C")
_NUMBERING = re.compile(r"^\s*\d+\.", re.MULTILINE)
"""Markdown counts the items of a list itself."""
MARKDOWN: Mutators = {
    "number": number_changed(skip=_NUMBERING),
    "word": word_changed(),
    "remove": removed(_PARAGRAPH),
    "duplicate": doubled(_PARAGRAPH),
    "swap paragraphs": swapped(_PARAGRAPH),
    "unit": word_changed(_UNIT),
    "truncate": cut_short,
}

# Tags, styles and pictures in base64 are not text; a picture has its own file in the folder.
_TAG = re.compile(r"<style>.*?</style>|<[^>]*>|&\w+;", re.DOTALL)
_BLOCK = re.compile(r"<(p|li|tr|h2|h3)\b[^>]*>.*?</\1>\n?", re.DOTALL)
_IMAGE = re.compile(r"<img [^>]*>")


def _block(data: bytes, rng: Generator) -> tuple[str, tuple[int, int]]:
    text = data.decode()
    return text, one_of([m.span() for m in _BLOCK.finditer(text)], rng)


def _block_removed(data: bytes, rng: Generator) -> tuple[bytes, str]:
    text, (start, end) = _block(data, rng)
    return (text[:start] + text[end:]).encode(), f"gone: {text[start:end][:100]!r}"


def _block_doubled(data: bytes, rng: Generator) -> tuple[bytes, str]:
    text, (start, end) = _block(data, rng)
    return (text[:end] + text[start:]).encode(), f"there twice: {text[start:end][:100]!r}"


def _blocks_swapped(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """Two blocks of one kind in each other's place."""
    text = data.decode()
    found = list(_BLOCK.finditer(text))
    one = found[int(rng.integers(len(found)))]
    others = [m for m in found if m[1] == one[1] and m[0] != one[0]]
    other = others[int(rng.integers(len(others)))]
    a, b = sorted([one, other], key=lambda m: m.start())
    new = text[: a.start()] + b[0] + text[a.end() : b.start()] + a[0] + text[b.end() :]
    return new.encode(), f"swapped: {a[0][:80]!r} and {b[0][:80]!r}"


HTML: Mutators = {
    "number": number_changed(skip=_TAG),
    "word": word_changed(skip=_TAG),
    "remove": _block_removed,
    "duplicate": _block_doubled,
    "swap paragraphs": _blocks_swapped,
    "remove a picture": removed(_IMAGE),
    "unit": word_changed(_UNIT, _TAG),
    "truncate": cut_short,
}
