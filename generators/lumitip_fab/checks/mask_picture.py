"""The masks as a printer sees them: the pixels of each page against the design."""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lumitip_fab.checks.mask_black import MEASURES, WRONG_MM2, Seen
from lumitip_fab.checks.mask_holes import place
from lumitip_fab.checks.mask_marks import Part, marks_on, parts_on, rulers_on
from lumitip_fab.checks.readers.drawn import dxf_picture, svg_picture
from lumitip_fab.checks.readers.mask_page import PageError
from lumitip_fab.checks.readers.pixels import Picture, page_pictures
from lumitip_fab.checks.result import Measurement, Subject, measured, unreadable
from lumitip_fab.design import Design, Finger

READS = ("mask/*_mask_*.pdf", "mask/coupon_*.pdf", "mask/*_mask.svg", "mask/*_mask.dxf")
BLACK = ("BLACK", "WINDOW", "APERTURES")
"""Layers of the DXF that are one area with openings."""

PAPERS_MM = {"a4": (210.0, 297.0), "letter": (215.9, 279.4)}
PAPER_MM = 0.1
RULER_MM = 0.1
EDGE_MM = 0.05  # of the coupon
FIGURE_MM = 0.5  # from the middle of a figure to its tick
_RULER = 100
_BESIDE_MM = 7.0  # from the middle of a ruler to its figures
_PAST_MM = 3.0  # an end of it
_BARE_MM = 0.5  # of bare paper round the coupon


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every page of both masks, and of the coupon."""
    for paper in PAPERS_MM:
        for finger in design.fingers:
            yield from _paper(outputs, f"{finger.name}_mask", paper, finger, design)
        yield from _paper(outputs, "coupon", paper, None, design)
    for finger in design.fingers:
        yield from _drawing(outputs, "svg", finger, design)
        yield from _drawing(outputs, "dxf", finger, design)


def _drawing(outputs: Path, kind: str, finger: Finger, design: Design) -> Iterator[Measurement]:
    """A drawing, which is 1:1."""
    file = Subject("mask_picture", f"mask/{finger.name}_mask.{kind}")
    path = outputs / file.subject
    try:
        picture = svg_picture(path) if kind == "svg" else dxf_picture(path, BLACK)
        parts = parts_on(picture)
        seen = _placed(file, picture, parts, (1.0, 1.0), finger, design)
    except PageError as error:
        yield unreadable("mask_picture.readable", file.subject, str(error))
        return
    yield file.figure("readable", len(parts), 1, math.inf, "parts")
    yield from measured(MEASURES, seen)


def _paper(
    outputs: Path, stem: str, paper: str, finger: Finger | None, design: Design
) -> Iterator[Measurement]:
    """One page: the mask of a finger, or the coupon."""
    page = Subject("mask_picture", f"mask/{stem}_{paper}.pdf")
    try:
        picture, shown = page_pictures(outputs / page.subject)
        yield from _page(page, picture, shown, PAPERS_MM[paper])
        if finger is None:
            yield from _coupon(page, picture, design)
            return
        parts = parts_on(picture)
        across, up = (100 / reading for reading in design.mask.measured_ruler_mm)
        yield from _rulers(page, picture, parts, (across, up))
        seen = _placed(page, picture, parts, (across, up), finger, design)
    except PageError as error:
        yield unreadable("mask_picture.readable", page.subject, str(error))
        return
    yield page.figure("readable", len(parts), 1, math.inf, "parts")
    yield from measured(MEASURES, seen)


def _page(
    page: Subject, picture: Picture, shown: Picture, size_mm: tuple[float, float]
) -> Iterator[Measurement]:
    """Its size as it is shown; and what is printed is what a screen shows."""
    for side, got, wanted in zip(("width", "height"), picture.size_mm, size_mm, strict=True):
        yield page.near("page", got, wanted, PAPER_MM, "as it is shown", at=side)
    other = int(np.count_nonzero(picture.grey != shown.grey))
    yield page.figure("printed", other, 0, 0, "pixels", "other on paper than on a screen")


def _rulers(
    page: Subject, picture: Picture, parts: tuple[Part, ...], scale: tuple[float, float]
) -> Iterator[Measurement]:
    """Both rulers: each tick in its place from the first, and each figure at its tick."""
    found = {ruler.along: ruler for ruler in rulers_on(picture, parts)}
    wanted = np.arange(_RULER + 1.0)
    for along, at in enumerate(("horizontal", "vertical")):
        if along not in found or len(found[along].ticks_mm) != len(wanted):
            yield unreadable("mask_picture.ruler", f"{page.subject}: {at}", "no ruler of 101 ticks")
            continue
        ticks = found[along].ticks_mm / scale[along]
        off = float(np.abs(ticks - ticks[0] - wanted).max())
        yield page.figure("ruler", off, 0, RULER_MM, note="worst tick by the first", at=at)
        beside = [
            (int(word.text), place - ticks[0])
            for word in picture.words
            if word.text.isdecimal()
            and len(word.text) <= len(str(_RULER))
            and abs(word.middle_mm[1 - along] - found[along].across_mm) < _BESIDE_MM
            and ticks[0] - _PAST_MM < (place := word.middle_mm[along] / scale[along])
            and place < ticks[-1] + _PAST_MM
        ]
        missing = {n for n, _ in beside} ^ set(range(0, _RULER + 1, 10))
        off = max((abs(n - place) for n, place in beside), default=math.inf)
        yield page.figure(
            "figures", math.inf if missing else off, 0, FIGURE_MM, note="off its tick", at=at
        )


def _placed(
    page: Subject,
    picture: Picture,
    parts: tuple[Part, ...],
    scale: tuple[float, float],
    finger: Finger,
    design: Design,
) -> Seen:
    """The black of a picture by its four marks.

    Raises:
        PageError: if they are not seen.
    """
    marks = np.array(design.mask.registration)
    found = marks_on(picture, parts, float(np.ptp(marks[:, 0])) * scale[0])
    placed = place(found, design.mask)
    black = picture.part(found.min(axis=0), found.max(axis=0))
    return Seen(page.prefix, page.subject, black, placed, scale, finger, design)


def _coupon(page: Subject, picture: Picture, design: Design) -> Iterator[Measurement]:
    """One black block in the middle of the page, 1:1."""
    box, middle = design.mask.coupon, picture.size_mm / 2
    half = np.array([box.width_mm, box.length_mm]) / 2
    block = picture.part(middle - half - _BARE_MM, middle + half + _BARE_MM)
    more_mm2 = float(block.ink.sum() * block.pixel_mm.prod()) - 4 * half.prod()
    off = abs(more_mm2) / (4 * half.sum())
    yield page.figure("coupon", off, 0, EDGE_MM, note="of an edge, by its ink")
    inside = picture.part(middle - half + _BARE_MM, middle + half - _BARE_MM)
    light = np.count_nonzero(inside.grey) * inside.pixel_mm.prod()
    yield page.figure("black", light, 0, WRONG_MM2, "mm²", "that is not black")
