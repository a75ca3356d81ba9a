"""The masks as files against the design and against each other."""

import math
import re
from collections.abc import Generator, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lumitip_fab.checks.mask_bands import (
    bands_of,
    folds_of,
    measure_bands,
    measure_numbers,
    numbers_of,
)
from lumitip_fab.checks.mask_drawings import Drawing, read_dxf, read_svg
from lumitip_fab.checks.mask_flaps import Flap, flaps_of, measure_flaps, side_mm
from lumitip_fab.checks.mask_holes import (
    Black,
    Placed,
    apart,
    black_of,
    cut_of,
    edges_apart,
    place,
    registration_of,
    sort_out,
)
from lumitip_fab.checks.mask_print import measure_black, measure_page
from lumitip_fab.checks.readers.mask_page import PageError, Points, read_page
from lumitip_fab.checks.result import Measurement, unreadable
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
    off = np.array(
        [
            np.abs(np.array(rows[n]) - _figures(flap, design))
            for n, flap in zip(numbers, flaps, strict=True)
            if n in rows
        ]
    ).reshape(-1, 3)
    for name, column, limit in (
        ("width", 0, ROUNDED_MM),
        ("length", 1, ROUNDED_MM),
        ("reach", 2, TENTH_MM),
    ):
        worst = float(off[:, column].max()) if len(off) else np.nan
        yield Measurement(
            "mask.note", f"{subject} {name}", worst, 0, limit, "mm", "worst row against the A4 page"
        )
    whole = design.stack.plate_mm + design.stack.cover_mm
    printed = np.array([float(v) for v in (count[1], side[1], *readings.groups())])
    wanted = np.array([len(finger.cells), whole, *design.mask.measured_ruler_mm])
    yield Measurement(
        "mask.note",
        f"{subject} figures",
        float(np.abs(printed - wanted).max()),
        0,
        ROUNDED_MM,
        "",
        "apertures, height of the side, readings",
    )


def _figures(flap: Flap, design: Design) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Width of the fold, length, and how far it lies onto the back, mm."""
    width = float(np.hypot(*(flap.fold[1] - flap.fold[0])))
    onto = flap.length_mm + design.mask.allowance_mm - float(side_mm(flap.fold, design).min())
    return np.array([width, flap.length_mm, onto])


READS = ("mask/*.pdf", "mask/*.svg", "mask/*.dxf", "mask/*_wrapping.md")

PAPERS_MM = {"a4": (210.0, 297.0), "letter": (215.9, 279.4)}
_PAGE = ("page", "marks", "scale_x", "scale_y", "ruler", "mirrored", "fonts")
_BLACK = ("count", "position", "size", "shape", "web", "outline", "window", "clear")
_FLAPS = ("flaps", "folds", "reach")
_BANDS = ("bands", "numbers")
SAME_MM = 0.01
Finding = Iterator[Measurement]
FACING_MM = 0.02  # both may be off by the tolerance of a place


@dataclass(frozen=True, eq=False)
class Seen:
    """The black of one finger on one paper."""

    subject: str
    black: Black
    cut: Points
    flaps: tuple[Flap, ...]
    numbers: tuple[int, ...]
    bands: tuple[Points, ...]


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Read every file of both masks."""
    seen: dict[tuple[str, str], Seen] = {}
    for finger in design.fingers:
        for paper in PAPERS_MM:
            subject = f"mask/{finger.name}_mask_{paper}.pdf"
            found = yield from _paper(outputs, subject, finger, paper, design)
            if found:
                seen[finger.name, paper] = found
        reference = seen.get((finger.name, "a4"))
        yield from _note(outputs, finger, design, reference)
        yield from _svg(outputs, finger, design, reference)
        yield from _dxf(outputs, finger, design, reference)
    for paper in PAPERS_MM:
        yield _facing(paper, seen.get(("emitter", paper)), seen.get(("receiver", paper)))


def _paper(
    outputs: Path, subject: str, finger: Finger, paper: str, design: Design
) -> Generator[Measurement, None, Seen | None]:
    """Everything about one PDF; returns its black if it could be read."""
    names: tuple[str, ...] = (*_PAGE, *_BLACK, *_FLAPS, *_BANDS)
    try:
        page = read_page(outputs / subject)
        placed = place(registration_of(page), design.mask)
        yield from measure_page(subject, page, placed, PAPERS_MM[paper], design.mask)
        names = (*_BLACK, *_FLAPS, *_BANDS)
        black, cut = black_of(page, placed), cut_of(page, placed)
    except PageError as error:
        yield from _unreadable(names, subject, error)
        return None
    yield from measure_black(subject, page, placed, black, finger, design)
    flaps: tuple[Flap, ...] = ()
    numbers: tuple[int, ...] = ()
    bands: tuple[Points, ...] = ()
    try:
        flaps = flaps_of(cut, folds_of(page, placed, np.array(design.mask.registration)))
        yield from measure_flaps(subject, flaps, len(cut), black.edge, finger, design)
        numbers = numbers_of(page, placed, flaps)
        yield measure_numbers(subject, flaps, numbers)
        names = ("bands",)
        bands = bands_of(page, placed)
        yield from measure_bands(subject, flaps, bands, black.edge, design)
    except PageError as error:
        yield from _unreadable(names if names == ("bands",) else (*_FLAPS, *_BANDS), subject, error)
    return Seen(subject, black, cut, flaps, numbers, bands)


def _note(outputs: Path, finger: Finger, design: Design, reference: Seen | None) -> Finding:
    subject = f"mask/{finger.name}_wrapping.md"
    if not reference or not reference.flaps:
        yield unreadable("mask.note", subject, "no flaps on an A4 page to compare with")
        return
    try:
        flaps, numbers = reference.flaps, reference.numbers
        yield from measure_note(outputs, subject, flaps, numbers, finger, design)
    except PageError as error:
        yield from _unreadable(("note",), subject, error)


def _svg(outputs: Path, finger: Finger, design: Design, reference: Seen | None) -> Finding:
    subject = f"mask/{finger.name}_mask.svg"
    try:
        drawing = read_svg(outputs / subject)
        placed = place(drawing.marks, design.mask)
        black = sort_out(placed.subpath(run) for run in drawing.black)
    except PageError as error:
        yield from _unreadable(("svg",), subject, error)
        return
    yield from _same("svg", subject, black, placed, reference)
    yield from _same_flaps("svg", subject, drawing, placed, reference)


def _dxf(outputs: Path, finger: Finger, design: Design, reference: Seen | None) -> Finding:
    subject = f"mask/{finger.name}_mask.dxf"
    try:
        drawing = read_dxf(outputs / subject)
        placed = place(drawing.marks, design.mask)
        black = sort_out(placed.subpath(run) for run in drawing.black)
    except PageError as error:
        yield from _unreadable(("dxf", *_FLAPS), subject, error)
        return
    yield from _same("dxf", subject, black, placed, reference)
    yield from _same_flaps("dxf", subject, drawing, placed, reference)
    cut = placed.points(drawing.cut)
    if reference:
        worst = edges_apart(cut, reference.cut)
        yield Measurement("mask.dxf", f"{subject} cut", worst, 0, SAME_MM, "mm", "against A4")
    try:
        flaps = flaps_of(cut, tuple(placed.points(fold) for fold in drawing.folds))
    except PageError as error:
        yield from _unreadable(_FLAPS, subject, error)
        return
    yield from measure_flaps(subject, flaps, len(cut), black.edge, finger, design)


def _same(name: str, subject: str, black: Black, placed: Placed, reference: Seen | None) -> Finding:
    """A drawing is 1:1, and its black is the same as on A4."""
    check = f"mask.{name}"
    stretch = max(abs(s - 1) for s in placed.scale)
    yield Measurement(check, f"{subject} scale", stretch, 0, 1e-4, "", "off 1:1 by its marks")
    if not reference:
        yield unreadable(check, subject, "no A4 page to compare with")
        return
    other = reference.black
    count = abs(len(black.centres) - len(other.centres))
    yield Measurement(check, f"{subject} count", count, 0, 0, "apertures", "more or less")
    worst = max(
        apart(black.centres, other.centres),
        abs(black.size_mm.min() - other.size_mm.min()),
        abs(black.size_mm.max() - other.size_mm.max()),
        float(black.misshape_mm.max()),
        _windows_apart(black.window, other.window),
        edges_apart(black.edge, other.edge),
    )
    yield Measurement(check, subject, worst, 0, SAME_MM, "mm", f"worst against {reference.subject}")


def _same_flaps(
    name: str, subject: str, drawing: Drawing, placed: Placed, reference: Seen | None
) -> Finding:
    """A drawing's bands and folds are those of A4."""
    if not reference or not reference.flaps or not reference.bands:
        return
    for what, drawn, other in (
        ("bands", drawing.bands, reference.bands),
        ("folds", drawing.folds, tuple(flap.fold for flap in reference.flaps)),
    ):
        same = len(drawn) == len(other) and len(drawn) > 0
        worst = apart(placed.points(np.concatenate(drawn)), np.concatenate(other)) if same else None
        yield Measurement(
            f"mask.{name}",
            f"{subject} {what}",
            math.inf if worst is None else worst,
            0,
            SAME_MM,
            "mm",
            f"{len(drawn)} against {len(other)} on A4",
        )


def _windows_apart(a: Points, b: Points) -> float:
    return apart(a, b) if len(a) and len(b) else math.inf


def _facing(paper: str, emitter: Seen | None, receiver: Seen | None) -> Measurement:
    """LED i faces detector i: the emitter's apertures turned about y are the receiver's."""
    subject = f"mask/*_mask_{paper}.pdf"
    if not emitter or not receiver:
        return unreadable("mask.facing", subject, "a mask is missing or cannot be read")
    turned = emitter.black.centres * np.array([-1.0, 1.0])
    worst = apart(turned, receiver.black.centres)
    return Measurement("mask.facing", subject, worst, 0, FACING_MM, "mm", "worst pair of apertures")


def _unreadable(names: tuple[str, ...], subject: str, error: PageError) -> Finding:
    return (unreadable(f"mask.{name}", subject, str(error)) for name in names)
