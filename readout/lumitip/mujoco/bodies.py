"""What lies between the fingers of a MuJoCo model, as lines and outlines in the sensor frame."""

from collections.abc import Iterator
from dataclasses import dataclass

import mujoco
import numpy as np

from lumitip.grid import Floats
from lumitip.mujoco.outlines import hull, sheet_outlines

_RIM = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
_FLAT = 0.5  # share of a cylinder's direction along z up to which it lies like a cable
_UPRIGHT = 0.999  # the same, from which on it is a disc
_UNSEEN = (int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD))
_ROUND = (int(mujoco.mjtGeom.mjGEOM_CAPSULE), int(mujoco.mjtGeom.mjGEOM_CYLINDER))


@dataclass(frozen=True, eq=False)
class Body:
    """An object between the fingers, in the receiver's sensor frame."""

    name: str
    points_mm: Floats
    """Corners of an outline, points of a line, or the middle of a disc, shape `(n, 2)`."""
    z_mm: float
    """Mean height above the receiver."""
    radius_mm: float = 0.0
    """Of a line or a disc; 0 for an outline."""


class Bodies:
    """Reads the objects of a model between its fingers; `ROUND` solids that lie are lines."""

    def __init__(self, model: mujoco.MjModel, fingers: tuple[int, int]) -> None:
        """Find what can lie there.

        Args:
            model: with the fingers.
            fingers: ids of their bodies.
        """
        self._model = model
        self._geoms = np.array(
            [
                geom
                for geom in range(model.ngeom)
                if model.geom_type[geom] not in _UNSEEN
                and not _belongs(model, int(model.geom_bodyid[geom]), fingers)
            ],
            np.int64,
        )
        self._solids = {int(geom): _solid(model, int(geom)) for geom in self._geoms}

    def between(self, data: mujoco.MjData, frame: Floats, box_mm: Floats) -> Iterator[Body]:
        """The objects of which some part is within a box.

        Args:
            data: state of the model.
            frame: from the world to the sensor frame, shape `(4, 4)` (m).
            box_mm: lower and upper corner of the box in the sensor frame, shape `(2, 3)`.
        """
        yield from self._lying(data, frame, box_mm)
        for flex in range(self._model.nflex):
            yield from self._flexible(flex, data, frame, box_mm)

    def _lying(self, data: mujoco.MjData, frame: Floats, box_mm: Floats) -> Iterator[Body]:
        model, geoms = self._model, self._geoms
        centre_mm = _to(frame, data.geom_xpos[geoms])
        reach_mm = 1e3 * model.geom_rbound[geoms, None]
        near = ((centre_mm + reach_mm > box_mm[0]) & (centre_mm - reach_mm < box_mm[1])).all(axis=1)
        lines: list[tuple[str, Floats, float]] = []
        for geom, middle in zip(geoms[near].tolist(), centre_mm[near], strict=True):
            turn = frame[:3, :3] @ data.geom_xmat[geom].reshape(3, 3)
            name = model.geom(geom).name
            if model.geom_type[geom] in _ROUND and abs(turn[2, 2]) < _FLAT:
                radius_mm, half_mm = 1e3 * model.geom_size[geom, :2]
                ends = middle + np.outer((-half_mm, half_mm), turn[:, 2])
                lines.append((name, ends, float(radius_mm)))
            elif _is_disc(int(model.geom_type[geom]), turn):
                yield Body(name, middle[None, :2], middle[2], 1e3 * float(model.geom_size[geom, 0]))
            else:
                points = middle + self._solids[geom] @ turn.T
                if _within(points, box_mm):
                    yield from _outline(name, hull(points[:, :2]), middle[2])
        yield from _chains(lines)

    def _flexible(
        self, flex: int, data: mujoco.MjData, frame: Floats, box_mm: Floats
    ) -> Iterator[Body]:
        model = self._model
        first, number = int(model.flex_vertadr[flex]), int(model.flex_vertnum[flex])
        points = _to(frame, data.flexvert_xpos[first : first + number])
        inside = ((points > box_mm[0]) & (points < box_mm[1])).all(axis=1)
        if not inside.any():
            return
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_FLEX, flex) or ""
        size = int(model.flex_dim[flex]) + 1
        begin = int(model.flex_elemdataadr[flex])
        parts = model.flex_elem[begin : begin + size * int(model.flex_elemnum[flex])]
        parts = parts.reshape(-1, size)
        near = parts[inside[parts].any(axis=1)]
        z_mm = float(points[inside, 2].mean())
        if size == 2:
            radius_mm = 1e3 * float(model.flex_radius[flex])
            yield from _chains([(name, points[pair], radius_mm) for pair in near])
            return
        if size == 4:  # the skin of a solid
            near = np.concatenate([near[:, face] for face in ([0, 1, 2], [0, 1, 3])])
            yield from _outline(name, hull(points[np.unique(near), :2]), z_mm)
            return
        for outline in sheet_outlines(points[:, :2], near):
            yield from _outline(name, outline, z_mm)


def _belongs(model: mujoco.MjModel, body: int, fingers: tuple[int, int]) -> bool:
    """Whether a body is a part of a finger."""
    while body and body not in fingers:
        body = int(model.body_parentid[body])
    return body in fingers


def _is_disc(kind: int, turn: Floats) -> bool:
    """Whether a geom, turned into the sensor frame, is seen as a disc."""
    if kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        return True
    return kind in _ROUND and abs(turn[2, 2]) > _UPRIGHT


def _to(frame: Floats, points_m: Floats) -> Floats:
    points_mm: Floats = 1e3 * (points_m @ frame[:3, :3].T + frame[:3, 3])
    return points_mm


def _within(points: Floats, box: Floats) -> bool:
    """Whether points reach into a box, each shape `(n, 3)`."""
    return bool((points.max(axis=0) > box[0]).all() and (points.min(axis=0) < box[1]).all())


def _outline(name: str, points: Floats, z_mm: float) -> Iterator[Body]:
    if len(points) > 2:
        yield Body(name, points, float(z_mm))


def _chains(parts: list[tuple[str, Floats, float]]) -> Iterator[Body]:
    """Lines from parts, shape `(2, 3)`, of which each may begin where another ends (mm)."""
    left = list(parts)
    while left:
        name, line, radius = left.pop(0)
        grown = True
        while grown:
            grown = False
            for place, (_, ends, other) in enumerate(left):
                joined = _joined(line, ends, radius) if other == radius else None
                if joined is not None:
                    line, grown = joined, True
                    del left[place]
                    break
        if np.linalg.norm(np.diff(line[:, :2], axis=0), axis=1).max() > 1e-6:
            yield Body(name, line[:, :2], float(line[:, 2].mean()), radius)


def _joined(line: Floats, ends: Floats, radius: float) -> Floats | None:
    """The line with another part at its begin or end, if they meet."""
    near = 0.3 * radius + 1e-6
    for part in (ends, ends[::-1]):
        if np.linalg.norm(part[0] - line[-1]) < near:
            return np.concatenate([line, part[1:]])
        if np.linalg.norm(part[1] - line[0]) < near:
            return np.concatenate([part[:1], line])
    return None


def _solid(model: mujoco.MjModel, geom: int) -> Floats:
    """Points whose convex hull is the body of a geom, in its own frame, shape `(n, 3)` (mm)."""
    kind, size = int(model.geom_type[geom]), 1e3 * model.geom_size[geom]
    ring = np.stack([np.cos(_RIM), np.sin(_RIM)], axis=1)
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        first = int(model.mesh_vertadr[mesh])
        vertices = model.mesh_vert[first : first + int(model.mesh_vertnum[mesh])]
        return np.asarray(1e3 * vertices, np.float64)
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        signs: Floats = np.array(np.meshgrid(*[(-1.0, 1.0)] * 3)).reshape(3, -1).T
        corners: Floats = signs * size
        return corners
    if kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        return np.concatenate(
            [np.insert(size[0] * ring, 2, z, axis=1) for z in (-size[1], size[1])]
        )
    half = size if kind == mujoco.mjtGeom.mjGEOM_ELLIPSOID else size[[0, 0, 0]]
    rises = np.linspace(-np.pi / 2.0, np.pi / 2.0, 25)
    ball = np.concatenate(
        [np.insert(np.cos(rise) * ring, 2, np.sin(rise), axis=1) for rise in rises]
    )
    points: Floats = ball * half
    if kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        points[:, 2] += size[1] * np.sign(ball[:, 2])
    return points
