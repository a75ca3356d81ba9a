"""Damages of copper, edge, words and attributes in a zip of the small receiver, each with the
checks that must fail."""

import re
from collections.abc import Callable
from itertools import combinations
from math import dist
from pathlib import Path

from lumitip_fab.checks.readers.kicad_board import Copper, read_board
from lumitip_fab.design.frames import on_board_page
from order_silk_damages import reference_exchanged, word_moved, words_exchanged

Files = dict[str, bytes]
Change = Callable[[str, Path], str]
_ORIGIN_MM = on_board_page((0.0, 0.0))


def _tracks(board: Path) -> list[Copper]:
    return [c for c in read_board(board).loose if c.kind == "track" and "F.Cu" in c.layers]


def _middle(track: Copper) -> tuple[float, float]:
    """In the sensor frame."""
    at = track.area.centroid
    return at.x - _ORIGIN_MM[0], _ORIGIN_MM[1] - at.y


def _drawn(text: str, pen_mm: float, *points: tuple[float, float], dark: bool = True) -> str:
    """A layer with a line, or a dot at one point, above all else."""
    places = [f"X{round(x * 1e6):011d}Y{round(y * 1e6):011d}" for x, y in points]
    moves = [places[0] + "D02*", *(f"{p}D01*" for p in places[1:])]
    moves = moves if len(points) > 1 else [places[0] + "D03*"]
    polarity = "%LPD*%" if dark else "%LPC*%"
    lines = "\n".join((f"%ADD99C,{pen_mm}*%", polarity, "D99*", *moves, "M02*"))
    return text.replace("M02*", lines)


def short(text: str, board: Path) -> str:
    """A hair between the nearest tracks of two nets."""
    pairs = [(a, b) for a, b in combinations(_tracks(board), 2) if a.net != b.net]
    one, other = min(pairs, key=lambda pair: dist(_middle(pair[0]), _middle(pair[1])))
    return _drawn(text, 0.05, _middle(one), _middle(other))


def cut(text: str, board: Path) -> str:
    """A gap in the longest track."""
    track = max(_tracks(board), key=lambda t: t.area.area)
    return _drawn(text, 1.2 * track.width_mm, _middle(track), dark=False)


def pad_lost(text: str, board: Path) -> str:
    """The first pad of the first photodetector is gone."""
    (part,) = (part for part in read_board(board).parts if part.ref == "Q1")
    x, y = part.terminals[0].at
    return _drawn(text, 2.0, (x - _ORIGIN_MM[0], _ORIGIN_MM[1] - y), dark=False)


def _lower_side(text: str) -> tuple[str, float]:
    """The stroke of the lower side of the edge, and its height (mm)."""
    stroke = re.search(r"X-\d+Y(-\d+)D02\*\nX\d+Y\1D01\*", text)
    assert stroke
    return stroke[0], int(stroke[1]) / 1e6


def notch(text: str, _: Path) -> str:
    """2 mm deep, in the lower side."""
    stroke, y = _lower_side(text)
    corners = (0.0, y), (0.0, y + 2.0), (3.0, y + 2.0), (3.0, y)
    places = [f"X{round(a * 1e6):011d}Y{round(b * 1e6):011d}D01*" for a, b in corners]
    begin, end = stroke.split("\n")
    return text.replace(stroke, "\n".join((begin, *places, end)))


def gap(text: str, _: Path) -> str:
    """The edge without its lower side."""
    stroke, _y = _lower_side(text)
    return text.replace(stroke, stroke.replace("D01*", "D02*"))


def replaced(old: str, new: str) -> Change:
    return lambda text, _: text.replace(old, new)


def nets_exchanged(text: str, _: Path) -> str:
    """Ground and a signal by each other's names."""
    names = {"GND": "S0", "S0": "GND"}
    return re.sub(r"(?<=%TO\.N,)(GND|S0)(?=\*)", lambda m: names[m[1]], text)


COPPER_DAMAGES: dict[str, tuple[str, Change, set[str]]] = {
    "short": ("F_Cu.gbr", short, {"copper", "short", "names"}),
    "cut": ("F_Cu.gbr", cut, {"copper", "open", "names"}),
    "pad lost": ("F_Cu.gbr", pad_lost, {"copper", "bare", "names"}),
    "notch": ("Edge_Cuts.gbr", notch, {"routed"}),
    "open edge": ("Edge_Cuts.gbr", gap, {"routed"}),
    "layer of the other side": ("F_Cu.gbr", replaced("L1,Top", "L2,Bot"), {"roles"}),
    "no polarity": ("F_Cu.gbr", replaced("%TF.FilePolarity,Positive*%\n", ""), {"roles"}),
    "mask as a positive": ("F_Mask.gbr", replaced("Negative", "Positive"), {"roles"}),
    "another origin": ("B_Silkscreen.gbr", replaced("Coordinates,S", "Coordinates,X"), {"roles"}),
    "holes without copper": (
        "-PTH.drl",
        replaced("Plated,1,2,PTH", "NonPlated,1,2,NPTH"),
        {"roles"},
    ),
    "repeated ten times": (
        "F_Cu.gbr",
        replaced("%LPD*%", "%LPD*%\n%SRX1Y10I0J30*%"),
        {"readable"},
    ),
    "no origin": (
        "B_Silkscreen.gbr",
        replaced("%TF.SameCoordinates,Sensor*%\n", ""),
        {"roles"},
    ),
    "names exchanged": ("F_Silkscreen.gbr", words_exchanged, {"letters"}),
    "name moved": ("F_Silkscreen.gbr", word_moved, {"letters"}),
    "references exchanged": ("F_Silkscreen.gbr", reference_exchanged, {"letters"}),
    "nets exchanged": ("F_Cu.gbr", nets_exchanged, {"names"}),
    "nets without a name": (
        "B_Cu.gbr",
        lambda text, _: re.sub(r"%TO\.N,.*\n", "", text),
        {"names"},
    ),
    "another pad": ("F_Cu.gbr", replaced("%TO.P,Q1,1*%", "%TO.P,Q1,2*%"), {"names"}),
    "a part of no board": ("F_Cu.gbr", replaced("%TO.P,Q1,1*%", "%TO.P,Q99,1*%"), {"names"}),
    "repeated": ("F_Cu.gbr", replaced("%LPD*%", "%LPD*%\n%SRX2Y1I50J0*%"), {"readable"}),
}
"""File, damage, and the checks that fail."""
