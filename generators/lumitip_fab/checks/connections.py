"""Connections of a board, followed along its copper and not by the names of nets: pieces that are
connected, and which detector each multiplexer input reads.

Knows the 74HC4051 and its kin (CD4051, MAX4051 …: 8:1, 16 leads) and the 74HC4067 and its kin
(16:1, 24 leads), whatever the part is called on the board. Leads are numbered alike in all their
packages; see the makers' datasheets.
"""

import re
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.readers.kicad_board import Copper, KicadBoard, Part, Terminal, read_board
from lumitip_fab.errors import OutputError

TOUCH_MM = 1e-5
_STRETCH = 12  # edges
Pairs = NDArray[np.int64]
ChannelMap = dict[str, dict[str, str]]
"""`{"U1": {"0": "Q7", …}, …}`."""


class Clusters:
    """The pieces of copper of a board, in groups that are connected."""

    def __init__(self, board: KicadBoard) -> None:
        self.pieces = tuple(board.copper())
        self.layers = board.layers
        count = len(self.pieces)
        found = [pairs for _, pairs in self.near(TOUCH_MM)]
        a, b = np.concatenate([np.empty((0, 2), dtype=np.int64), *found]).T
        links = coo_array((np.ones(a.size), (a, b)), shape=(count, count))
        _, labels = connected_components(links, directed=False)
        self.label: NDArray[np.int64] = np.asarray(labels, dtype=np.int64)
        self._of = {id(piece): int(label) for piece, label in zip(self.pieces, labels, strict=True)}

    def of(self, piece: Copper) -> int:
        """Number of the group that a piece belongs to."""
        return self._of[id(piece)]

    def near(self, distance_mm: float) -> Iterator[tuple[str, Pairs]]:
        """Pairs of pieces, shape `(n, 2)`, no farther apart than this on a layer."""
        for layer in self.layers:
            here = np.array([i for i, p in enumerate(self.pieces) if layer in p.layers], dtype=int)
            areas = np.array([self.pieces[i].area for i in here], dtype=object)
            yield layer, here[_pairs(areas, distance_mm)]

    def gaps(self, within_mm: float) -> Iterator[tuple[float, Copper, Copper]]:
        """Pieces that are not connected but nearer than this, with their distance.

        Fills have very many corners: of those, short stretches of the edge are held against the
        others.
        """
        for layer in self.layers:
            here = [(i, p) for i, p in enumerate(self.pieces) if layer in p.layers]
            cut = [(i, part) for i, p in here for part in _stretches(p)]
            which = np.array([i for i, _ in cut], dtype=int)
            shapes = np.array([part for _, part in cut], dtype=object)
            a, b = _pairs(shapes, within_mm).T
            apart = self.label[which[a]] != self.label[which[b]]
            a, b = a[apart], b[apart]
            for gap, i, j in zip(
                shapely.distance(shapes[a], shapes[b]), which[a], which[b], strict=True
            ):
                yield float(gap), self.pieces[i], self.pieces[j]

    def nets(self) -> dict[int, set[str]]:
        """The net names in each group; copper without a name has none."""
        found: dict[int, set[str]] = defaultdict(set)
        for label, piece in zip(self.label, self.pieces, strict=True):
            found[int(label)].update({piece.net} - {""})
        return found

    def groups(self) -> dict[str, set[int]]:
        """The groups that hold pads of each net: more than one where it is open."""
        found: dict[str, set[int]] = defaultdict(set)
        for label, piece in zip(self.label, self.pieces, strict=True):
            if piece.kind == "pad" and piece.net:
                found[piece.net].add(int(label))
        return found


def _pairs(shapes: NDArray[np.object_], distance_mm: float) -> Pairs:
    """Pairs of shapes no farther apart than this, shape `(n, 2)`, the smaller number first."""
    if not shapes.size:
        return np.empty((0, 2), dtype=np.int64)
    shapely.prepare(shapes)
    a, b = shapely.STRtree(shapes).query(shapes, predicate="dwithin", distance=distance_mm)
    return np.asarray(np.stack([a, b], axis=1)[a < b])


def _stretches(piece: Copper) -> list[BaseGeometry]:
    """The piece itself; of a fill its edge, cut up."""
    if piece.kind != "fill":
        return [piece.area]
    rings = [shapely.get_coordinates(ring) for ring in shapely.get_rings(piece.area)]
    return [
        shapely.LineString(ring[i : i + _STRETCH + 1])
        for ring in rings
        for i in range(0, len(ring) - 1, _STRETCH)
    ]


@dataclass(frozen=True)
class Pinout:
    """The leads of a kind of multiplexer."""

    name: re.Pattern[str]
    leads: int
    inputs: tuple[str, ...]
    """Lead of each channel."""
    select: tuple[str, ...]
    output: str
    rails: tuple[str, ...]
    """Supplies and enable."""


PINOUTS = (
    Pinout(
        re.compile(r"40\s?51"),
        16,
        ("13", "14", "15", "12", "1", "5", "2", "4"),
        ("11", "10", "9"),
        "3",
        ("16", "8", "7", "6"),
    ),
    Pinout(
        re.compile(r"40\s?67"),
        24,
        ("9", "8", "7", "6", "5", "4", "3", "2", "23", "22", "21", "20", "19", "18", "17", "16"),
        ("10", "11", "14", "13"),
        "1",
        ("24", "12", "15"),
    ),
)
_LEAST_READ = 2  # detectors that an unnamed part must read to be taken for a multiplexer
_NO_DETECTOR = re.compile(r"(R|C|L|FB|TP|J|H|FID)(\d|\?|$)", re.IGNORECASE)


@dataclass(frozen=True)
class Channels:
    """Contents of a board."""

    by_copper: ChannelMap
    by_name: ChannelMap
    """By the names of nets that the file gives to the pads."""
    output: Mapping[str, str]
    """Net at the common terminal of each multiplexer."""
    parts: Mapping[str, tuple[Part, Pinout]]
    doubts: tuple[str, ...] = field(default=())
    """Where copper and names disagree, in words."""

    @property
    def contradicted(self) -> bool:
        """Whether copper leads to another detector than the names say, not just to none."""
        return any(
            detector != self.by_name[mux].get(channel)
            for mux, found in self.by_copper.items()
            for channel, detector in found.items()
        )

    @property
    def best(self) -> ChannelMap:
        """Connections from the copper; without tracks, from the names of nets."""
        return {
            mux: {
                channel: self.by_copper[mux].get(channel) or self.by_name[mux][channel]
                for channel in sorted({*self.by_copper[mux], *self.by_name[mux]}, key=int)
            }
            for mux in self.by_copper
        }


def read_channels(path: Path) -> Channels:
    """The channels of a board file.

    Raises:
        OutputError: if it cannot be read, or has no multiplexer that is known.
    """
    board = read_board(path)
    found = channels(board, Clusters(board))
    if not found.parts:
        raise OutputError(
            f"{path}: no multiplexer found among {len(board.parts)} parts: one like 74HC4051 (16 "
            "leads) or 74HC4067 (24 leads) is needed"
        )
    return found


def channels(board: KicadBoard, clusters: Clusters) -> Channels:
    """Find the multiplexers of a board, and follow each input to its detector."""
    copper = _Follower(board, lambda t: None if t.copper is None else clusters.of(t.copper))
    names = _Follower(board, lambda t: t.net or None)
    parts = {p.ref: (p, pins) for p, pins in sorted(_muxes(board, copper, names), key=_by_ref)}
    by_copper = {ref: copper.map(*found) for ref, found in parts.items()}
    by_name = {ref: names.map(*found) for ref, found in parts.items()}
    output = {ref: _terminal(part, pins.output).net for ref, (part, pins) in parts.items()}
    doubts = tuple(_doubts(by_copper, by_name))
    return Channels(by_copper, by_name, output, parts, doubts)


class _Follower:
    """From a lead to the detector at the other end, by what is the same along a connection."""

    def __init__(self, board: KicadBoard, key: Callable[[Terminal], object]) -> None:
        self.key = key
        self.reached: dict[object, set[str]] = {}
        for part in filter(_may_detect, board.parts):
            for terminal in part.terminals:
                if (at := key(terminal)) is not None:
                    self.reached.setdefault(at, set()).add(part.ref)

    def map(self, part: Part, pins: Pinout) -> dict[str, str]:
        """The detector of each input that has one; several are joined by `+`."""
        rails = {self.key(t) for t in part.terminals if t.number in (*pins.rails, *pins.select)}
        found = {}
        for channel, lead in enumerate(pins.inputs):
            key = self.key(_terminal(part, lead))
            refs = self.reached.get(key, set()) if key not in rails else set()
            if refs:
                found[str(channel)] = "+".join(sorted(refs))
        return found


def _muxes(board: KicadBoard, copper: _Follower, names: _Follower) -> Iterator[tuple[Part, Pinout]]:
    """By what a part is called; else by its leads, and that its inputs read detectors."""
    for part in board.parts:
        numbers = {t.number for t in part.terminals}
        words = " ".join((part.value, part.footprint, *part.texts))
        for pins in PINOUTS:
            if not numbers.issuperset(map(str, range(1, pins.leads + 1))):
                continue
            others = any(p.name.search(words) for p in PINOUTS if p is not pins)
            read = max(len(f.map(part, pins)) for f in (copper, names))
            alike = len({*numbers} - {""}) <= pins.leads + 1 and read >= _LEAST_READ
            if pins.name.search(words) or (alike and not others):
                yield part, pins
                break


def _may_detect(part: Part) -> bool:
    """Two leads, and no resistor or capacitor."""
    numbers = {t.number for t in part.terminals if t.copper is not None}
    return len(numbers) == 2 and not _NO_DETECTOR.match(part.ref)


def _terminal(part: Part, number: str) -> Terminal:
    return next(t for t in part.terminals if t.number == number)


def _doubts(by_copper: ChannelMap, by_name: ChannelMap) -> Iterator[str]:
    for mux, named in by_name.items():
        for channel in sorted({*named, *by_copper[mux]}, key=int):
            copper, name = by_copper[mux].get(channel), named.get(channel)
            if copper != name:
                yield (
                    f"{mux} channel {channel}: the copper leads to {copper or 'no detector'}, the "
                    f"net names to {name or 'none'}"
                )


def _by_ref(found: tuple[Part, Pinout]) -> tuple[str, int]:
    letters, number = re.fullmatch(r"(\D*)(\d*).*", found[0].ref).groups()  # type: ignore[union-attr]
    return letters, int(number or 0)
