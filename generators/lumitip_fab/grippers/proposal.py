"""Figures of a gripper from its maker's fingertip: mount face, bolts, pins, pad."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from build123d import Shape

from lumitip_fab.catalogue.materials import Fastener
from lumitip_fab.grippers.features import (
    NEAR_MM,
    PARALLEL,
    Hole,
    PlaneFace,
    Vector,
    cylinders,
    holes,
    parallel,
    planes,
)
from lumitip_fab.grippers.reading import refusal
from lumitip_fab.parts.shapes import placed

LEAST_BOLT_MM = 2.0  # diameter of a bolt's hole
MOST_LEAN_DEG = 10.0  # of the pad against the bolts
STEP_MM = 0.5  # between the diameters of a hole and its counterbore, at least
CUT_MM = 2.0  # of the mount face's edges by chamfers, at most
_SIDE = 0.02  # sine of the angle below which a normal is square to the bolts' row


@dataclass(frozen=True)
class Proposed:
    """A figure as the fingertip has it."""

    value: float | str
    where: str
    """What it was read from."""


@dataclass(frozen=True, eq=False)
class Proposal:
    """A fingertip in the mount frame, and the figures that it shows.

    The frame's origin is between the bolts, on the mount face; u is x, to the right along the row
    of bolts, w is y, away from the pad, and h is z, along the bolts into the fingertip.
    """

    shape: Shape
    holes: tuple[Hole, ...]
    bolts: tuple[int, ...]
    """Which of the holes are for bolts."""
    pins: tuple[int, ...]
    """Which are for locating pins."""
    mount: PlaneFace
    pads: tuple[PlaneFace, ...]
    """What may be the pad: the largest face first, then those of half its size or more."""
    figures: Mapping[str, Proposed]

    def rows(self) -> Iterator[tuple[str, str, str]]:
        """Every hole and both faces: name, size, place."""
        for number, hole in enumerate(self.holes):
            at = "not along the bolts"
            if upright(hole):
                at = ", ".join(f"{x + 0.0:.2f}" for x in np.round(hole.foot[:2], 2))
            yield f"hole {number + 1}", self.words(number), at
        for name, face in (("mount face", self.mount), *(("pad", p) for p in self.pads[:1])):
            wide, *long = np.ptp(face.corners, axis=0)
            yield name, f"{wide:.2f} wide, {max(long):.2f} long", ""

    def words(self, number: int) -> str:
        """A hole in words: use, diameters from the mount face on, ends."""
        hole = self.holes[number]
        use = "bolt, " if number in self.bolts else "pin, " if number in self.pins else ""
        sizes = ", ".join(f"{piece.diameter_mm:.2f}" for piece in hole.pieces)
        return f"{use}⌀ {sizes}, {'through' if hole.through else 'blind'}"


def upright(hole: Hole) -> bool:
    """Whether a hole of a proposal is parallel to the bolts."""
    return parallel(hole.axis, np.array([0.0, 0.0, 1.0]))


def propose(file: Path, shape: Shape, fasteners: Mapping[str, Fastener]) -> Proposal:
    """Find mount face, bolts, pins and pad.

    Args:
        file: that was read, for messages.
        shape: its solids.
        fasteners: threads with their clearance holes.

    Raises:
        InputError: if no hole goes through, or none ends in a face square to it.
    """
    moved = placed(shape, _look(file, shape).to_mount())
    seen = _look(file, moved)
    figures = {**_of_bolts(seen, fasteners), **_of_pins(seen), **_of_faces(seen, moved)}
    return Proposal(moved, seen.holes, seen.bolts, seen.pins, seen.mount, seen.pads, figures)


@dataclass(frozen=True, eq=False)
class _Seen:
    """What a fingertip has, wherever it lies."""

    holes: tuple[Hole, ...]
    faces: tuple[PlaneFace, ...]
    bolts: tuple[int, ...]
    mount: PlaneFace
    pins: tuple[int, ...]
    row: Vector | None
    """Unit vector from one bolt to the other, or from pin to pin."""
    pads: tuple[PlaneFace, ...]

    def to_mount(self) -> Vector:
        """From the file's coordinates to the mount frame (4x4)."""
        h = -self.mount.normal
        back = -self.pads[0].normal if self.pads else np.eye(3)[np.abs(h).argmin()]
        w = np.cross(h, self.row) if self.row is not None else back - h * (back @ h)
        w = w / np.linalg.norm(w) * (1.0 if w @ back >= 0 else -1.0)
        matrix = np.eye(4)
        matrix[:3, :3] = np.cross(w, h), w, h
        feet = [_foot(self.holes[k], self.mount) for k in self.bolts]
        matrix[:3, 3] = -matrix[:3, :3] @ np.mean(feet, axis=0)
        return matrix


def _look(file: Path, shape: Shape) -> _Seen:
    found, faces = holes(shape, cylinders(shape)), planes(shape)
    bolts = _bolts(found)
    if not bolts:
        raise refusal(file, "step_holes", count=len(found), least=LEAST_BOLT_MM)
    mount = _mount(found[bolts[0]], faces)
    if mount is None:
        raise refusal(file, "step_face", diameter=found[bolts[0]].narrow_mm)
    pins = _pins(found, bolts, mount)
    pair = next((pair for pair in (bolts, pins) if len(pair) == 2), None)
    row = None
    if pair:
        a, b = (_foot(found[k], mount) for k in pair)
        row = (b - a) / np.linalg.norm(b - a)
    return _Seen(found, faces, bolts, mount, pins, row, _pads(faces, -mount.normal, row))


def _bolts(found: Sequence[Hole]) -> tuple[int, ...]:
    """The largest set of equal through holes; with counterbores, if any has one."""
    through = [k for k, h in enumerate(found) if h.through and h.narrow_mm >= LEAST_BOLT_MM]
    stepped = [k for k in through if found[k].wide_mm - found[k].narrow_mm >= STEP_MM]
    sets = [_alike(found, stepped or through, k) for k in stepped or through]
    return max(sets, key=lambda s: (len(s), found[s[0]].narrow_mm), default=())


def _alike(found: Sequence[Hole], among: Sequence[int], to: int) -> tuple[int, ...]:
    """The holes with the direction and diameters of one of them."""
    sizes = np.array([(hole.narrow_mm, hole.wide_mm) for hole in found])
    same = np.abs(sizes - sizes[to]).max(axis=1) < NEAR_MM
    return tuple(k for k in among if same[k] and parallel(found[k].axis, found[to].axis))


def _mount(bolt: Hole, faces: Sequence[PlaneFace]) -> PlaneFace | None:
    """The face that a bolt's hole opens into at its narrower end; at equal ends the larger one.
    Of equal faces it is that at the lower z, as in the mount frame."""
    first, last = bolt.pieces[0], bolt.pieces[-1]
    found = []
    for piece, end, out in ((first, first.low_mm, -bolt.axis), (last, last.high_mm, bolt.axis)):
        point = bolt.foot + bolt.axis * end
        for face in faces:
            low, high = face.corners.min(axis=0) - NEAR_MM, face.corners.max(axis=0) + NEAR_MM
            level = abs(float(face.normal @ point) - face.offset_mm) < NEAR_MM
            inside = bool(((low < point) & (point < high)).all())
            if face.normal @ out > PARALLEL and level and inside:
                size = -round(face.area_mm2, 2)
                found.append(((round(piece.diameter_mm, 2), size, *face.normal[::-1]), face))
    return min(found, key=lambda each: each[0])[1] if found else None


def _foot(hole: Hole, mount: PlaneFace) -> Vector:
    """Where a hole's axis meets the mount face."""
    along = (mount.offset_mm - mount.normal @ hole.foot) / (mount.normal @ hole.axis)
    return np.asarray(hole.foot + along * hole.axis)


def _pins(found: Sequence[Hole], bolts: Sequence[int], mount: PlaneFace) -> tuple[int, ...]:
    """Two equal blind holes that open into the mount face."""
    blind = []
    for k, hole in enumerate(found):
        if k in bolts or hole.through or not parallel(hole.axis, mount.normal):
            continue
        ends = np.array([hole.pieces[0].low_mm, hole.pieces[-1].high_mm])
        levels = mount.normal @ hole.foot + ends * (mount.normal @ hole.axis)
        if np.abs(levels - mount.offset_mm).min() < NEAR_MM:
            blind.append(k)
    sets = (_alike(found, blind, k) for k in blind)
    return next((pair for pair in sets if len(pair) == 2), ())


def _pads(faces: Sequence[PlaneFace], h: Vector, row: Vector | None) -> tuple[PlaneFace, ...]:
    """The largest face along the bolts behind which the whole part lies, and those of half its size
    or more; of equal ones that at the lower y, as in the mount frame, comes first."""
    cloud, found = np.concatenate([face.corners for face in faces]), []
    for face in faces:
        leans = abs(float(face.normal @ h)) > math.sin(math.radians(MOST_LEAN_DEG))
        sideways = row is not None and abs(float(face.normal @ row)) > _SIDE
        if leans or sideways or float((cloud @ face.normal).max()) > face.offset_mm + NEAR_MM:
            continue
        across = np.cross(face.normal, h)
        size = float(np.ptp(face.corners @ h) * np.ptp(face.corners @ across))
        found.append((-round(size, 2), float(face.normal[1]), face))
    found.sort(key=lambda each: each[:2])
    return tuple(face for size, _, face in found if size <= found[0][0] / 2)


def _of_bolts(seen: _Seen, fasteners: Mapping[str, Fastener]) -> dict[str, Proposed]:
    """Figures from the bolts' holes, in the mount frame; sleeves round them are pins."""
    where, bolt = _named(seen.bolts), seen.holes[seen.bolts[0]]
    hole = _rounded(bolt.narrow_mm)
    found = {"bolt_hole_mm": Proposed(hole, where)}
    fits = [n for n, f in fasteners.items() if f.hole_mm[0] <= hole <= f.hole_mm[1]]
    if len(fits) == 1:
        found["bolt"] = Proposed(fits[0], f"{where}, clearance hole by ISO 273")
    sizes = [piece.diameter_mm for piece in bolt.pieces]
    narrow = sizes.index(min(sizes))
    wider = [k for k, size in enumerate(sizes) if size - sizes[narrow] >= STEP_MM]
    heads = [bolt.pieces[k] for k in wider if k > narrow]
    sleeves = [bolt.pieces[k] for k in wider if k < narrow]
    if heads:
        found["counterbore_mm"] = Proposed(_rounded(heads[0].diameter_mm), where)
        found["land_mm"] = Proposed(
            _rounded(heads[0].low_mm), f"{where}: mount face to counterbore"
        )
    if len(seen.bolts) == 2:
        found["bolt_spacing_mm"] = Proposed(_apart(seen, seen.bolts), where)
        if sleeves:
            deep = sleeves[-1].high_mm
            found |= _pin(sleeves[0].diameter_mm, _apart(seen, seen.bolts), deep, where)
    return found


def _of_pins(seen: _Seen) -> dict[str, Proposed]:
    if not seen.pins:
        return {}
    hole, where = seen.holes[seen.pins[0]], _named(seen.pins)
    return _pin(hole.narrow_mm, _apart(seen, seen.pins), hole.pieces[-1].high_mm, where)


def _pin(hole: float, spacing: float, deep: float, where: str) -> dict[str, Proposed]:
    sizes = {"hole_mm": hole, "spacing_mm": spacing, "depth_mm": deep}
    return {f"pins.{name}": Proposed(_rounded(size), where) for name, size in sizes.items()}


def _of_faces(seen: _Seen, shape: Shape) -> dict[str, Proposed]:
    """Figures from mount face and pad; `block_back_w_mm` takes the board to stand at the pad."""
    wide = _reach(seen, 0, 1) + _reach(seen, 0, -1)
    found = {"block_width_mm": Proposed(_rounded(wide), "width of the block at the mount face")}
    radii = {
        _rounded(c.diameter_mm / 2)
        for c in cylinders(shape)
        if not c.hollow and abs(c.axis[2]) > PARALLEL and 60 < c.turn_deg < 120 and c.foot[1] > 0
    }
    if len(radii) == 1:
        found["block_corner_mm"] = Proposed(radii.pop(), "round corners behind the bolts")
    if seen.pads:
        normal = seen.pads[0].normal
        before = -seen.pads[0].offset_mm / float(normal[1])
        tilt = _rounded(-math.degrees(math.asin(normal[2])))
        found["tilt_deg"] = Proposed(tilt, "pad against bolts")
        found["pad_w_mm"] = Proposed(_rounded(before), "pad to the bolts' axes")
        found["bolt_w_mm"] = Proposed(_rounded(before), "the board stands where the pad is")
        back = _rounded(before + _reach(seen, 1, 1))
        found["block_back_w_mm"] = Proposed(back, "pad to the back of the block")
    return found


def _reach(seen: _Seen, axis: int, way: int) -> float:
    """How far the block reaches from the origin: to the side behind a chamfer or flank that cuts
    the edge of the mount face, else to that edge."""
    edge = float((way * seen.mount.corners[:, axis]).max())
    sides = [face.offset_mm for face in seen.faces if way * face.normal[axis] > PARALLEL]
    return min((side for side in sides if edge < side < edge + CUT_MM), default=edge)


def _named(numbers: Sequence[int]) -> str:
    return " and ".join(f"hole {k + 1}" for k in numbers)


def _apart(seen: _Seen, pair: Sequence[int]) -> float:
    a, b = (seen.holes[k].foot for k in pair)
    return _rounded(float(np.linalg.norm(b - a)))


def _rounded(value: float) -> float:
    return round(float(value), 2) + 0.0
