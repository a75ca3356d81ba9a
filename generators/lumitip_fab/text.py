"""Text in the letters and signs that each medium has: PDF pages, silkscreen, Markdown, part values;
and texts that stand in files beside the code."""

import re
import tomllib
import unicodedata
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path
from string import digits
from typing import Any

from anyascii import anyascii

LONGEST = 32
"""Most characters of a name, and of what it becomes."""


def page_letters(text: str) -> str:
    """The text with each character that the PDFs' typeface lacks transliterated."""
    whole = unicodedata.normalize("NFC", text)
    return "".join(c if _on_pages(c) else anyascii(c) for c in whole)


def page_name(text: str) -> str:
    """A name in the letters of the PDFs, where there is room for one line."""
    return _shortened(page_letters(text))


def board_name(text: str) -> str:
    """A name in ASCII, the only letters of a silkscreen."""
    return _shortened(anyascii(unicodedata.normalize("NFC", text)))


def _on_pages(character: str) -> bool:
    return character == "\n" or any(first <= ord(character) <= last for first, last in PAGE_LETTERS)


def _shortened(text: str) -> str:
    return text if len(text) <= LONGEST else text[:LONGEST].rstrip()


_SIGNS = re.compile(r"[\\`*\[\]<>&|#~!]|(?<![A-Za-z0-9])_|_(?![A-Za-z0-9])")
"""Markdown signs within a line; a `_` counts only if it is not between letters or digits."""


def as_written(text: str) -> str:
    """A text for a heading, a sentence or a cell of a table, not for the beginning of a line."""
    return _SIGNS.sub(r"\\\g<0>", text)


def listed(names: list[str]) -> str:
    """Names as a sentence has them, such as `"a, b and c"`."""
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))


def runs(refs: Iterable[str]) -> str:
    """References as a sentence has them, three or more that follow one another as `"R1 to R4"`."""
    found: list[list[str]] = []
    for ref in refs:
        letters = ref.rstrip(digits)
        before = f"{letters}{int(ref[len(letters) :] or 0) - 1}"
        if found and found[-1][-1] == before:
            found[-1].append(ref)
        else:
            found.append([ref])
    return listed(
        [name for run in found for name in ([f"{run[0]} to {run[-1]}"] if len(run) > 2 else run)]
    )


def resistor_code(ohm: float) -> str:
    """The value as printed on drawings and in order numbers: 150R, 4K99, 75K, 1M."""
    power, letter = next((p, c) for p, c in ((6, "M"), (3, "K"), (0, "R")) if ohm >= 10**p or not p)
    digits = f"{ohm / 10**power:.4g}"
    return digits.replace(".", letter) if "." in digits else digits + letter


def coded_ohm(code: str) -> float:
    """The resistance (ohm) of such a code."""
    (letter,) = (each for each in code if each.isalpha())
    return float(code.replace(letter, ".")) * {"R": 1.0, "K": 1e3, "M": 1e6}[letter]


def passage(file: str, name: str) -> str:
    """A passage of a text file of this package, such as `mask/wrapping.md`.

    A line `=== name` begins each passage, which has no line break at its end.

    Raises:
        KeyError: if the file has no such passage.
        ValueError: if two passages of it have one name.
    """
    return _passages(file)[name]


@lru_cache
def _passages(file: str) -> dict[str, str]:
    _, *parts = re.split(r"^=== (\w+)\n", data_file(file), flags=re.MULTILINE)
    names = parts[::2]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise ValueError(f"{file}: two passages each for {', '.join(twice)}")
    texts = (part.removesuffix("\n") for part in parts[1::2])
    return dict(zip(names, texts, strict=True))


@lru_cache
def table_of(file: str) -> dict[str, Any]:
    """A table of this package in TOML, such as `docs/spec.toml`."""
    return tomllib.loads(data_file(file))


def data_file(file: str) -> str:
    """A text file of this package, such as `mask/creasing.svg`."""
    return (Path(__file__).parent / file).read_text(encoding="utf-8")


PAGE_LETTERS = (
    (0x20, 0x7E),
    (0xA1, 0xAC),
    (0xAE, 0x24F),
    (0x384, 0x3FF),
    (0x400, 0x525),
    (0x1E00, 0x1EFB),
    (0x1F00, 0x1FFF),
    (0x2010, 0x2027),
    (0x2030, 0x205E),
    (0x20A0, 0x20B5),
    (0x2122, 0x2122),
    (0x2126, 0x2126),
    (0x2190, 0x21FF),
    (0x2200, 0x22FF),
)
"""Latin, Greek, Cyrillic, punctuation, arrows and mathematics, all of them in the typeface of the
PDFs, which sets letters from left to right and joins none."""
