"""Plane geometry of outlines and lines, in any unit of length."""

import numpy as np
from numpy.typing import NDArray

from lumitip.grid import Floats, Integers


def hull(points: Floats) -> Floats:
    """Convex hull of points, counter-clockwise, by Andrew's monotone chain.

    Args:
        points: shape `(n, 2)`.

    Returns:
        Its corners, shape `(corners, 2)`; fewer than three if the points lie on a line.
    """
    ordered = sorted(set(map(tuple, np.round(points, 6).tolist())))
    lower, upper = _chain(ordered), _chain(ordered[::-1])
    return np.array(lower[:-1] + upper[:-1])


def _chain(ordered: list[tuple[float, ...]]) -> list[tuple[float, ...]]:
    chain: list[tuple[float, ...]] = []
    for x, y in ordered:
        while len(chain) > 1:
            (ax, ay), (bx, by) = chain[-2:]
            if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0.0:
                break
            chain.pop()
        chain.append((x, y))
    return chain


def sheet_outlines(points: Floats, triangles: Integers) -> list[Floats]:
    """Outlines of a mesh of triangles, one layer of a fold after the other.

    Triangles that are seen from the front and those seen from the back are different layers, so
    that a folded cloth is two. A hole within a layer is not seen.

    Args:
        points: of the mesh, shape `(n, 2)`.
        triangles: three points each, shape `(triangles, 3)`.

    Returns:
        Closed outlines, each of shape `(corners, 2)`.
    """
    a, b, c = (points[triangles[:, i]] for i in range(3))
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    found = []
    for layer in (triangles[area > 0.0], triangles[area < 0.0][:, ::-1]):
        found += [points[loop] for loop in _loops(layer, len(points)) if _encloses(points[loop])]
    return found


def _loops(triangles: Integers, points: int) -> list[list[int]]:
    """Closed loops of the edges that only one triangle has."""
    begin, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    border = ~np.isin(begin * points + end, end * points + begin)
    after: dict[int, list[int]] = {}
    for one, other in zip(begin[border].tolist(), end[border].tolist(), strict=True):
        after.setdefault(one, []).append(other)
    loops = []
    while after:
        first = next(iter(after))
        loop, at = [], first
        while at in after:
            loop.append(at)
            nexts = after[at]
            following = nexts.pop()
            if not nexts:
                del after[at]
            at = following
        loops.append(loop)
    return loops


def _encloses(loop: Floats) -> bool:
    """Whether a loop goes round an area, not round a hole."""
    x, y = loop.T
    return len(loop) > 2 and float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) > 0.0


def clipped(outline: Floats, low: Floats, high: Floats) -> Floats:
    """The part of an outline within a rectangle, by Sutherland and Hodgman: parts that hang
    together outside are joined along the rectangle.

    Args:
        outline: shape `(corners, 2)`.
        low, high: corners of the rectangle.
    """
    points = outline
    for axis, limit, sign in ((0, low, 1.0), (1, low, 1.0), (0, high, -1.0), (1, high, -1.0)):
        if not len(points):
            break
        inward = sign * (points[:, axis] - limit[axis])
        before, was = np.roll(points, 1, axis=0), np.roll(inward, 1)
        crosses = (inward >= 0.0) != (was >= 0.0)
        share = np.where(crosses, was / np.where(crosses, was - inward, 1.0), 0.0)[:, None]
        both = np.stack([before + share * (points - before), points], axis=1)
        kept = np.stack([crosses, inward >= 0.0], axis=1)
        points = both[kept]
    return points


def border(outline: Floats, low: Floats, high: Floats) -> Floats | None:
    """The part of an outline within a rectangle, if it crosses it once.

    Args:
        outline: counter-clockwise, shape `(corners, 2)`.
        low, high: corners of the rectangle.

    Returns:
        Points along the line, the covered side right of it, shape `(n, 2)`; the ends are outside.
        None if the outline crosses the rectangle several times, or not at all.
    """
    turned = outline[::-1]
    inside = touches(turned, np.roll(turned, -1, axis=0), low, high)
    begins = np.flatnonzero(inside & ~np.roll(inside, 1))
    if len(begins) != 1:
        return None
    return np.roll(turned, -begins[0], axis=0)[: int(inside.sum()) + 1]


def runs(line: Floats, low: Floats, high: Floats) -> list[Floats]:
    """The parts of a line that reach into a box.

    Args:
        line: points along it, shape `(n, dimensions)`.
        low, high: corners of the box.
    """
    inside = touches(line[:-1], line[1:], low, high)
    changes = np.flatnonzero(np.diff(np.concatenate([[0], inside.astype(np.int8), [0]])))
    return [line[begin : end + 1] for begin, end in changes.reshape(-1, 2)]


def touches(begin: Floats, end: Floats, low: Floats, high: Floats) -> NDArray[np.bool_]:
    """Whether each segment reaches into a box, in any number of dimensions (Liang-Barsky).

    Args:
        begin, end: of the segments, shape `(n, dimensions)`.
        low, high: corners of the box.
    """
    way = end - begin
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (low - begin) / way, (high - begin) / way
    still = way == 0.0
    beyond = still & ((begin < low) | (begin > high))
    first = np.where(still, -np.inf, np.minimum(one, other)).max(axis=1)
    last = np.where(still, np.inf, np.maximum(one, other)).min(axis=1)
    reaches: NDArray[np.bool_] = np.maximum(first, 0.0) < np.minimum(last, 1.0)
    reaches &= ~beyond.any(axis=1)
    return reaches


def turns(line: Floats) -> Floats:
    """Change of direction at the inner points of a line, left positive, shape `(n - 2,)` (rad)."""
    way = np.diff(line, axis=0)
    across = way[:-1, 0] * way[1:, 1] - way[:-1, 1] * way[1:, 0]
    turn: Floats = np.arctan2(across, (way[:-1] * way[1:]).sum(axis=1))
    return turn


def tangents(line: Floats) -> Floats:
    """Unit vectors along a line at its points, shape `(n, 2)`."""
    way = np.gradient(line, axis=0) if len(line) > 2 else np.diff(line, axis=0).repeat(2, axis=0)
    unit: Floats = way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-12)
    return unit


def beside(line: Floats, places: Floats) -> tuple[Floats, Floats]:
    """Distance of places left of a line, and direction of the line beside each.

    Args:
        line: points along it, shape `(n, 2)`.
        places: shape `(m, 2)`.

    Returns:
        Distance, in the unit of the points, and direction (degrees), each of shape `(m,)`.
    """
    way = np.diff(line, axis=0)
    square = np.maximum((way**2).sum(axis=1), 1e-18)
    from_begin = places[:, None] - line[:-1]
    share = (from_begin * way).sum(axis=2) / square
    # The first and the last part go on beyond their ends.
    low, high = np.zeros(len(way)), np.ones(len(way))
    low[0], high[-1] = -np.inf, np.inf
    share = np.clip(share, low, high)
    away = from_begin - share[..., None] * way
    nearest = (away**2).sum(axis=2).argmin(axis=1)
    each = np.arange(len(places))
    along, off = share[each, nearest, None], away[each, nearest]
    corner = tangents(line)
    along = np.clip(along, 0.0, 1.0)
    mean = (1.0 - along) * corner[nearest] + along * corner[nearest + 1]
    left = way[nearest, 0] * off[:, 1] - way[nearest, 1] * off[:, 0]
    return (
        np.copysign(np.hypot(*off.T), left),
        np.degrees(np.arctan2(mean[:, 1], mean[:, 0])),
    )
