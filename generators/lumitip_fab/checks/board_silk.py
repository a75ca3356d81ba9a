"""Silkscreen of a board, the names of its contacts, fiducials and test points."""

import itertools
import math
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import ReadBoard, lands, placed
from lumitip_fab.checks.readers.kicad_silk import Line, Word
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Point

MARK_MM = 0.15  # that the mark of a part is nearer to pad 1 than to its middle
NAME_MM = 3.0  # from a contact to the name beside it, at most
LABEL_MM = 5.0  # from a name's middle to its contact, at most
LETTER = 0.6  # width of a letter at least, of its height
DOT_MM = 0.1  # longest line that is a dot
_NOISE_MM = 1e-4
_POLAR = re.compile(r"(D|Q|U|Z|LED)\d")  # references of parts that have a first pad
_FIRST = "1"


@dataclass(frozen=True)
class Contact:
    """A pad where someone plugs, solders or probes."""

    pad: str
    at: Point
    """On the board."""
    front: bool
    """Side on which its name is printed."""
    name: str


def measure_prints(read: ReadBoard) -> Iterator[Measurement]:
    """Title and marks of parts; and that all that is printed can be read and is off pads."""
    rules, silk = read.design.rules, read.board.silk
    yield read.count("silk_title", list(_unprinted(read)), "lines")
    if any(map(_POLAR.match, read.parts)):
        yield read.count("silk_marks", [*_unmarked(read), *_first_pad(read)], "parts")
    letters = [word.height_mm for word in silk.words]
    yield read.figure("silk_letters", min(letters, default=math.nan), rules.silk_text_mm, math.inf)
    pens = [line.width_mm for line in silk.lines] + [word.stroke_mm for word in silk.words]
    yield read.figure("silk_lines", min(pens, default=math.nan), rules.silk_line_mm, math.inf)
    yield read.figure("silk_gap", _gap(read), rules.silk_gap_mm - _NOISE_MM, math.inf)


def measure_labels(read: ReadBoard) -> Iterator[Measurement]:
    """The name beside each contact: of all that is printed but references, the nearest, by where
    the word ends; and that it stands nearest to a contact of its name."""
    contacts = list(contacts_of(read))
    if not contacts:
        return
    names = {contact.name for contact in contacts} | set(read.signals)
    wrong = [f"{contact.pad} is missing" for contact in contacts if math.isnan(contact.at[0])]
    refs = {*read.parts, *(device.ref for device in read.components), _FIRST}
    printed = [word for word in read.board.silk.words if word.text not in refs]
    for front in (True, False):
        here = [c for c in contacts if c.front == front and not math.isnan(c.at[0])]
        words = [word for word in printed if word.front == front]
        wrong += _misread(read, here, words)
        wrong += _misleading(read, here, [word for word in words if word.text in names])
    yield read.count("silk_labels", wrong, "contacts")


def measure_targets(read: ReadBoard) -> Iterator[Measurement]:
    """Three fiducials far apart, by which a machine places the parts at the cells; a test point on
    every signal of the cable; and no reference twice."""
    if read.cells_hold:
        marks = [p for p in read.board.parts if p.ref.startswith("FID") and p.front and p.terminals]
        yield read.figure("fiducials", len(marks), 3, 3, "marks")
        apart = [math.dist(a.at, b.at) for a, b in itertools.combinations(marks, 2)]
        least = min(read.box.width_mm, read.box.length_mm) / 2
        yield read.figure("fiducial_spread", min(apart, default=math.nan), least, math.inf)
    if read.signals:
        probed = {read.group(ref, 1) for ref in read.parts if ref.startswith("TP")}
        bare = [signal for signal in read.signals if read.wire(signal) not in probed]
        yield read.count("test_points", bare, "signals")
    count = Counter(part.ref for part in read.board.parts)
    yield read.count("references", [f"{ref} twice" for ref, n in count.items() if n > 1], "parts")


def contacts_of(read: ReadBoard) -> Iterator[Contact]:
    """Wire pads, test points, and rows of contacts with names."""
    for number, signal in enumerate(read.signals, start=1):
        yield Contact(f"J1.{number}", _pad_at(read, "J1", number), True, signal)
        for ref in (ref for ref in read.parts if ref.startswith("TP")):
            if read.wire(signal) == read.group(ref, 1) is not None:
                front = read.parts[ref].front
                yield Contact(f"{ref}.1", _pad_at(read, ref, 1), front, signal)
    for device in (d for d in read.components if d.kind == "test point"):
        front = device.ref not in read.parts or read.parts[device.ref].front
        yield Contact(f"{device.ref}.1", _pad_at(read, device.ref, 1), front, device.value)
    for device in (d for d in read.components if d.contacts):
        for land, name in zip(device.footprint.pads, device.pins, strict=False):
            yield Contact(f"{device.ref}.{land.number}", placed(device, land), True, name)


def _pad_at(read: ReadBoard, ref: str, number: int) -> Point:
    """Place of a pad on the board; NaN if there is none."""
    part = read.parts.get(ref)
    found = [t.at for t in part.terminals if t.number == str(number)] if part else []
    x, y = read.sensor(found)[0] if found else (math.nan, math.nan)
    return float(x), float(y)


def _misread(read: ReadBoard, contacts: list[Contact], words: list[Word]) -> Iterator[str]:
    """Contacts beside which another name is nearest, or none is near."""
    lines = [middle_line(read, word) for word in words]
    for contact in contacts:
        apart = shapely.distance(lines, shapely.Point(contact.at))
        nearest = int(apart.argmin()) if apart.size else -1
        if nearest < 0 or words[nearest].text != contact.name or apart[nearest] > NAME_MM:
            yield f"{contact.pad} is not called {contact.name}"


def _misleading(read: ReadBoard, contacts: list[Contact], words: list[Word]) -> Iterator[str]:
    """Names that stand nearest to a contact of another name, or far from all."""
    for word in words:
        x, y = read.sensor([word.at])[0]
        apart = [math.hypot(c.at[0] - x, c.at[1] - y) for c in contacts]
        nearest = contacts[int(np.argmin(apart))] if apart else None
        if nearest is None or nearest.name != word.text or min(apart) > LABEL_MM:
            yield f"{word.text} stands at {nearest.pad if nearest else 'no contact'}"


def middle_line(read: ReadBoard, word: Word) -> shapely.LineString:
    """Along the middle of a word, from its first letter to its last."""
    turn, half = math.radians(word.angle_deg), LETTER * word.height_mm * len(word.text) / 2
    along = half * np.array([math.cos(turn), -math.sin(turn)])  # the page's y points down
    return shapely.LineString(read.sensor([word.at - along, word.at + along]))


def _unprinted(read: ReadBoard) -> Iterator[str]:
    """Lines of the title that neither side has: name, revision, design, and what the board is or
    its marks mean."""
    title, printed = read.design.title.on_boards(), [w for w in read.board.silk.words if not w.ref]
    lines = [title.name, f"rev {title.revision}", read.design.reading.design_hash[:8]]
    if read.finger:
        lines.append(f"bracket: {read.design.packages.at_cells(read.finger).marked}")
    if read.auxiliary:
        lines.append(read.auxiliary.title)
    for line in lines:
        if not any(line in word.text for word in printed):
            yield f"{line!r} is not printed"


def _unmarked(read: ReadBoard) -> Iterator[str]:
    """Parts with polarity whose mark is not at pad 1."""
    lines = _by_ref(read.board.silk.lines)
    for ref, part in read.parts.items():
        drawn = [line for line in lines.get(ref, ()) if line.front == part.front]
        pads = {t.number: t.copper.area for t in part.terminals if t.copper is not None}
        if _POLAR.match(ref) and ref[:1] != "U" and not _leans(drawn, pads):
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


def _first_pad(read: ReadBoard) -> Iterator[str]:
    """The connector, if no figure 1 stands at its first pad."""
    if not read.signals:
        return
    part = read.parts.get("J1")
    pads = {t.number: t.at for t in part.terminals} if part else {}
    ones = [w for w in read.board.silk.words if w.text == _FIRST and w.front and not w.ref]
    found = set()
    for word in ones if pads else ():
        apart, number = min((math.dist(at, word.at), number) for number, at in pads.items())
        found.add(number if apart <= LABEL_MM else "")
    if found != {_FIRST}:
        yield "J1 has no 1 at pad 1"


def _gap(read: ReadBoard) -> float:
    """The narrowest gap between a line and a pad on its side."""
    worst = math.inf
    for front, layer in ((True, read.board.layers[0]), (False, read.board.layers[-1])):
        lines = [line.area for line in read.board.silk.lines if line.front == front]
        areas = [copper.area for _, _, copper in lands(read.board, layer)]
        if lines and areas:
            tree = shapely.STRtree(areas)
            near = tree.query_nearest(lines, return_distance=True, all_matches=False)[1]
            worst = min(worst, float(near.min()))
    return worst


def _by_ref(lines: Sequence[Line]) -> dict[str, list[Line]]:
    found: dict[str, list[Line]] = {}
    for line in lines:
        found.setdefault(line.ref, []).append(line)
    return found
