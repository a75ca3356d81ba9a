"""Ways to read a fingertip: which holes are for bolts, which faces are mount face and pad."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from lumitip_fab.errors import InputError, Problem
from lumitip_fab.grippers.features import (
    NEAR_MM,
    PARALLEL,
    Features,
    Hole,
    PlaneFace,
    Vector,
    parallel,
)
from lumitip_fab.grippers.figures import TEXTS
from lumitip_fab.grippers.reading import refusal
from lumitip_fab.text import table_of

LEAST_BOLT_MM = 2.0  # diameter of a bolt's hole
MOST_LEAN_DEG = 10.0  # of the pad against the bolts
CHAMFER_MM = 1.0  # of a hole's edge, at most
STEP_MM = 0.5  # between the diameters of a hole and its counterbore, at least
HEAD = 0.8  # depth of a counterbore that hides a head, in diameters of its bolt's hole
ON_ROW_MM = 0.1  # of pins, off the row of bolts and off its middle
SQUARE = 0.02  # sine of the angle below which directions are square


@dataclass(frozen=True)
class Named:
    """Numbers of holes and faces whose use the user names; what is not named is looked for."""

    bolts: tuple[int, ...] = ()
    mount: int = 0
    pad: int = 0


NOTHING = Named()


@dataclass(frozen=True, eq=False)
class Way:
    """One way to read a fingertip, which lies anywhere."""

    seen: Features
    bolts: tuple[int, ...]
    """Which of the holes are for bolts, from 0."""
    mount: int
    """Which of the faces stands on the gripper."""
    pad: int | None = None
    """Which of them grips; none if no face may."""

    @property
    def face(self) -> PlaneFace:
        """The mount face."""
        return self.seen.faces[self.mount]

    @cached_property
    def beside(self) -> tuple[int, ...]:
        """The other holes that open into the mount face."""
        found = []
        for k, hole in enumerate(self.seen.holes):
            if k in self.bolts or not parallel(hole.axis, self.face.normal):
                continue
            ends = np.array([hole.pieces[0].low_mm, hole.pieces[-1].high_mm])
            levels = self.face.normal @ hole.foot + ends * (self.face.normal @ hole.axis)
            if np.abs(levels - self.face.offset_mm).min() < CHAMFER_MM + NEAR_MM:
                found.append(k)
        return tuple(found)

    @cached_property
    def pins(self) -> tuple[int, ...]:
        """Two equal holes beside the bolts, on their row and to either side of its middle alike;
        none if there are others besides."""
        pair = self.beside
        if len(pair) != 2 or len(alike(self.seen.holes, pair, pair[0])) != 2:
            return ()
        ends = np.array([self.foot(k) for k in pair])
        off = ends.mean(axis=0) - self.middle
        line = self.foot(self.bolts[1]) - self.middle if len(self.bolts) == 2 else ends[1] - ends[0]
        line = line / np.linalg.norm(line)
        beyond = ends - self.middle
        beyond = beyond - np.outer(beyond @ line, line)
        far = max(float(np.linalg.norm(off)), *np.linalg.norm(beyond, axis=1).tolist())
        return pair if far <= ON_ROW_MM else ()

    @cached_property
    def middle(self) -> Vector:
        """Between the bolts, on the mount face."""
        return np.asarray(np.mean([self.foot(k) for k in self.bolts], axis=0))

    @cached_property
    def row(self) -> Vector | None:
        """Unit vector from one bolt to the other, or from pin to pin."""
        pair = next((pair for pair in (self.bolts, self.pins) if len(pair) == 2), None)
        if pair is None:
            return None
        a, b = (self.foot(k) for k in pair)
        return np.asarray((b - a) / np.linalg.norm(b - a))

    def foot(self, number: int) -> Vector:
        """Where a hole's axis meets the mount face."""
        hole, face = self.seen.holes[number], self.face
        along = (face.offset_mm - face.normal @ hole.foot) / (face.normal @ hole.axis)
        return np.asarray(hole.foot + along * hole.axis)

    def to_mount(self) -> Vector:
        """From the file's coordinates to the mount frame (4x4)."""
        h = -self.face.normal
        back = np.eye(3)[np.abs(h).argmin()]
        if self.pad is not None:
            back = -self.seen.faces[self.pad].normal
        w = back - h * (back @ h)
        if self.row is not None:
            w = np.cross(h, self.row)
        w = w / np.linalg.norm(w) * (1.0 if w @ back >= 0 else -1.0)
        matrix = np.eye(4)
        matrix[:3, :3] = np.cross(w, h), w, h
        matrix[:3, 3] = -matrix[:3, :3] @ self.middle
        return matrix


def ways_of(file: Path, seen: Features, named: Named) -> tuple[Way, ...]:
    """Every way to read a fingertip, the likeliest first.

    Args:
        file: that was read, for messages.
        seen: what it has.
        named: what the user names.

    Raises:
        InputError: if no hole goes through, none ends in a face square to it, or holes or faces
            that are named cannot have that use.
    """
    sets = bolt_sets(seen.holes)
    if not sets:
        size = " x ".join(f"{np.ptp(seen.reach(axis)):.3g}" for axis in np.eye(3))
        raise refusal(file, "step_holes", count=len(seen.holes), least=LEAST_BOLT_MM, size=size)
    if named.bolts:
        bolts = tuple(number - 1 for number in named.bolts)
        if not any(set(bolts) <= set(each) for each in sets):
            raise _not_there("bolts", in_words(bolts), "; ".join(map(in_words, sets)))
        sets = (bolts,)
    stood = [way for bolts in sets for way in _mounts(seen, bolts, named.mount)]
    if not stood and named.mount:
        ends = sorted({end for bolts in sets for _, end in _ends(seen, bolts)})
        raise _not_there("mount", str(named.mount), in_words(ends))
    if not stood:
        raise refusal(file, "step_face", diameter=seen.holes[sets[0][0]].narrow_mm)
    found = [(way, pad) for way in stood for pad in _pads(way) or (None,)]
    if named.pad:
        pads = sorted({pad for _, pad in found if pad is not None})
        found = [(way, pad) for way, pad in found if pad == named.pad - 1]
        if not found:
            raise _not_there("pad", str(named.pad), in_words(pads))
    return tuple(Way(seen, way.bolts, way.mount, pad) for way, pad in found)


def _not_there(option: str, value: str, allowed: str) -> InputError:
    text = table_of(TEXTS)["faults"][f"named_{option}"].format(value=value, allowed=allowed)
    return InputError([Problem("lumitip-fab gripper", 0, f"--{option}", text)])


def in_words(numbers: Sequence[int]) -> str:
    """Numbers of holes or faces, from 1, as an option takes them."""
    return ",".join(str(k + 1) for k in numbers) or "none"


def bolt_sets(found: Sequence[Hole]) -> tuple[tuple[int, ...], ...]:
    """The sets of equal through holes: those with counterbores first, then those of more."""
    through = [k for k, h in enumerate(found) if h.through and h.narrow_mm >= LEAST_BOLT_MM]
    sets = list(dict.fromkeys(alike(found, through, k) for k in through))

    def order(each: tuple[int, ...]) -> tuple[bool, int, float]:
        hole = found[each[0]]
        return hole.wide_mm - hole.narrow_mm < STEP_MM, -len(each), -hole.narrow_mm

    return tuple(sorted(sets, key=order))


def alike(found: Sequence[Hole], among: Sequence[int], to: int) -> tuple[int, ...]:
    """The holes with the direction and diameters of one of them."""
    sizes = np.array([(hole.narrow_mm, hole.wide_mm) for hole in found])
    same = np.abs(sizes - sizes[to]).max(axis=1) < NEAR_MM
    return tuple(k for k in among if same[k] and parallel(found[k].axis, found[to].axis))


def _ends(seen: Features, bolts: Sequence[int]) -> Iterator[tuple[bool, int]]:
    """The faces that a bolt's hole opens into; of each, whether the hole is at its low end."""
    bolt = seen.holes[bolts[0]]
    ends = ((True, bolt.pieces[0].low_mm, -bolt.axis), (False, bolt.pieces[-1].high_mm, bolt.axis))
    for low, end, out in ends:
        point = bolt.foot + bolt.axis * end
        for number, face in enumerate(seen.faces):
            least, most = face.corners.min(axis=0), face.corners.max(axis=0)
            beyond = face.offset_mm - float(face.normal @ point)
            level = -NEAR_MM < beyond < CHAMFER_MM + NEAR_MM
            at = point + out * beyond
            inside = bool(((least - NEAR_MM < at) & (at < most + NEAR_MM)).all())
            if face.normal @ out > PARALLEL and level and inside:
                yield low, number


def _mounts(seen: Features, bolts: tuple[int, ...], named: int) -> list[Way]:
    """The faces that may be the mount face: that behind which the whole part lies, if it is one
    alone, and that at the end away from the heads, if they have a recess; both if these differ."""
    ends = list(_ends(seen, bolts))
    if named:
        return [Way(seen, bolts, face) for _, face in ends if face == named - 1]
    bolt = seen.holes[bolts[0]]
    outer = [face for _, face in ends if seen.outer(seen.faces[face])]
    votes = set(outer) if len(outer) == 1 else set()
    votes |= {face for low, face in ends if _away_from_heads(bolt, low)}
    found = [face for _, face in ends if face in votes or not votes]
    return [Way(seen, bolts, face) for face in sorted(found, key=outer.__contains__, reverse=True)]


def _away_from_heads(bolt: Hole, low: bool) -> bool:
    """Whether a hole is wider at its other end than at this one, and deep enough for a head."""
    here, there = (bolt.pieces[0], bolt.pieces[-1])[:: 1 if low else -1]
    deep = there.high_mm - there.low_mm >= HEAD * bolt.narrow_mm
    return deep and there.diameter_mm - here.diameter_mm >= STEP_MM


def _pads(way: Way) -> list[int]:
    """The faces that may be the pad: those along the bolts, in the tip's half, behind which the
    whole part lies, and larger ones of their direction. Square to the row of bolts only one that
    is larger than all others."""
    faces, h = way.seen.faces, -way.face.normal
    tip = sum(way.seen.reach(h)) / 2 + NEAR_MM
    lean = math.sin(math.radians(MOST_LEAN_DEG))
    along = [k for k, f in enumerate(faces) if abs(float(f.normal @ h)) <= lean]
    sizes = {k: _size_mm2(faces[k], h) for k in along if float((faces[k].corners @ h).max()) > tip}
    outer = {k for k in sizes if way.seen.outer(faces[k])}
    found = outer | {
        k
        for k in sizes
        for o in outer
        if sizes[k] > sizes[o]
        and faces[k].normal @ faces[o].normal > math.cos(math.radians(MOST_LEAN_DEG))
    }
    flat = {k for k in found if way.row is None or abs(faces[k].normal @ way.row) <= SQUARE}
    most = max((sizes[k] for k in flat), default=0.0)
    pads = (k for k in found if k in flat or sizes[k] > most + NEAR_MM)
    return sorted(pads, key=lambda k: (k not in outer, k not in flat, -round(sizes[k], 2), k))


def _size_mm2(face: PlaneFace, h: Vector) -> float:
    """Size of the rectangle round a face along the bolts."""
    across = np.cross(face.normal, h)
    return float(np.ptp(face.corners @ h) * np.ptp(face.corners @ across))
