"""Silkscreen of a finger's board: cells, labels, references and the title."""

import dataclasses
import math
from collections.abc import Iterator, Sequence

import numpy as np
from shapely import LineString

from lumitip_fab.boards.model import MASK_MM, Placement, Text
from lumitip_fab.boards.silk.page import Page
from lumitip_fab.boards.silk.references import with_references
from lumitip_fab.design import Connector, Finger, Point, Rules, Side


def cell_edges(cells: Sequence[Point], pitch_mm: float) -> list[LineString]:
    """Every edge of the hexagons once, in the order of the cells."""
    around = [
        (
            pitch_mm / math.sqrt(3) * math.cos(math.radians(60 * k)),
            pitch_mm / math.sqrt(3) * math.sin(math.radians(60 * k)),
        )
        for k in range(6)
    ]
    found: dict[Point, LineString] = {}
    for x, y in cells:
        corners = [(x + dx, y + dy) for dx, dy in around]
        for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
            middle = (
                round((start[0] + end[0]) / 2, 3) + 0.0,
                round((start[1] + end[1]) / 2, 3) + 0.0,
            )
            found.setdefault(middle, LineString([start, end]))
    return list(found.values())


_TITLE_MM = 1.0
_LABEL_GAP_MM = 0.3  # between words in a row, so that they are read apart
_OUTWARD_MM = 0.25  # that the first and the last label of a row give way
_STEP_MM = 0.25
_ASIDE_MM = 1.3  # that a label may stand beside the middle of its pad: half a pitch of wires
_SPARE_MM = 0.06  # letters do not stand quite in the middle of their text
_BESIDE_MM = 5.0  # farthest place of the mark of pad 1 from the pad


def with_legend(
    board: Placement, finger: Finger, pitch_mm: float, mark: str, rules: Rules
) -> Placement:
    """The board with its silkscreen.

    Args:
        board: parts in their places.
        finger: for its cells and its connector.
        pitch_mm: of the cells.
        mark: terminal that a bracket round one end of an LED or photodetector means.
        rules: for the least size of letters and lines.

    Raises:
        BuildError: if a label, the mark of pad 1, the title or the arrow has no room, with the
            numbers. References of parts are left out where they have none.
    """
    page = Page(board, rules)
    _labels(page, finger.connector)
    components = with_references(page, cell_edges(finger.cells, pitch_mm), pitch_mm)
    arrows = [_along_the_edges(page), _back(page, finger, mark)]
    if not any(arrows):
        page.miss("the arrow to the tip", 3.0, 1.0, board.outline.centre_mm)
    page.refuse_losses("give it wider margins in [board], or a shorter name")
    return dataclasses.replace(
        board, components=components, silk=tuple(page.strokes), texts=tuple(page.texts)
    )


def _labels(page: Page, wires: Connector) -> None:
    """Signals at the wire pads and, on the back, at the test points; pin 1."""
    half = wires.pad_mm / 2
    _row(page, "front", wires.signals, wires.pads, half)
    x, y = wires.pads[0]
    out = half + np.arange(0.6, _BESIDE_MM, _STEP_MM)
    places = [*((x - d, y) for d in out), *((x, y + s * d) for d in out for s in (-1, 1))]
    if not page.first_free("front", (page.text("1", at) for at in places)):
        page.miss(
            "the mark '1' of the first wire pad",
            page.text("1", (x, y)).height_mm,
            page.length_mm("1"),
            (x, y),
        )
    points = [part for part in page.board.components if part.kind == "test point"]
    for side in ("front", "back"):
        here = sorted((p for p in points if p.side == side), key=lambda p: (p.y_mm, p.x_mm))
        if here:
            at = tuple((part.x_mm, part.y_mm) for part in here)
            half = here[0].footprint.body.length_mm / 2
            _row(
                page, "front" if side == "front" else "back", tuple(p.value for p in here), at, half
            )


def _row(
    page: Page, side: Side, signals: Sequence[str], pads: Sequence[Point], half_mm: float
) -> None:
    """The names of pads in a row: all alike if there is room, else each where it has some."""
    choices = [
        list(_beside(page, signal, at, half_mm)) for signal, at in zip(signals, pads, strict=True)
    ]
    for texts in map(list, zip(*choices, strict=True)):
        flat = texts[0].angle_deg == 0.0
        if flat and len(texts) > 1:
            for end, sign in ((0, -1), (-1, 1)):
                texts[end] = dataclasses.replace(
                    texts[end], x_mm=texts[end].x_mm + sign * _OUTWARD_MM
                )
        if page.free(side, texts, _LABEL_GAP_MM if flat else page.rules.silk_gap_mm):
            page.put(side, texts)
            return
    ends = (pads[0], -1), (pads[-1], 1)
    for signal, at, places in zip(signals, pads, choices, strict=True):
        moved = (
            dataclasses.replace(text, x_mm=text.x_mm + sign * d)
            for d in np.arange(_STEP_MM, _ASIDE_MM, _STEP_MM).tolist()
            for text in places
            for sign in (1, -1)
        )
        outside = (
            text
            for end, sign in ends
            if at == end
            for text in _outside(page, signal, at, half_mm, sign)
        )
        if not page.first_free(side, (*places, *moved, *outside)):
            text = places[0]
            page.miss(f"the label {signal!r}", text.height_mm, page.length_mm(signal), at)


def _beside(page: Page, signal: str, at: Point, half_mm: float) -> Iterator[Text]:
    """Places for the name of a pad in a row: above it, upright above it, both ways below it."""
    x, y = at
    length = page.length_mm(signal)
    text = page.text(signal, at)
    off = half_mm + MASK_MM + page.rules.silk_gap_mm + _SPARE_MM
    flat = off + (text.height_mm + text.width_mm) / 2
    upright = off + length / 2
    for sign in (1, -1):
        yield page.text(signal, (x, y + sign * flat))
        yield page.text(signal, (x, y + sign * upright), angle_deg=90.0)


def _outside(page: Page, signal: str, at: Point, half_mm: float, sign: int) -> Iterator[Text]:
    """Places for the name of the first or last pad of a row, beyond the row's end."""
    x, y = at
    off = half_mm + MASK_MM + page.rules.silk_gap_mm + _SPARE_MM
    for further in np.arange(0.0, _BESIDE_MM, _STEP_MM).tolist():
        yield page.text(signal, (x + sign * (off + page.length_mm(signal) / 2 + further), y))
        yield page.text(
            signal,
            (x + sign * (off + page.text(signal, at).height_mm / 2 + further), y),
            angle_deg=90.0,
        )


def _along_the_edges(page: Page) -> bool:
    """Along the long edges of the front where there is room: arrow to the tip and name; finger,
    revision and design. Tells whether the arrow is there."""
    board, box = page.board, page.board.outline
    ys = np.arange(box.y_max_mm - 2.0, box.y_min_mm, -_STEP_MM).tolist()
    inwards = np.arange(_TITLE_MM, 4.0, _STEP_MM).tolist()
    left, right = (
        [edge + sign * d for d in inwards] for edge, sign in ((box.x_min_mm, 1), (box.x_max_mm, -1))
    )
    arrow = page.arrow("front", ((x, y) for x in left for y in ys))
    revision = f"{board.name} rev {board.revision}  {board.design_hash[:8]}"
    for xs, line in ((left, board.title), (right, revision)):
        for height in (_TITLE_MM, 0.0):
            if page.first_free(
                "front", (page.text(line, (x, y), height, 90.0) for x in xs for y in ys)
            ):
                break
    return arrow


def _back(page: Page, finger: Finger, mark: str) -> bool:
    """On the back, where there are no cells: the whole title, what the marks mean, an arrow.
    Tells whether the arrow is there."""
    board = page.board
    zone = next(zone.box for zone in finger.zones if zone.name == "cells")
    lines = (
        (board.title, 2.0),
        (f"{board.name} board  rev {board.revision}", 1.5),
        (f"design {board.design_hash[:8]}", 1.5),
        (f"bracket: {mark}", 1.2),
    )
    x, y = zone.centre_mm
    room = page.block("back", lines, (x, y))
    if room is None:
        longest = max(page.length_mm(words) for words, _ in lines)
        page.miss(
            "the title on the back",
            page.text("", (x, y)).height_mm * 1.8 * len(lines),
            longest,
            (x, y),
        )
        return False
    x = room.centre_mm[0]
    below = [(x, room.y_min_mm - d) for d in np.arange(0.5, 10.0, _STEP_MM).tolist()]
    return page.arrow("back", [*below, *page.anywhere((x, y))])
