"""`Gauge`: where the printed gauge's edges and strips lie in the gap; the contents of `gauge.json`.

`lumitip-fab` writes the file beside `layout.json`. The gauge is clamped between the fingers, with
either end, once with its rails on the receiver and once on the emitter.
"""

import hashlib
import json
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from lumitip.errors import LumitipError
from lumitip.twin.built import Piece
from lumitip.values import as_float, shown

SCHEMA_VERSION = 1
_KINDS, _ON = ("edge", "strip"), ("receiver", "emitter")
_NUMBERS = {  # least and most of each
    "offset_mm": (-100.0, 100.0),
    "angle_deg": (-360.0, 360.0),
    "low_mm": (0.0, 20.0),
    "high_mm": (0.0, 20.0),
    "width_mm": (0.0, 100.0),
}


class GaugeError(LumitipError, ValueError):
    """A `gauge.json` that cannot be used; the message names every field that is wrong."""


@dataclass(frozen=True)
class Placement:
    """One way in which the gauge is clamped between the fingers."""

    name: str
    on: str
    """The finger that its rails hug, `"receiver"` or `"emitter"`; its place is known on that."""
    piece: Piece
    """In the receiver's sensor frame, with the fingers closed on the gauge."""


@dataclass(frozen=True)
class Gauge:
    """The gauge of a design."""

    design_hash: str
    """Of the layout that it was made for."""
    gap_mm: float
    """Between the skins of fingers that are closed on it."""
    placements: tuple[Placement, ...]
    sha256: str
    """Of the text of its file."""

    @classmethod
    def load(cls, path: str | Path) -> "Gauge":
        """Read a `gauge.json`.

        Raises:
            GaugeError: if it is not the file of a gauge; the message names every fault.
        """
        try:
            text = Path(path).read_bytes().decode()
        except (OSError, UnicodeDecodeError) as error:
            raise GaugeError(
                f"{path}: cannot be read ({error}). `lumitip-fab build` writes it beside "
                "layout.json, if the design has a gauge card"
            ) from None
        return cls.from_json(text, str(path))

    @classmethod
    def from_json(cls, text: str, name: str = "gauge.json") -> "Gauge":
        """The gauge of the text of a `gauge.json`; `name` is that of the file, for errors.

        Raises:
            GaugeError: as of `load`.
        """
        try:
            record = json.loads(text)
        except (ValueError, RecursionError) as error:
            raise GaugeError(f"{name}: no JSON ({error})") from None
        if faults := list(_faults(record)):
            raise GaugeError(f"{name}: " + "; ".join(faults))
        return cls(
            record["design_hash"],
            float(record["gap_mm"]),
            tuple(_placement(each) for each in record["placements"]),
            hashlib.sha256(text.encode()).hexdigest(),
        )


def in_gap(placement: Placement, gauge: Gauge, gap_mm: float) -> Piece:
    """The piece between fingers whose gap is not the gauge's: it lies against the finger that its
    rails hug."""
    if placement.on == "receiver":
        return placement.piece
    up = gap_mm - gauge.gap_mm
    piece = placement.piece
    return replace(piece, low_mm=piece.low_mm + up, high_mm=piece.high_mm + up)


def _placement(record: dict[str, Any]) -> Placement:
    numbers = {name: float(record[name]) for name in _NUMBERS}
    return Placement(record["name"], record["on"], Piece(record["kind"], **numbers))


def _faults(record: Any) -> Iterator[str]:
    if not isinstance(record, dict):
        yield "an object is needed"
        return
    version = record.get("schema_version")
    if isinstance(version, bool) or version != SCHEMA_VERSION:
        version = shown(record.get("schema_version"))
        yield f"schema_version is {version}; this version reads {SCHEMA_VERSION}"
        return
    if not isinstance(record.get("design_hash"), str):
        yield f"design_hash is {shown(record.get('design_hash'))}; a text is needed"
    yield from _number(record, "gap_mm", 0.1, 20.0)
    placements = record.get("placements")
    if not isinstance(placements, list) or not placements:
        yield f"placements is {shown(placements)}; a list of one or more is needed"
        return
    faults = [
        f"placements[{number}]: {fault}"
        for number, each in enumerate(placements)
        for fault in _placement_faults(each)
    ]
    yield from faults
    if faults:
        return
    for name, allowed in (("kind", _KINDS), ("on", _ON)):
        if missing := [one for one in allowed if all(each[name] != one for each in placements)]:
            yield f'no placement has {name} "{missing[0]}"; each {name} is needed'
    if any(each["high_mm"] > as_float(record.get("gap_mm")) for each in placements):
        yield "a placement's high_mm is above gap_mm"


def _placement_faults(record: Any) -> Iterator[str]:
    if not isinstance(record, dict):
        yield f"is {shown(record)}; an object is needed"
        return
    if not isinstance(record.get("name"), str) or not record["name"]:
        yield f"name is {shown(record.get('name'))}; a text is needed"
    for name, allowed in (("kind", _KINDS), ("on", _ON)):
        if record.get(name) not in allowed:
            choice = " or ".join(f'"{one}"' for one in allowed)
            yield f"{name} is {shown(record.get(name))}; {choice} is needed"
    numbers = [
        fault for name, limits in _NUMBERS.items() for fault in _number(record, name, *limits)
    ]
    yield from numbers
    if numbers:
        return
    if not record["low_mm"] < record["high_mm"]:
        yield (
            f"low_mm is {record['low_mm']:g}, high_mm {record['high_mm']:g}; high_mm must be the "
            "larger"
        )
    if record.get("kind") == "strip" and not record["width_mm"] > 0.0:
        yield f"width_mm is {record['width_mm']:g}; a strip needs a width above 0"


def _number(record: dict[str, Any], name: str, least: float, most: float) -> Iterator[str]:
    value = record.get(name)
    plain = isinstance(value, int | float) and not isinstance(value, bool)
    number = as_float(value) if plain else math.nan
    if not least <= number <= most:
        yield f"{name} is {shown(value)}; a number from {least:g} to {most:g} is needed"
