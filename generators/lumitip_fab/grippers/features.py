"""Round holes and plane faces of a solid, whatever program drew it."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from build123d import Face, GeomType, Shape
from numpy.typing import NDArray
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_State

Vector = NDArray[np.float64]
NEAR_MM = 0.02
"""Distance below which axes and planes are the same."""
PARALLEL = 1 - 1e-6
_CHAMFER_MM = 2.0  # between two pieces of one hole, at most
_FORWARD = np.array([0.37, 0.61, 1.0])  # decides which way an axis points
_WHOLE_DEG = 270.0  # of a cylinder that is a hole; fillets are less


@dataclass(frozen=True, eq=False)
class Cylinder:
    """Cylindrical faces with the same axis and radius, end to end."""

    axis: Vector
    """Unit vector."""
    foot: Vector
    """Point of the axis nearest to the origin (mm)."""
    diameter_mm: float
    low_mm: float
    """Where it begins along the axis, from the foot."""
    high_mm: float
    turn_deg: float
    """How much of the full circle there is."""
    hollow: bool
    """Whether the material is outside."""

    def moved(self, matrix: Vector) -> "Cylinder":
        """The same, moved by a rigid 4x4 matrix."""
        axis, point = matrix[:3, :3] @ self.axis, _points(matrix, self.foot)
        along = float(axis @ point)
        foot, ends = point - axis * along, (self.low_mm + along, self.high_mm + along)
        if axis @ _FORWARD < 0:
            axis, ends = -axis, (-ends[1], -ends[0])
        return replace(self, axis=axis, foot=foot, low_mm=ends[0], high_mm=ends[1])


@dataclass(frozen=True, eq=False)
class Hole:
    """Coaxial pieces, in their order along the axis: a bolt's hole and its counterbore."""

    pieces: tuple[Cylinder, ...]
    open_low: bool
    open_high: bool

    @property
    def axis(self) -> Vector:
        """Unit vector along it."""
        return self.pieces[0].axis

    @property
    def foot(self) -> Vector:
        """Point of its axis nearest to the origin."""
        return self.pieces[0].foot

    @property
    def through(self) -> bool:
        """Whether it is open at both ends."""
        return self.open_low and self.open_high

    @property
    def narrow_mm(self) -> float:
        """Its smallest diameter."""
        return min(piece.diameter_mm for piece in self.pieces)

    @property
    def wide_mm(self) -> float:
        """Its largest diameter."""
        return max(piece.diameter_mm for piece in self.pieces)

    def moved(self, matrix: Vector) -> "Hole":
        """The same, moved by a rigid 4x4 matrix."""
        pieces = tuple(piece.moved(matrix) for piece in self.pieces)
        if (matrix[:3, :3] @ self.axis) @ _FORWARD < 0:
            return Hole(pieces[::-1], self.open_high, self.open_low)
        return Hole(pieces, self.open_low, self.open_high)


@dataclass(frozen=True, eq=False)
class PlaneFace:
    """All faces in one plane with the material on the same side."""

    normal: Vector
    """Unit vector out of the material."""
    offset_mm: float
    """Distance of the plane from the origin along its normal."""
    pieces: tuple[Vector, ...]
    """The edges of each face as points, shape `(n, 3)`."""
    area_mm2: float

    @cached_property
    def corners(self) -> Vector:
        """The edges of all as points, shape `(n, 3)`."""
        return np.concatenate(self.pieces)

    def moved(self, matrix: Vector) -> "PlaneFace":
        """The same, moved by a rigid 4x4 matrix."""
        normal = matrix[:3, :3] @ self.normal
        pieces = tuple(_points(matrix, piece) for piece in self.pieces)
        return PlaneFace(normal, float(normal @ pieces[0][0]), pieces, self.area_mm2)

    def around(self, points: Vector) -> "PlaneFace":
        """Those of its faces that one of some points is in, by the boxes round them."""
        boxes = (
            (piece.min(axis=0) - NEAR_MM, piece.max(axis=0) + NEAR_MM) for piece in self.pieces
        )
        inside = [((low < points) & (points < high)).all(axis=1).any() for low, high in boxes]
        kept = tuple(piece for piece, each in zip(self.pieces, inside, strict=True) if each)
        return replace(self, pieces=kept or self.pieces)


@dataclass(frozen=True, eq=False)
class Features:
    """Round holes, plane faces and cylinders of a solid; holes and faces have their numbers from
    their order, wherever the solid lies."""

    holes: tuple[Hole, ...]
    faces: tuple[PlaneFace, ...]
    """The largest first."""
    cylinders: tuple[Cylinder, ...]

    def moved(self, matrix: Vector) -> "Features":
        """The same, moved by a rigid 4x4 matrix."""
        return Features(
            tuple(hole.moved(matrix) for hole in self.holes),
            tuple(face.moved(matrix) for face in self.faces),
            tuple(cylinder.moved(matrix) for cylinder in self.cylinders),
        )

    def reach(self, direction: Vector) -> tuple[float, float]:
        """Where the edges of its plane faces begin and end along a direction."""
        along = np.concatenate([face.corners @ direction for face in self.faces])
        return float(along.min()), float(along.max())

    def outer(self, face: PlaneFace) -> bool:
        """Whether the whole part lies behind a face."""
        return self.reach(face.normal)[1] <= face.offset_mm + NEAR_MM


def features(shape: Shape) -> Features:
    """What a solid has."""
    found = cylinders(shape)
    return Features(holes(shape, found), planes(shape), found)


def planes(shape: Shape) -> tuple[PlaneFace, ...]:
    """Every plane with a face in it, the largest first."""
    joined: list[PlaneFace] = []
    for face in shape.faces().filter_by(GeomType.PLANE):
        normal = _unit(_array(face.normal_at()))
        edges = [edge.positions([k / 8 for k in range(9)]) for edge in face.edges()]
        corners = np.array([tuple(point) for points in edges for point in points])
        one = PlaneFace(normal, float(normal @ corners[0]), (corners,), face.area)
        same = next((k for k, other in enumerate(joined) if _coplanar(other, one)), None)
        if same is None:
            joined.append(one)
        else:
            pieces, area = joined[same].pieces + one.pieces, joined[same].area_mm2 + one.area_mm2
            joined[same] = replace(joined[same], pieces=pieces, area_mm2=area)
    return tuple(sorted(joined, key=lambda plane: -round(plane.area_mm2, 2)))


def _coplanar(a: PlaneFace, b: PlaneFace) -> bool:
    near = np.abs(b.corners @ a.normal - a.offset_mm).max() < NEAR_MM
    return bool(near) and float(a.normal @ b.normal) > PARALLEL


def cylinders(shape: Shape) -> tuple[Cylinder, ...]:
    """Every cylinder, its faces joined."""
    joined: list[Cylinder] = []
    for one in (_cylinder(face) for face in shape.faces().filter_by(GeomType.CYLINDER)):
        same = next((k for k, other in enumerate(joined) if _continues(other, one)), None)
        if same is None:
            joined.append(one)
            continue
        other = joined[same]
        joined[same] = replace(
            other,
            low_mm=min(other.low_mm, one.low_mm),
            high_mm=max(other.high_mm, one.high_mm),
            turn_deg=other.turn_deg + one.turn_deg,
        )
    return tuple(joined)


def holes(shape: Shape, found: Iterable[Cylinder]) -> tuple[Hole, ...]:
    """The round holes among the cylinders of a solid."""
    groups: list[list[Cylinder]] = []
    for piece in sorted(found, key=lambda c: (c.low_mm, c.diameter_mm)):
        if not piece.hollow or piece.turn_deg < _WHOLE_DEG:
            continue
        same = (
            g
            for g in groups
            if coaxial(g[0], piece) and piece.low_mm - g[-1].high_mm <= _CHAMFER_MM
        )
        group = next(same, None)
        if group is None:
            groups.append([piece])
        else:
            group.append(piece)
    return tuple(
        Hole(
            tuple(group),
            _opens(shape, group[0], group[0].low_mm, -1),
            _opens(shape, group[-1], group[-1].high_mm, 1),
        )
        for group in groups
    )


def coaxial(a: Cylinder, b: Cylinder) -> bool:
    """Whether two cylinders have the same axis."""
    return parallel(a.axis, b.axis) and float(np.linalg.norm(a.foot - b.foot)) < NEAR_MM


def parallel(a: Vector, b: Vector) -> bool:
    """Whether two unit vectors are parallel or opposite."""
    return abs(float(a @ b)) > PARALLEL


def _continues(a: Cylinder, b: Cylinder) -> bool:
    apart = max(a.low_mm, b.low_mm) - min(a.high_mm, b.high_mm)
    same = a.hollow == b.hollow and abs(a.diameter_mm - b.diameter_mm) < NEAR_MM
    return same and coaxial(a, b) and apart < NEAR_MM


def _cylinder(face: Face) -> Cylinder:
    surface = BRepAdaptor_Surface(face.wrapped)
    form = surface.Cylinder()
    place, way = form.Axis().Location(), form.Axis().Direction()
    axis = _unit(np.array([way.X(), way.Y(), way.Z()]))
    if axis @ _FORWARD < 0:
        axis = -axis
    point = np.array([place.X(), place.Y(), place.Z()])
    foot = point - axis * (axis @ point)
    edges = [edge.positions([k / 16 for k in range(17)]) for edge in face.edges()]
    along = [float(axis @ _array(point)) for points in edges for point in points]
    middle = _array(face.position_at(0.5, 0.5))
    out = middle - foot - axis * (axis @ middle)
    hollow = float(_array(face.normal_at(0.5, 0.5)) @ out) < 0
    turn = np.degrees(surface.LastUParameter() - surface.FirstUParameter())
    return Cylinder(axis, foot, 2 * form.Radius(), min(along), max(along), float(turn), hollow)


def _opens(shape: Shape, piece: Cylinder, end_mm: float, way: int) -> bool:
    """Whether there is no material behind an end, as far as the tip of a drill reaches."""
    steps = np.linspace(0.05, 1.0, 8) * piece.diameter_mm
    points = [piece.foot + piece.axis * (end_mm + way * step) for step in steps]
    return not any(_inside(shape, point) for point in points)


def _inside(shape: Shape, point: Vector) -> bool:
    classifier = BRepClass3d_SolidClassifier(shape.wrapped)
    classifier.Perform(gp_Pnt(*point.tolist()), 1e-6)
    return bool(classifier.State() == TopAbs_State.TopAbs_IN)


def _points(matrix: Vector, points: Vector) -> Vector:
    return np.asarray(points @ matrix[:3, :3].T + matrix[:3, 3])


def _unit(vector: Vector) -> Vector:
    return np.asarray(vector / np.linalg.norm(vector))


def _array(point: object) -> Vector:
    return np.array(tuple(point))  # type: ignore[arg-type]  # a vector of build123d
