"""Silkscreen of a board, fiducials and test points."""

import itertools
import math
import re
from collections import Counter
from collections.abc import Iterator, Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import Read
from lumitip_fab.checks.readers.kicad_board import Part
from lumitip_fab.checks.readers.kicad_silk import Line, Word
from lumitip_fab.checks.result import Measurement

CELL_SHARE = 0.3  # least of a cell's outline that is drawn: pads, parts and holes interrupt it
TO_EDGE_MM = 0.02  # from a drawn line to the outline of its cell
MARK_MM = 0.15  # that the mark of a part is nearer to pad 1 than to its middle
LABEL_MM = 5.0  # from a label to its pad, at most
ARROW_MM = 5.0  # from the word to its arrow, at most
TURN_DEG = 1.0
DOT_MM = 0.1  # longest line that is a dot
NAMED_LETTERS = 6.25  # heights of letters from cell to cell, from which every name has room
NAMED_FIGURES = 2  # in the longest name that has
END_SHARE = 0.5  # least of the columns' ends that are named where not all cells are
_NOISE_MM = 1e-4


def measure_silk(read: Read) -> Iterator[Measurement]:
    """Title, arrow, cells, marks and labels; and that all of it can be read and is off pads."""
    rules, silk = read.design.rules, read.board.silk
    yield read.count("silk_title", list(_untold(read)), "lines")
    yield read.count("silk_arrow", list(_astray(read)), "arrows")
    share, cell = _least_cell(read)
    yield read.figure("silk_cells", share, CELL_SHARE, 1.0, "drawn", f"least of cell {cell}")
    yield read.count("silk_marks", [*_unmarked(read), *_first_pad(read)], "parts")
    yield read.count("silk_labels", list(_unlabelled(read)), "pads")
    yield read.count("silk_cell_names", [*_misnamed(read), *_unnamed(read)], "cells")
    letters = [word.height_mm for word in silk.words]
    yield read.figure("silk_letters", min(letters, default=math.nan), rules.silk_text_mm, math.inf)
    pens = [line.width_mm for line in silk.lines] + [word.stroke_mm for word in silk.words]
    yield read.figure("silk_lines", min(pens, default=math.nan), rules.silk_line_mm, math.inf)
    yield read.figure("silk_gap", _gap(read), rules.silk_gap_mm - _NOISE_MM, math.inf)


def measure_targets(read: Read) -> Iterator[Measurement]:
    """Three fiducials far apart, a test point on every signal, and no name twice."""
    marks = [p for p in read.board.parts if p.ref.startswith("FID") and p.front and p.terminals]
    yield read.figure("fiducials", len(marks), 3, 3, "marks")
    apart = [math.dist(a.at, b.at) for a, b in itertools.combinations(marks, 2)]
    box = read.design.board.box
    least = min(box.width_mm, box.length_mm) / 2
    yield read.figure("fiducial_spread", min(apart, default=math.nan), least, math.inf)
    probed = {read.group(ref, 1) for ref in read.parts if ref.startswith("TP")}
    bare = [s for s in read.finger.connector.signals if read.wire(s) not in probed]
    yield read.count("test_points", bare, "signals")
    count = Counter(part.ref for part in read.board.parts)
    yield read.count("references", [f"{ref} twice" for ref, n in count.items() if n > 1], "parts")


def _untold(read: Read) -> Iterator[str]:
    """Lines of the title that neither side has: name, revision, design, and what marks mean."""
    title, packages = read.design.title.on_boards(), read.design.packages
    chip = packages.at_cells(read.finger)
    printed = [word.text for word in read.board.silk.words if not word.ref]
    digest = read.design.reading.design_hash[:8]
    for line in (title.name, f"rev {title.revision}", digest, f"bracket: {chip.marked}"):
        if not any(line in text for text in printed):
            yield f"{line!r} is not printed"


def _astray(read: Read) -> Iterator[str]:
    """Arrows to the tip that are missing or do not point there."""
    tips = [word for word in read.board.silk.words if word.text == "TIP"]
    if not tips:
        yield "no arrow to the tip"
    for tip in tips:
        turn = _turn_deg(read, tip)
        if not abs(turn) <= TURN_DEG:
            yield f"the arrow at the word on the {'front' if tip.front else 'back'} by {turn:.0f}°"


def _turn_deg(read: Read, tip: Word) -> float:
    """Angle from the tip's direction to the arrow at a word; NaN if there is no arrow.

    Its head is where three lines meet; it points there from their other ends.
    """
    spot = shapely.Point(tip.at)
    near = [
        line.path
        for line in read.board.silk.lines
        if line.front == tip.front and not line.ref and line.path.distance(spot) < ARROW_MM
    ]
    ends = [[(round(x, 3), round(y, 3)) for x, y in shapely.get_coordinates(p)] for p in near]
    met = Counter(end for line in ends for end in (line[0], line[-1]))
    heads = [end for end, count in met.items() if count == 3]
    heads = [head for head in heads if _is_tip(head, ends, tip)]
    if not heads:
        return math.nan
    tails = [line[0] if line[-1] == heads[0] else line[-1] for line in ends if heads[0] in line]
    head, tail = read.sensor([heads[0], np.mean(tails, axis=0)])
    return math.degrees(math.atan2(tail[0] - head[0], head[1] - tail[1]))


def _is_tip(head: tuple[float, float], ends: list[list[tuple[float, float]]], tip: Word) -> bool:
    """Whether lines that meet are an arrow's and not three cells': one is longer than the rest,
    and comes from the word."""
    lengths = {math.dist(line[0], line[-1]): line for line in ends if head in line}
    longest = lengths[max(lengths)]
    tail = longest[0] if longest[-1] == head else longest[-1]
    return max(lengths) > 1.5 * min(lengths) and math.dist(tail, tip.at) < math.dist(head, tip.at)


def _least_cell(read: Read) -> tuple[float, int]:
    """The least share of a cell's outline that is drawn on the front, and which cell it is."""
    sign = read.finger.cells_hold.x_sign
    cells = read.design.cells
    radius = read.design.grid.pitch_mm / math.sqrt(3)
    angles = np.radians(60 * np.arange(7))
    corners = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    middles = np.array([(sign * cell.x_mm, cell.y_mm) for cell in cells])
    hexagons = shapely.linestrings(middles[:, None] + corners[None])
    drawn = [line.path for line in read.board.silk.lines if line.front and not line.ref]
    on_board = shapely.transform(shapely.union_all(drawn), read.sensor)
    near = on_board.buffer(TO_EDGE_MM, cap_style="flat")
    shares = shapely.length(shapely.intersection(hexagons, near)) / shapely.length(hexagons)
    return float(shares.min()), int(shares.argmin())


def _unmarked(read: Read) -> Iterator[str]:
    """Parts with polarity whose mark is not at pad 1."""
    lines = _by_ref(read.board.silk.lines)
    for ref, part in read.parts.items():
        drawn = [line for line in lines.get(ref, ()) if line.front == part.front]
        pads = {t.number: t.copper.area for t in part.terminals if t.copper is not None}
        if ref[:1] in {"D", "Q"} and not _leans(drawn, pads):
            yield f"{ref} has no mark at pad 1"
        if ref[:1] == "U" and _dotted(drawn, pads) != {"1"}:
            yield f"{ref} has no dot at lead 1 alone"


def _leans(drawn: Sequence[Line], pads: dict[str, BaseGeometry]) -> bool:
    """Whether a part's lines lie round its pad 1 rather than round its middle."""
    if not drawn or {"1", "2"} - set(pads):
        return False
    one, other, mark = (
        np.array(shape.centroid.coords[0])
        for shape in (pads["1"], pads["2"], shapely.union_all([line.area for line in drawn]))
    )
    way = (one - other) / np.hypot(*(one - other))
    return float((mark - (one + other) / 2) @ way) >= MARK_MM


def _dotted(drawn: Sequence[Line], pads: dict[str, BaseGeometry]) -> set[str]:
    """Leads that a dot stands at."""
    dots = [line.area for line in drawn if line.path.length < DOT_MM]
    return {
        min((dot.distance(area), number) for number, area in pads.items())[1]
        for dot in dots
        if pads
    }


def _misnamed(read: Read) -> Iterator[str]:
    """Names of cells' parts that stand nearer to another cell than to their own."""
    middles = np.array([(cell.x_mm, cell.y_mm) for cell in read.design.cells])
    middles = middles * (read.finger.cells_hold.x_sign, 1)
    for number, word in _names(read):
        nearest = int(np.hypot(*(middles - read.sensor([word.at])[0]).T).argmin()) + 1
        if number != nearest:
            yield f"{word.ref} stands at cell {nearest - 1}"


def _unnamed(read: Read) -> Iterator[str]:
    """Cells without a name. In narrow ones columns may be named at their ends alone, and at some
    of these there may be no room: between a hole and the edge."""
    cells, named = read.design.cells, {number for number, _ in _names(read)}
    letter_mm, figures = read.design.rules.silk_text_mm, len(str(len(cells)))
    narrow = read.design.grid.pitch_mm < NAMED_LETTERS * letter_mm - _NOISE_MM
    lengths = read.design.grid.columns
    last = {sum(lengths[: column + 1]) for column in range(len(lengths))}
    ends = last | {end - length + 1 for end, length in zip(sorted(last), lengths, strict=True)}
    wanted = set(range(1, len(cells) + 1))
    if (narrow or figures > NAMED_FIGURES) and named <= ends:
        wanted = ends if len(named) < END_SHARE * len(ends) else set()
    yield from (f"cell {number - 1} has no name" for number in sorted(wanted - named))


def _names(read: Read) -> Iterator[tuple[int, Word]]:
    """The names of cells' parts that are printed on the front, each with its figure."""
    for word in read.board.silk.words:
        if re.fullmatch(r"[DQ]\d+", word.ref) and word.text == word.ref and word.front:
            yield int(word.ref[1:]), word


def _first_pad(read: Read) -> Iterator[str]:
    """The connector, if no figure 1 stands at its first pad."""
    if _nearest(read, "1", [read.parts["J1"]] if "J1" in read.parts else [], True) != {"J1.1"}:
        yield "J1 has no 1 at pad 1"


def _unlabelled(read: Read) -> Iterator[str]:
    """Wire pads and test points whose signal is not printed beside them and nowhere else."""
    points = [part for ref, part in read.parts.items() if ref.startswith("TP")]
    wires = [read.parts["J1"]] if "J1" in read.parts else []
    for number, signal in enumerate(read.finger.connector.signals, start=1):
        if _nearest(read, signal, wires, True) != {f"J1.{number}"}:
            yield f"J1.{number} is not labelled {signal}"
        for front in (True, False):
            here = [part for part in points if part.front == front]
            wanted = {f"{p.ref}.1" for p in here if read.group(p.ref, 1) == read.wire(signal)}
            if _nearest(read, signal, here, front) != wanted:
                yield f"{signal} is not at {' and '.join(sorted(wanted)) or 'no test point'}"


def _nearest(read: Read, text: str, parts: Sequence[Part], front: bool) -> set[str]:
    """The pads that a word stands nearest to, of those of some parts on its side."""
    pads = {f"{p.ref}.{t.number}": shapely.Point(t.at) for p in parts for t in p.terminals}
    found = set()
    for word in read.board.silk.words:
        if word.text == text and word.front == front and not word.ref and pads:
            spot = shapely.Point(word.at)
            far, which = min((at.distance(spot), name) for name, at in pads.items())
            found.add(which if far <= LABEL_MM else "")
    return found


def _gap(read: Read) -> float:
    """The narrowest gap between a line and a pad on its side."""
    worst = math.inf
    for front, layer in ((True, read.board.layers[0]), (False, read.board.layers[-1])):
        lines = [line.area for line in read.board.silk.lines if line.front == front]
        pads = [
            t.copper.area
            for part in read.board.parts
            for t in part.terminals
            if t.copper is not None and layer in t.copper.layers
        ]
        if lines and pads:
            tree = shapely.STRtree(pads)
            near = tree.query_nearest(lines, return_distance=True, all_matches=False)[1]
            worst = min(worst, float(near.min()))
    return worst


def _by_ref(lines: Sequence[Line]) -> dict[str, list[Line]]:
    found: dict[str, list[Line]] = {}
    for line in lines:
        found.setdefault(line.ref, []).append(line)
    return found
