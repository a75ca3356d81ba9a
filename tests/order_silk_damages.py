"""Damages of the words in a silkscreen of a zip of the small receiver."""

import re
from math import dist
from pathlib import Path

from lumitip_fab.checks.readers.kicad_board import read_board
from lumitip_fab.checks.readers.kicad_silk import Word
from lumitip_fab.design.frames import on_board_page

_ORIGIN_MM = on_board_page((0.0, 0.0))
_PLACE = re.compile(r"X(-?\d+)Y(-?\d+)(D0[12]\*)")


def words_exchanged(text: str, board: Path) -> str:
    """The strokes of two names in each other's places."""
    one, other = _printed(board, "GND"), _printed(board, "3V3")
    return _moved(text, {one: other, other: one})


def word_moved(text: str, board: Path) -> str:
    """A name 0.2 mm to the right of its place."""
    x, y = _printed(board, "GND")
    return _moved(text, {(x, y): (x + 0.2, y)})


def reference_exchanged(text: str, board: Path) -> str:
    """Two references of devices exchanged."""
    one, other = _printed(board, "Q2"), _printed(board, "Q5")
    return _moved(text, {one: other, other: one})


def _printed(board: Path, text: str) -> tuple[float, float]:
    """Middle of a word on the front, in the sensor frame."""

    def wanted(word: Word) -> bool:
        return word.front and word.text == text

    x, y = next(w.at for w in read_board(board).silk.words if wanted(w))
    return x - _ORIGIN_MM[0], _ORIGIN_MM[1] - y


def _moved(text: str, ways: dict[tuple[float, float], tuple[float, float]]) -> str:
    """A layer whose strokes at each place are at another one."""

    def put(found: re.Match[str]) -> str:
        x, y = (int(number) / 1e6 for number in found.groups()[:2])
        start = min(ways, key=lambda at: dist(at, (x, y)))
        if abs(start[0] - x) > 1.2 or abs(start[1] - y) > 0.6:
            return found[0]
        end = ways[start]
        place = [round(1e6 * (p + b - a)) for p, a, b in zip((x, y), start, end, strict=True)]
        return f"X{place[0]:011d}Y{place[1]:011d}{found[3]}"

    return _PLACE.sub(put, text)
