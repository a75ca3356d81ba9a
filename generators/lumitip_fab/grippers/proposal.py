"""Figures of a gripper that its maker's fingertip shows beyond doubt."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from build123d import Shape

from lumitip_fab.catalogue.materials import Fastener
from lumitip_fab.grippers.features import Features, Hole, PlaneFace, features, parallel
from lumitip_fab.grippers.figures import TEXTS
from lumitip_fab.grippers.measures import UPRIGHT, Measured, Proposed, measured
from lumitip_fab.grippers.ways import NOTHING, Named, Way, in_words, ways_of
from lumitip_fab.parts.shapes import placed
from lumitip_fab.text import table_of

_NEAR = 0.015  # between figures that are the same


@dataclass(frozen=True, eq=False)
class Proposal:
    """A fingertip in the mount frame, and the figures that it shows beyond doubt: those on which
    all ways to read it agree.

    The frame's origin is between the bolts, on the mount face; u is x, to the right along the row
    of bolts, w is y, away from the pad, and h is z, along the bolts into the fingertip. It is that
    of the likeliest way, as are bolts, pins and faces.
    """

    shape: Shape
    seen: Features
    way: Way
    ways: tuple[Way, ...]
    figures: Mapping[str, Proposed]
    open: frozenset[str]
    """Figures that stay open because ways differ, or for what is noted."""
    notes: tuple[str, ...]
    """What is doubtful, and what to do."""

    @property
    def holes(self) -> tuple[Hole, ...]:
        """Its round holes."""
        return self.seen.holes

    @property
    def pads(self) -> dict[str, PlaneFace]:
        """The pad, or by their numbers all faces that may be it."""
        found = dict.fromkeys(w.pad for w in self._alike() if w.pad is not None)
        return {
            "pad" if len(found) == 1 else f"face {k + 1}, pad?": self.seen.faces[k] for k in found
        }

    def _alike(self) -> Iterator[Way]:
        return (w for w in self.ways if (w.bolts, w.mount) == (self.way.bolts, self.way.mount))

    def rows(self) -> Iterator[tuple[str, str, str]]:
        """The part, every hole, mount face and pad: name, size, place."""
        size = self.shape.bounding_box().size
        yield "part", f"{size.X:.2f} x {size.Y:.2f} x {size.Z:.2f} mm", ""
        for number, hole in enumerate(self.holes):
            at = "not along the bolts"
            if upright(hole):
                at = ", ".join(f"{x + 0.0:.2f}" for x in np.round(hole.foot[:2], 2))
            yield f"hole {number + 1}", self.words(number), at
        mounts = dict.fromkeys(w.mount for w in self.ways if w.bolts == self.way.bolts)
        faces = {
            "mount face" if len(mounts) == 1 else f"face {k + 1}, mount?": self.seen.faces[k]
            for k in mounts
        }
        for name, face in {**faces, **self.pads}.items():
            wide, deep, long = np.ptp(face.corners, axis=0)
            axis = int(np.abs(face.normal).argmax())
            middle = float(face.corners[:, axis].mean())
            sides = (deep, wide, wide)[axis], (long, long, deep)[axis]
            place = "" if face is self.seen.faces[self.way.mount] else f"{'uwh'[axis]} {middle:.2f}"
            yield name, f"{sides[0]:.2f} wide, {sides[1]:.2f} long", place

    def words(self, number: int) -> str:
        """A hole in words: use, diameters from the mount face on, ends."""
        hole, doubt = self.holes[number], "?" if len({w.bolts for w in self.ways}) > 1 else ""
        uses = (("bolt", self.way.bolts), ("pin", self.way.pins))
        use = "".join(f"{name}{doubt}, " for name, holes in uses if number in holes)
        sizes = ", ".join(f"{piece.diameter_mm:.2f}" for piece in hole.pieces)
        return f"{use}⌀ {sizes}, {'through' if hole.through else 'blind'}"


def upright(hole: Hole) -> bool:
    """Whether a hole of a proposal is parallel to the bolts."""
    return parallel(hole.axis, UPRIGHT)


def propose(
    file: Path, shape: Shape, fasteners: Mapping[str, Fastener], named: Named = NOTHING
) -> Proposal:
    """Find mount face, bolts, pins and pad.

    Args:
        file: that was read, for messages.
        shape: its solids.
        fasteners: threads with their clearance holes.
        named: holes and faces whose use the user names.

    Raises:
        InputError: if no hole goes through, none ends in a face square to it, or holes or faces
            that are named cannot have that use.
    """
    ways = ways_of(file, features(shape), named)
    seen = [way.seen.moved(way.to_mount()) for way in ways]
    found = [measured(way, each, fasteners) for way, each in zip(ways, seen, strict=True)]
    first = found[0].figures
    figures = {n: f for n, f in first.items() if all(_same(each, found[0], [n]) for each in found)}
    every = {name for each in found for name in (*each.figures, *each.open)}
    texts = table_of(TEXTS)["found"]
    notes = [texts[name].format(**values) for name, values in _notes(ways, found).items()]
    moved = placed(shape, ways[0].to_mount())
    left = frozenset(every - set(figures))
    return Proposal(moved, seen[0], ways[0], ways, figures, left, tuple(notes))


def _same(a: Measured, b: Measured, names: Sequence[str]) -> bool:
    """Whether two ways have the same figures."""
    return all(_near(a.figures.get(name), b.figures.get(name)) for name in names)


def _near(a: Proposed | None, b: Proposed | None) -> bool:
    if a is None or b is None:
        return a is b
    if isinstance(a.value, str) or isinstance(b.value, str):
        return a.value == b.value
    return abs(a.value - b.value) < _NEAR


def _notes(ways: Sequence[Way], found: Sequence[Measured]) -> dict[str, dict[str, object]]:
    """Names of texts with their values: which choice has to be named, and all other doubts."""
    sets = list(dict.fromkeys(way.bolts for way in ways))
    if len(sets) > 1:
        return {"bolts": {"sets": "; ".join(map(in_words, sets)), "first": in_words(sets[0])}}
    notes: dict[str, dict[str, object]] = {}
    mounts = _differ([way.mount for way in ways], [way.pad for way in ways], found)
    pads = _differ([way.pad for way in ways], [way.mount for way in ways], found)
    for name, numbers in (("mounts", mounts), ("pads", pads)):
        if numbers:
            notes[name] = {"faces": in_words(numbers), "first": numbers[0] + 1}
    for each in found:
        notes |= each.notes
    return notes


def _differ(
    ours: Sequence[int | None], others: Sequence[int | None], found: Sequence[Measured]
) -> list[int]:
    """The faces of one choice, if another of them changes figures while the other choice stays."""
    names = [name for each in found for name in each.figures]
    beside = {face: {b for a, b in zip(ours, others, strict=True) if a == face} for face in ours}

    def comparable(a: int, b: int) -> bool:
        return others[a] == others[b] or not beside[ours[a]] & beside[ours[b]]

    differs = any(
        comparable(a, b) and ours[a] != ours[b] and not _same(found[a], found[b], names)
        for a in range(len(found))
        for b in range(a)
    )
    return sorted({k for k in ours if k is not None}) if differs else []
