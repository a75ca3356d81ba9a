"""Land patterns of parts that carriers hold, from the dimensions in the catalogue."""

import dataclasses

from lumitip_fab import catalogue
from lumitip_fab.design import Box, Land, Pattern


def row(name: str, ways: int, pitch_mm: float, pad_mm: float, drill_mm: float) -> Pattern:
    """A row of plated holes along x about its middle; the first is square.

    Args:
        name: what its name begins with.
        ways: how many.
        pitch_mm: from hole to hole.
        pad_mm: diameter of the copper.
        drill_mm: diameter of the hole.
    """
    lands = tuple(
        Land(str(i + 1), (i - (ways - 1) / 2) * pitch_mm, 0.0, pad_mm, pad_mm, drill_mm, i > 0)
        for i in range(ways)
    )
    half = (ways * pitch_mm) / 2
    body = Box(-half, half, -pitch_mm / 2, pitch_mm / 2)
    return Pattern(f"{name}_1x{ways:02d}_P{pitch_mm:.2f}mm_D{drill_mm:.1f}mm", lands, body, 0.0)


def chip(letters: str, entry: catalogue.Chip) -> Pattern:
    """A two-terminal part along x, pad 1 to the left.

    Args:
        letters: what its name begins with, such as `CAPC`.
        entry: its dimensions.
    """
    length, width, height = entry.body_mm
    at = entry.pad_pitch_mm / 2
    lands = tuple(
        Land(number, x, 0.0, *entry.pad_mm, 0.0, False) for number, x in (("1", -at), ("2", at))
    )
    size = "".join(f"{int(side * 10 + 1e-9):02d}" for side in (length, width))
    body = Box(-length / 2, length / 2, -width / 2, width / 2)
    return Pattern(f"{letters}{size}X{round(height * 100)}N", lands, body, height)


def raised(pattern: Pattern, height_mm: float) -> Pattern:
    """The same pattern under a part of this height."""
    return dataclasses.replace(pattern, height_mm=height_mm)
