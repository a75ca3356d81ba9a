"""Land patterns of parts that carriers hold, from the dimensions in the catalogue."""

import dataclasses

from lumitip_fab.catalogue import electronics
from lumitip_fab.catalogue.controllers import Leaded, Module, Strip
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


def chip(letters: str, entry: electronics.Chip) -> Pattern:
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


def rows(name: str, strip: Strip) -> Pattern:
    """Two rows of plated holes along x, counted counter-clockwise from the lower left."""
    ways, pitch = strip.ways, strip.pitch_mm
    lands = []
    for i in range(2 * ways):
        place, y = (i, -pitch / 2) if i < ways else (2 * ways - 1 - i, pitch / 2)
        x = (place - (ways - 1) / 2) * pitch
        lands.append(Land(str(i + 1), x, y, strip.pad_mm, strip.pad_mm, strip.drill_mm, i > 0))
    body = Box(-ways * pitch / 2, ways * pitch / 2, -pitch, pitch)
    full_name = f"{name}_2x{ways:02d}_P{pitch:.2f}mm_D{strip.drill_mm:.2f}mm"
    return Pattern(full_name, tuple(lands), body, strip.height_mm)


def leaded(entry: Leaded) -> Pattern:
    """Leads in two rows along x, lead 1 at the lower left; a row with less leads is centred."""
    along, across = entry.lead_pad_mm
    low = (len(entry.names) + 1) // 2
    high = len(entry.names) - low
    y = (entry.lead_span_mm - along) / 2
    lands = []
    for i in range(low + high):
        count, place, side = (low, i, -1) if i < low else (high, low + high - 1 - i, 1)
        x = (place - (count - 1) / 2) * entry.lead_pitch_mm
        lands.append(Land(str(i + 1), x, side * y, across, along, 0.0, False))
    length, width, height = entry.body_mm
    body = Box(-length / 2, length / 2, -width / 2, width / 2)
    pitch, span = round(entry.lead_pitch_mm * 100), round(entry.lead_span_mm * 100)
    name = f"SOT{pitch}P{span}X{round(height * 100)}-{low + high}N"
    return Pattern(name, tuple(lands), body, height)


def module(entry: Module) -> Pattern:
    """A module with its antenna at the top."""
    lands = tuple(
        Land(str(i), x, y, width, height, 0.0, False)
        for i, (x, y, width, height) in enumerate(entry.pads_mm, start=1)
    )
    width, length, height = entry.body_mm
    body = Box(-width / 2, width / 2, -length / 2, length / 2)
    return Pattern(f"Module_{entry.order_number}", lands, body, height)


def fiducial(diameter_mm: float) -> Pattern:
    """A round mark for the placing machine's camera."""
    body = Box(0.0, 0.0, 0.0, 0.0).grown(diameter_mm / 2)
    land = Land("1", 0.0, 0.0, diameter_mm, diameter_mm, 0.0, True)
    return Pattern(f"Fiducial_D{diameter_mm:.1f}mm", (land,), body, 0.0)
