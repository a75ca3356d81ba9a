"""Figures of a gripper from its maker's fingertip: mount face, bolts, pins, pad."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from build123d import Shape

from lumitip_fab.catalogue.materials import Fastener
from lumitip_fab.grippers.features import (
    NEAR_MM,
    Cylinder,
    Hole,
    PlaneFace,
    Vector,
    cylinders,
    holes,
    parallel,
    planes,
)
from lumitip_fab.grippers.reading import refusal

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
    """What a fingertip shows, and the figures that follow.

    Frame: origin between the bolts, on the mount face; u to the right along the row of bolts, w
    away from the pad, h along the bolts into the fingertip.
    """

    axes: Vector
    """u, w and h as rows, in the file's coordinates."""
    origin: Vector
    holes: tuple[Hole, ...]
    bolts: tuple[int, ...]
    """Which of the holes are for bolts."""
    pins: tuple[int, ...]
    """Which are for locating pins."""
    mount: PlaneFace
    pad: PlaneFace | None
    figures: Mapping[str, Proposed]

    def placed(self, points: Vector) -> Vector:
        """Points of the file, shape `(n, 3)`, as (u, w, h)."""
        return np.asarray((points - self.origin) @ self.axes.T)

    def rows(self) -> tuple[tuple[str, str, str], ...]:
        """Every hole and both faces: name, size, place."""
        rows = []
        for number, hole in enumerate(self.holes):
            at = self.place(hole)
            place = "not along the bolts" if at is None else f"{at[0]:.2f}, {at[1]:.2f}"
            rows.append((f"hole {number + 1}", self.words(number), place))
        for name, plane in (("mount face", self.mount), ("pad", self.pad)):
            if plane is not None:
                size = np.ptp(self.placed(plane.corners), axis=0)
                words = f"{size[0]:.2f} wide, {max(size[1], size[2]):.2f} long"
                rows.append((name, words, f"normal {(np.round(plane.normal, 3) + 0.0).tolist()}"))
        return tuple(rows)

    def place(self, hole: Hole) -> Vector | None:
        """u and w of a hole's axis; none if it is not parallel to the bolts."""
        if not parallel(hole.axis, self.axes[2]):
            return None
        return self.placed(_on_mount(hole, self.mount)[None])[0, :2]

    def pieces(self, number: int) -> tuple[Cylinder, ...]:
        """The pieces of a hole, that at the mount face first."""
        hole = self.holes[number]
        return hole.pieces if float(hole.axis @ self.axes[2]) > 0 else hole.pieces[::-1]

    def words(self, number: int) -> str:
        """A hole in words: use, diameters, ends."""
        hole = self.holes[number]
        use = "bolt, " if number in self.bolts else "pin, " if number in self.pins else ""
        sizes = ", ".join(f"{piece.diameter_mm:.2f}" for piece in self.pieces(number))
        return f"{use}⌀ {sizes}, {'through' if hole.through else 'blind'}"


def propose(file: Path, shape: Shape, fasteners: Mapping[str, Fastener]) -> Proposal:
    """Find mount face, bolts, pins and pad.

    Args:
        file: that was read, for messages.
        shape: its solids.
        fasteners: threads with their clearance holes.

    Raises:
        InputError: if no hole goes through, or none ends in a face square to it.
    """
    round_, flat = cylinders(shape), planes(shape)
    found = holes(shape, round_)
    bolts = _bolts(found)
    if not bolts:
        raise refusal(file, "step_holes", count=len(found), least=LEAST_BOLT_MM)
    mount = _mount(found[bolts[0]], flat)
    if mount is None:
        raise refusal(file, "step_face", diameter=found[bolts[0]].narrow_mm)
    h = -mount.normal
    pins = _pins(found, bolts, mount)
    feet = np.array([_on_mount(found[k], mount) for k in bolts])
    row = _row(feet) if len(bolts) == 2 else None
    if row is None and pins:
        row = _row(np.array([_on_mount(found[k], mount) for k in pins]))
    pad = _pad(flat, h, row)
    axes = _axes(h, row, pad)
    placed = Proposal(axes, feet.mean(axis=0), found, bolts, pins, mount, pad, {})
    figures = _figures(placed, fasteners) | _face_figures(placed, round_, flat)
    return Proposal(**{**vars(placed), "figures": figures})


def _bolts(found: Sequence[Hole]) -> tuple[int, ...]:
    """The largest set of equal through holes, those with counterbores first."""
    through = [k for k, h in enumerate(found) if h.through and h.narrow_mm >= LEAST_BOLT_MM]
    stepped = [k for k in through if found[k].wide_mm - found[k].narrow_mm >= STEP_MM]
    sets = [tuple(k for k in stepped or through if _alike(found[k], found[n])) for n in through]
    return max(sets, key=lambda s: (len(s), found[s[0]].narrow_mm) if s else (0, 0.0), default=())


def _alike(a: Hole, b: Hole) -> bool:
    return (
        parallel(a.axis, b.axis)
        and abs(a.narrow_mm - b.narrow_mm) < NEAR_MM
        and abs(a.wide_mm - b.wide_mm) < NEAR_MM
    )


def _mount(bolt: Hole, flat: Sequence[PlaneFace]) -> PlaneFace | None:
    """The face that a bolt's hole opens into at its narrower end; at equal ends the larger one."""
    ends = (
        (bolt.pieces[0].diameter_mm, bolt.pieces[0].low_mm, -bolt.axis),
        (bolt.pieces[-1].diameter_mm, bolt.pieces[-1].high_mm, bolt.axis),
    )
    faces = []
    for diameter, along, out in ends:
        point = bolt.foot + bolt.axis * along
        for plane in flat:
            level = abs(float(plane.normal @ point) - plane.offset_mm) < NEAR_MM
            if float(plane.normal @ out) > 1 - 1e-6 and level and _covers(plane, point):
                faces.append((diameter, -plane.area_mm2, plane))
    return min(faces, key=lambda face: face[:2])[2] if faces else None


def _covers(plane: PlaneFace, point: Vector) -> bool:
    """Whether a point lies in the box round a face."""
    low, high = plane.corners.min(axis=0), plane.corners.max(axis=0)
    return bool(((point > low - NEAR_MM) & (point < high + NEAR_MM)).all())


def _on_mount(hole: Hole, mount: PlaneFace) -> Vector:
    """Where a hole's axis meets the mount face."""
    along = (mount.offset_mm - mount.normal @ hole.foot) / (mount.normal @ hole.axis)
    return np.asarray(hole.foot + along * hole.axis)


def _pins(found: Sequence[Hole], bolts: Sequence[int], mount: PlaneFace) -> tuple[int, ...]:
    """Two equal blind holes that open into the mount face."""
    blind = []
    for k, hole in enumerate(found):
        if k in bolts or hole.through or not parallel(hole.axis, mount.normal):
            continue
        ends = (hole.pieces[0].low_mm, hole.pieces[-1].high_mm)
        levels = [float(mount.normal @ (hole.foot + hole.axis * end)) for end in ends]
        if min(abs(level - mount.offset_mm) for level in levels) < NEAR_MM:
            blind.append(k)
    pairs = [[k for k in blind if _alike(found[k], found[n])] for n in blind]
    return next((tuple(pair) for pair in pairs if len(pair) == 2), ())


def _row(points: Vector) -> Vector:
    way = points[1] - points[0]
    return np.asarray(way / np.linalg.norm(way))


def _pad(flat: Iterable[PlaneFace], h: Vector, row: Vector | None) -> PlaneFace | None:
    """The largest face along the bolts behind which the whole part lies."""
    flat = tuple(flat)
    cloud = np.concatenate([plane.corners for plane in flat])
    faces = []
    for plane in flat:
        leans = abs(float(plane.normal @ h)) > math.sin(math.radians(MOST_LEAN_DEG))
        sideways = row is not None and abs(float(plane.normal @ row)) > _SIDE
        if leans or sideways or float((cloud @ plane.normal).max()) > plane.offset_mm + NEAR_MM:
            continue
        across = np.cross(plane.normal, h)
        size = np.ptp(plane.corners @ h) * np.ptp(plane.corners @ across)
        faces.append((float(size), plane))
    return max(faces, key=lambda face: face[0])[1] if faces else None


def _axes(h: Vector, row: Vector | None, pad: PlaneFace | None) -> Vector:
    out = np.eye(3)[np.abs(h).argmin()] if pad is None else -pad.normal
    w = np.cross(h, row) if row is not None else out - h * (out @ h)
    w = w / np.linalg.norm(w) * (1.0 if w @ out >= 0 else -1.0)
    return np.array([np.cross(w, h), w, h])


def _figures(p: Proposal, fasteners: Mapping[str, Fastener]) -> dict[str, Proposed]:
    """What the holes give, rounded to 0.01."""
    names = " and ".join(f"hole {k + 1}" for k in p.bolts)
    bolt = p.holes[p.bolts[0]]
    hole = _rounded(bolt.narrow_mm)
    found: dict[str, Proposed] = {"bolt_hole_mm": Proposed(hole, names)}
    fits = [n for n, f in fasteners.items() if f.hole_mm[0] <= hole <= f.hole_mm[1]]
    if len(fits) == 1:
        found["bolt"] = Proposed(fits[0], f"{names}, clearance hole by ISO 273")
    if len(p.bolts) == 2:
        found["bolt_spacing_mm"] = Proposed(_apart(p, p.bolts), names)
    before, head = _steps(p)
    if head:
        found["counterbore_mm"] = Proposed(_rounded(head[0]), names)
        found["land_mm"] = Proposed(_rounded(head[1]), f"{names}: mount face to counterbore")
    if before and len(p.bolts) == 2:
        found |= _pin_figures(before[0], _apart(p, p.bolts), before[1], f"{names}: sleeves")
    if p.pins:
        pin, where = p.holes[p.pins[0]], " and ".join(f"hole {k + 1}" for k in p.pins)
        deep = sum(piece.high_mm - piece.low_mm for piece in pin.pieces)
        found |= _pin_figures(pin.narrow_mm, _apart(p, p.pins), deep, where)
    return found


def _pin_figures(hole: float, spacing: float, deep: float, where: str) -> dict[str, Proposed]:
    sizes = {"hole_mm": hole, "spacing_mm": spacing, "depth_mm": deep}
    return {f"pins.{name}": Proposed(_rounded(size), where) for name, size in sizes.items()}


def _steps(
    p: Proposal,
) -> tuple[tuple[float, float] | None, tuple[float, float] | None]:
    """Diameter and depth of the wider piece at the mount face; diameter of the wider piece beyond
    the bolt's hole, and where it begins above the mount face."""
    pieces = p.pieces(p.bolts[0])
    narrow = min(range(len(pieces)), key=lambda k: pieces[k].diameter_mm)
    wider = [piece.diameter_mm - pieces[narrow].diameter_mm >= STEP_MM for piece in pieces]

    def heights(piece: Cylinder) -> list[float]:
        ends = np.array([piece.foot + piece.axis * end for end in (piece.low_mm, piece.high_mm)])
        return sorted(p.placed(ends)[:, 2].tolist())

    first = next((pieces[k] for k in range(narrow) if wider[k]), None)
    last = next((pieces[k] for k in range(narrow, len(pieces)) if wider[k]), None)
    return (
        (first.diameter_mm, heights(first)[1]) if first else None,
        (last.diameter_mm, heights(last)[0]) if last else None,
    )


def _face_figures(
    p: Proposal, round_: Iterable[Cylinder], flat: Iterable[PlaneFace]
) -> dict[str, Proposed]:
    """What mount face and pad give; `block_back_w_mm` takes the board to stand at the pad."""
    flat = tuple(flat)
    wide = sum(_reach(p, side * p.axes[0], flat) for side in (-1.0, 1.0))
    found = {"block_width_mm": Proposed(_rounded(wide), "width of the block at the mount face")}
    radii = {
        _rounded(c.diameter_mm / 2)
        for c in round_
        if not c.hollow
        and parallel(c.axis, p.axes[2])
        and 60 < c.turn_deg < 120
        and p.placed(c.foot[None])[0, 1] > 0
    }
    if len(radii) == 1:
        found["block_corner_mm"] = Proposed(radii.pop(), "round corners behind the bolts")
    if p.pad is None:
        return found
    lean = -float(p.pad.normal @ p.axes[2])
    before = (p.pad.offset_mm - float(p.pad.normal @ p.origin)) / math.sqrt(1 - lean * lean)
    pad = _rounded(before)
    found["tilt_deg"] = Proposed(_rounded(math.degrees(math.asin(lean))), "pad against bolts")
    found["pad_w_mm"] = Proposed(pad, "pad to the bolts' axes")
    found["bolt_w_mm"] = Proposed(pad, "the board stands where the pad is")
    found["block_back_w_mm"] = Proposed(
        _rounded(before + _reach(p, p.axes[1], flat)), "pad to the back of the block"
    )
    return found


def _reach(p: Proposal, way: Vector, flat: Iterable[PlaneFace]) -> float:
    """How far the block reaches from the origin: the side behind a chamfer or flank that cuts the
    edge of the mount face, else that edge."""
    edge = float(((p.mount.corners - p.origin) @ way).max())
    sides = [f.offset_mm - float(f.normal @ p.origin) for f in flat if f.normal @ way > 1 - 1e-6]
    return min((side for side in sides if edge < side < edge + CUT_MM), default=edge)


def _apart(p: Proposal, pair: Sequence[int]) -> float:
    first, second = (_on_mount(p.holes[k], p.mount) for k in pair)
    return _rounded(float(np.linalg.norm(second - first)))


def _rounded(value: float) -> float:
    return round(float(value), 2) + 0.0
