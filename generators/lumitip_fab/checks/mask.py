"""The masks as files against the design and against each other."""

import math
from collections.abc import Generator, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely

from lumitip_fab.checks.mask_drawings import Drawing, read_dxf, read_svg
from lumitip_fab.checks.mask_flaps import (
    Flap,
    bands_of,
    flaps_of,
    folds_of,
    measure_bands,
    measure_flaps,
)
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
from lumitip_fab.checks.mask_print import measure_black, measure_note, measure_page
from lumitip_fab.checks.readers.mask_page import Page, PageError, Points, read_page
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.design import Design, Finger

READS = ("mask/*.pdf", "mask/*.svg", "mask/*.dxf", "mask/*_wrapping.md")

PAPERS_MM = {"a4": (210.0, 297.0), "letter": (215.9, 279.4)}
_PAGE = ("page", "marks", "scale_x", "scale_y", "ruler", "mirrored", "fonts")
_BLACK = ("count", "position", "size", "shape", "web", "outline", "window", "clear")
_FLAPS = ("flaps", "folds", "reach")
_BANDS = ("bands", "numbers")
SAME_MM = 0.01
Finding = Iterator[Measurement]
_SAME_MM = 0.01  # of flaps on both sides
_MIRROR_MM = 0.05
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
        for kind in ("svg", "dxf"):
            yield from _drawing(outputs, kind, finger, design, reference)
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


def _drawing(
    outputs: Path, kind: str, finger: Finger, design: Design, reference: Seen | None
) -> Finding:
    """A drawing against the A4 page; the DXF has cut lines, and with them flaps of its own."""
    subject, cuts = f"mask/{finger.name}_mask.{kind}", kind == "dxf"
    try:
        drawing = (read_dxf if cuts else read_svg)(outputs / subject)
        placed = place(drawing.marks, design.mask)
        black = sort_out(placed.subpath(run) for run in drawing.black)
    except PageError as error:
        yield from _unreadable((kind, *_FLAPS) if cuts else (kind,), subject, error)
        return
    yield from _same(kind, subject, black, placed, reference)
    yield from _same_flaps(kind, subject, drawing, placed, reference)
    if not cuts:
        return
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
        note, off = f"{len(drawn)} against {len(other)} on A4", math.inf if worst is None else worst
        yield Measurement(f"mask.{name}", f"{subject} {what}", off, 0, SAME_MM, "mm", note)


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


def numbers_of(page: Page, placed: Placed, flaps: tuple[Flap, ...]) -> tuple[int, ...]:
    """The number printed on each flap; 0 where there is not exactly one."""
    middles = placed.points(page.texts.reshape(-1, 4, 2).mean(axis=1))
    numbers = [
        (int(word), shapely.Point(at))
        for word, at in zip(page.words, middles, strict=True)
        if word.isdecimal()
    ]
    found = []
    for flap in flaps:
        area = shapely.Polygon(flap.corners)
        on_it = [number for number, at in numbers if area.contains(at)]
        found.append(on_it[0] if len(on_it) == 1 else 0)
    return tuple(found)


def measure_numbers(subject: str, flaps: tuple[Flap, ...], numbers: tuple[int, ...]) -> Measurement:
    """Flaps out of order: the tip, the gripper end, then both sides from wide to narrow."""
    at = dict(zip(numbers, flaps, strict=True))
    wrong = len(set(range(1, len(flaps) + 1)) - at.keys())
    if not wrong:
        middles = {n: flap.fold.mean(axis=0) for n, flap in at.items()}
        up_mm = {n: float(middle[1]) for n, middle in middles.items()}
        wrong += max(up_mm, key=up_mm.__getitem__) != 1
        # A wide gripper end has more flaps than two, at the same height.
        wrong += sum(up_mm[n] > min(up_mm.values()) + _MIRROR_MM for n in (2, 3))
        for n in range(2, len(flaps), 2):
            wrong += not np.allclose(middles[n] * (-1.0, 1.0), middles[n + 1], atol=_MIRROR_MM)
            wrong += n > 4 and _width_mm(at[n]) > _width_mm(at[n - 1]) + _SAME_MM
    return Measurement("mask.numbers", subject, wrong, 0, 0, "flaps", "out of order")


def _width_mm(flap: Flap) -> float:
    return float(np.hypot(*(flap.fold[1] - flap.fold[0])))
