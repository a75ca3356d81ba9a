"""`Bodies`: the objects between the fingers of a MuJoCo model, in the receiver's sensor frame."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import mujoco
import numpy as np

from lumitip.grid import Floats, Integers
from lumitip.mujoco.copies import Copies
from lumitip.mujoco.materials import Material, Materials
from lumitip.mujoco.outlines import clipped, hull, runs, sheet_outlines

_RIM = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
_RING = np.stack([np.cos(_RIM), np.sin(_RIM)], axis=1)
_CUBE = np.array([(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
_FLAT = 0.5  # share of a cylinder's direction along z up to which it lies like a cable
_UPRIGHT = 0.999  # the same, from which on it is a disc
_BOX, _MESH = int(mujoco.mjtGeom.mjGEOM_BOX), int(mujoco.mjtGeom.mjGEOM_MESH)
_BALLS = (int(mujoco.mjtGeom.mjGEOM_SPHERE), int(mujoco.mjtGeom.mjGEOM_ELLIPSOID))
_CAPSULE, _CYLINDER = int(mujoco.mjtGeom.mjGEOM_CAPSULE), int(mujoco.mjtGeom.mjGEOM_CYLINDER)
_SAME_MM, _OFF = 1e-3, 0.317  # geoms this near are one object; no round figure is at a limit
Part = tuple[Material, Floats, float]
"""Of a line: material, both ends, shape `(2, 3)`, and radius (mm)."""
_SEEN = (*_BALLS, _BOX, _MESH, _CAPSULE, _CYLINDER)


@dataclass(frozen=True, eq=False)
class Body:
    """An object between the fingers."""

    form: Literal["outline", "line", "disc"]
    points_mm: Floats
    """Corners of an outline counter-clockwise, points of a line, or the middle of a disc, shape
    `(n, 2)`."""
    z_mm: float
    """Mean height above the receiver of what is between the fingers."""
    material: Material
    radius_mm: float = 0.0
    """Of a line or a disc."""


class Bodies:
    """Reads the objects of a model, but not those that are fixed to its fingers."""

    def __init__(
        self, model: mujoco.MjModel, fingers: tuple[int, int], materials: Materials
    ) -> None:
        """Find what can lie between the fingers.

        Args:
            model: with the fingers.
            fingers: ids of their bodies.
            materials: of geoms and flexes.

        Raises:
            MujocoError: if a material is that of a geom that shades nothing.
        """
        self._model, self._materials = model, materials
        seen = [
            geom
            for geom in range(model.ngeom)
            if int(model.geom_type[geom]) in _SEEN
            and not _fixed(model, int(model.geom_bodyid[geom]), fingers)
        ]
        self._geoms = np.array(seen, np.int64)
        self._copies = Copies(model, seen, materials)
        self._meshes = {
            geom: _mesh(model, int(model.geom_dataid[geom]))
            for geom in seen
            if int(model.geom_type[geom]) == _MESH
        }

    def between(self, data: mujoco.MjData, frame: Floats, box_mm: Floats) -> Iterator[Body]:
        """The objects of which some part is within a box.

        Args:
            data: state of the model.
            frame: from the world to the sensor frame, shape `(4, 4)` (m).
            box_mm: lower and upper corner of the box in the sensor frame, shape `(2, 3)`.
        """
        yield from self._solids(data, frame, box_mm)
        for flex in range(self._model.nflex):
            yield from self._flexible(flex, data, frame, box_mm)

    def _solids(self, data: mujoco.MjData, frame: Floats, box_mm: Floats) -> Iterator[Body]:
        model, geoms = self._model, self._geoms
        centre_mm = _to(frame, data.geom_xpos[geoms])
        reach_mm = 1e3 * model.geom_rbound[geoms, None]
        near = ((centre_mm + reach_mm > box_mm[0]) & (centre_mm - reach_mm < box_mm[1])).all(axis=1)
        lines: list[Part] = []
        solids: list[Body] = []
        for geom, middle in zip(geoms[near].tolist(), centre_mm[near], strict=True):
            if not self._materials.visible(geom) or self._copies.only_looked_at(geom):
                continue
            turn = frame[:3, :3] @ data.geom_xmat[geom].reshape(3, 3)
            size_mm = 1e3 * model.geom_size[geom]
            kind, material = int(model.geom_type[geom]), self._materials.of_geom(geom)
            if kind in (_CAPSULE, _CYLINDER) and abs(turn[2, 2]) < _FLAT:
                ends = middle + np.outer((-size_mm[1], size_mm[1]), turn[:, 2])
                lines.append((material, ends, float(size_mm[0])))
                continue
            points = middle + self._points(geom, kind, size_mm, turn)
            if not _within(points, box_mm):
                continue
            z_mm = float(np.clip(points[:, 2], *box_mm[:, 2]).mean())
            if kind == _BALLS[0] or (kind == _CYLINDER and abs(turn[2, 2]) > _UPRIGHT):
                solids.append(Body("disc", middle[None, :2], z_mm, material, float(size_mm[0])))
            else:
                solids += _outline(hull(points[:, :2]), z_mm, material)
        yield from _without_copies(solids)
        yield from _chains(_lines_without_copies(lines), box_mm)

    def _points(self, geom: int, kind: int, size_mm: Floats, turn: Floats) -> Floats:
        """Points whose hull along z is the outline of a solid around its middle, `(n, 3)` (mm)."""
        if kind == _MESH:
            points: Floats = self._meshes[geom] @ turn.T
        elif kind == _BOX:
            points = (_CUBE * size_mm) @ turn.T
        elif kind == _CYLINDER:
            points = np.concatenate(
                [np.insert(size_mm[0] * _RING, 2, z, axis=1) for z in (-size_mm[1], size_mm[1])]
            )
            points = points @ turn.T
        elif kind == _CAPSULE:
            ball = _rim(np.full(3, size_mm[0]), turn)
            points = np.concatenate([ball + z * turn[:, 2] for z in (-size_mm[1], size_mm[1])])
        else:
            points = _rim(size_mm if kind == _BALLS[1] else np.full(3, size_mm[0]), turn)
        return points

    def _flexible(
        self, flex: int, data: mujoco.MjData, frame: Floats, box_mm: Floats
    ) -> Iterator[Body]:
        model = self._model
        first, number = int(model.flex_vertadr[flex]), int(model.flex_vertnum[flex])
        points = _to(frame, data.flexvert_xpos[first : first + number])
        size, radius_mm = int(model.flex_dim[flex]) + 1, 1e3 * float(model.flex_radius[flex])
        begin = int(model.flex_elemdataadr[flex])
        parts = model.flex_elem[begin : begin + size * int(model.flex_elemnum[flex])]
        parts = parts.reshape(-1, size)
        corners = points[parts]
        low, high = corners.min(axis=1) - radius_mm, corners.max(axis=1) + radius_mm
        near = parts[((high > box_mm[0]) & (low < box_mm[1])).all(axis=1)]
        if not len(near):
            return
        material = self._materials.of_flex(flex)
        z_mm = float(np.clip(points[np.unique(near), 2], *box_mm[:, 2]).mean())
        if size == 2:
            yield from _chains([(material, points[pair], radius_mm) for pair in near], box_mm)
        elif size == 3:
            for outline in sheet_outlines(points[:, :2], near):
                yield from _outline(clipped(outline, *box_mm[:, :2]), z_mm, material)
        else:
            yield from _outline(hull(points[np.unique(near), :2]), z_mm, material)


def _fixed(model: mujoco.MjModel, body: int, fingers: tuple[int, int]) -> bool:
    """Whether a body is a finger or fixed to one."""
    for finger in fingers:
        if body == finger or int(model.body_weldid[finger]) == int(model.body_weldid[body]) != 0:
            return True
    parent = int(model.body_parentid[body])
    # Of fingers that are fixed to the world, the bodies fixed below them.
    still = int(model.body_weldid[body]) == 0
    return bool(body) and still and _fixed(model, parent, fingers)


def _to(frame: Floats, points_m: Floats) -> Floats:
    points_mm: Floats = 1e3 * (points_m @ frame[:3, :3].T + frame[:3, 3])
    return points_mm


def _within(points: Floats, box: Floats) -> bool:
    """Whether points reach into a box, each shape `(n, 3)`."""
    return bool((points.max(axis=0) > box[0]).all() and (points.min(axis=0) < box[1]).all())


def _without_copies(solids: list[Body]) -> list[Body]:
    """Solids, one of those that are seen alike at the same place."""
    if len(solids) < 2:
        return solids
    kept: dict[tuple[object, ...], Body] = {}
    for solid in solids:
        corners = _place(solid.points_mm).tobytes()
        kept.setdefault(
            (solid.form, solid.material, corners, int(_place(solid.z_mm)), solid.radius_mm), solid
        )
    return list(kept.values())


def _lines_without_copies(parts: list[Part]) -> list[Part]:
    """The same of parts of lines: a copy, begun at either end, would lead a line back."""
    if len(parts) < 2:
        return parts
    kept: dict[tuple[object, ...], Part] = {}
    for part, ends in zip(parts, _place(np.stack([ends for _, ends, _ in parts])), strict=True):
        kept.setdefault((part[0], part[2], frozenset(map(tuple, ends.tolist()))), part)
    return list(kept.values())


def _place(of_mm: Floats | float) -> Integers:
    """The same whole numbers for places that are equal but for rounding."""
    steps: Integers = np.floor(np.asarray(of_mm) / _SAME_MM + _OFF).astype(np.int64)
    return steps


def _outline(points: Floats, z_mm: float, material: Material) -> Iterator[Body]:
    if len(points) > 2:
        yield Body("outline", points, z_mm, material)


def _rim(size_mm: Floats, turn: Floats) -> Floats:
    """Rim of an ellipsoid as seen along z, and its top and bottom, shape `(n, 3)` (mm)."""
    spread = (turn * size_mm**2) @ turn.T
    flat = np.linalg.cholesky(spread[:2, :2])
    up = np.sqrt(spread[2, 2])
    return np.concatenate(
        [np.insert(_RING @ flat.T, 2, 0.0, axis=1), [[0.0, 0.0, -up], [0.0, 0.0, up]]]
    )


def _mesh(model: mujoco.MjModel, mesh: int) -> Floats:
    """Points of the convex hull of a mesh, or all if MuJoCo has made none, `(n, 3)` (mm)."""
    first, number = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    points = 1e3 * model.mesh_vert[first : first + number].astype(np.float64)
    graph = int(model.mesh_graphadr[mesh])
    if graph < 0:
        return np.asarray(points)
    corners = int(model.mesh_graph[graph])
    return np.asarray(points[model.mesh_graph[graph + 2 + corners : graph + 2 + 2 * corners]])


def _chains(parts: list[Part], box_mm: Floats) -> Iterator[Body]:
    """Lines within a box, from parts, shape `(2, 3)`, that may begin where others end (mm)."""
    left = list(parts)
    while left:
        material, line, radius = left.pop(0)
        place: int | None = 0
        while place is not None:
            place = None
            for number, (of_other, ends, other) in enumerate(left):
                joined = _joined(line, ends, radius)
                if (of_other, other) == (material, radius) and joined is not None:
                    line, place = joined, number
                    break
            if place is not None:
                del left[place]
        grown = np.array([-radius, radius])[:, None] + box_mm
        for run in runs(line, *grown):
            if np.linalg.norm(run[0, :2] - run[-1, :2]) + np.ptp(run[:, :2]) > 1e-6:
                z_mm = float(np.clip(run[:, 2], *box_mm[:, 2]).mean())
                yield Body("line", run[:, :2], z_mm, material, radius)


def _joined(line: Floats, ends: Floats, radius: float) -> Floats | None:
    """The line with another part at its begin or end, if they meet."""
    near = 0.3 * radius + 1e-6
    for part in (ends, ends[::-1]):
        if np.linalg.norm(part[0] - line[-1]) < near:
            return np.concatenate([line, part[1:]])
        if np.linalg.norm(part[1] - line[0]) < near:
            return np.concatenate([part[:1], line])
    return None
