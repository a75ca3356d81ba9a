"""The note on printing and wrapping: what it states, against the page and the design."""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lumitip_fab.checks.mask_flaps import Flap, side_mm
from lumitip_fab.checks.mask_page import PageError
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Design, Finger

ROUNDED_MM = 0.051  # the note has one decimal
TENTH_MM = 0.1  # reach: of the least height, which is sampled
_ROW = re.compile(r"^\| (\d+) \| ([\d.]+) \| ([\d.]+) \| (-?[\d.]+) \|$", re.MULTILINE)
_COUNT = re.compile(r"The (\d+) apertures")
_SIDE = re.compile(r"\(([\d.]+) mm of silicone and\s+plate\)")
_READINGS = re.compile(r"made for\s+`\[([\d.]+), ([\d.]+)\]`")


def measure_note(
    outputs: Path,
    subject: str,
    flaps: tuple[Flap, ...],
    numbers: tuple[int, ...],
    finger: Finger,
    design: Design,
) -> Iterator[Measurement]:
    """The table of flaps against the page's, and the other figures against the design.

    Raises:
        PageError: if the note is missing or does not state them.
    """
    try:
        text = (outputs / subject).read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise PageError(f"cannot be read: {error!r:.200}") from error
    rows = {int(n): (float(w), float(h), float(r)) for n, w, h, r in _ROW.findall(text)}
    count, side, readings = _COUNT.search(text), _SIDE.search(text), _READINGS.search(text)
    if not rows or not count or not side or not readings:
        raise PageError("does not state flaps, apertures, height of the side or readings")
    odd = len(set(numbers) ^ rows.keys())
    yield Measurement("mask.note", f"{subject} rows", odd, 0, 0, "flaps", "missing or too many")
    off = np.array([
        np.abs(np.array(rows[n]) - _figures(flap, design))
        for n, flap in zip(numbers, flaps, strict=True) if n in rows
    ]).reshape(-1, 3)  # fmt: skip
    for name, column, limit in (("width", 0, ROUNDED_MM), ("length", 1, ROUNDED_MM),
                                ("reach", 2, TENTH_MM)):  # fmt: skip
        worst = float(off[:, column].max()) if len(off) else np.nan
        yield Measurement("mask.note", f"{subject} {name}", worst, 0, limit, "mm",
                          "worst row against the A4 page")  # fmt: skip
    whole = design.stack.plate_mm + design.stack.cover_mm
    told = np.array([float(v) for v in (count[1], side[1], *readings.groups())])
    wanted = np.array([len(finger.cells), whole, *design.mask.measured_ruler_mm])
    yield Measurement("mask.note", f"{subject} figures", float(np.abs(told - wanted).max()), 0,
                      ROUNDED_MM, "", "apertures, height of the side, readings")  # fmt: skip


def _figures(flap: Flap, design: Design) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Width of the fold, length, and how far it lies onto the back, mm."""
    width = float(np.hypot(*(flap.fold[1] - flap.fold[0])))
    onto = flap.length_mm + design.mask.allowance_mm - float(side_mm(flap.fold, design).min())
    return np.array([width, flap.length_mm, onto])
