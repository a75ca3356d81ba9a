"""STEP: points, faces and radii moved, the whole moved, scaled or in another unit."""

import re
from collections import Counter

from numpy.random import Generator

from mutations.amounts import cut_short, distance_mm, factor, replaced
from mutations.damage import Mutators, NotApplicableError
from mutations.meshes import AXES

# Only points in space: one of two numbers is a point in the plane of a surface's parameters, which
# readers compute anew.
_POINT = re.compile(r"(CARTESIAN_POINT\(\s*'[^']*',\s*\()([^(),]+),([^(),]+),([^(),]+)(\)\s*\))")
_RADIUS = re.compile(r"((?:CIRCLE|CYLINDRICAL_SURFACE)\(\s*'[^']*',\s*#\d+,\s*)([^(),]+)(\))")
_SHELL = re.compile(r"CLOSED_SHELL\(\s*'[^']*',\s*\(([^)]*)\)")
_NUMBERED = re.compile(rf"(#\d+) = {_POINT.pattern}")
_VERTEX = re.compile(r"VERTEX_POINT\(\s*'[^']*',\s*(#\d+)\)")
_LEAST_POINTS = 3
"""Corners of a face. The points of planes and lines alone may slide along them, unseen."""


def _number(value: float) -> str:
    return f"{value:.9f}".rstrip("0")


def _with_points(
    text: str, axis: int, change: "dict[float, float] | None", by: float = 0.0, scale: float = 1.0
) -> str:
    """The text with one coordinate of its points changed."""

    def point(match: re.Match[str]) -> str:
        values = [match[2], match[3], match[4]]
        old = float(values[axis])
        new = old * scale + by if change is None else change.get(round(old, 6), old)
        if new != old:
            values[axis] = _number(new)
        return f"{match[1]}{','.join(values)}{match[5]}"

    return _POINT.sub(point, text)


def _moved(data: bytes, rng: Generator) -> tuple[bytes, str]:
    axis, by = int(rng.integers(3)), distance_mm(rng)
    text = _with_points(data.decode(), axis, None, by)
    return text.encode(), f"every point moved by {by:g} mm in {AXES[axis]}"


def _scaled(data: bytes, rng: Generator) -> tuple[bytes, str]:
    by = factor(rng)
    text = data.decode()
    for axis in range(3):
        text = _with_points(text, axis, None, scale=by)
    text = _RADIUS.sub(lambda m: m[1] + _number(float(m[2]) * by) + m[3], text)
    return text.encode(), f"every point and radius times {by:g}"


def _face_moved(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """All points in one plane across an axis, as of a face in another place."""
    text, axis = data.decode(), int(rng.integers(3))
    corners = set(_VERTEX.findall(text))
    heights = Counter(
        round(float(m[3 + axis]), 6) for m in _NUMBERED.finditer(text) if m[1] in corners
    )
    often = sorted(v for v, count in heights.items() if count >= _LEAST_POINTS)
    if not often:
        raise NotApplicableError
    old, by = often[int(rng.integers(len(often)))], distance_mm(rng)
    new = _with_points(text, axis, {old: old + by})
    return new.encode(), f"{heights[old]} points at {AXES[axis]} = {old:g} moved by {by:g} mm"


def _radius(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """All circles and cylinders of one radius."""
    text = data.decode()
    found = sorted({m[2] for m in _RADIUS.finditer(text)})
    if not found:
        raise NotApplicableError
    old = found[int(rng.integers(len(found)))]
    new = abs(float(old) + distance_mm(rng)) or 1.0
    text = _RADIUS.sub(lambda m: m[1] + _number(new) + m[3] if m[2] == old else m[0], text)
    return text.encode(), f"circles and cylinders of radius {old} have {new:g} mm"


def _face_removed(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """A shell without one of its faces."""
    text = data.decode()
    shells = list(_SHELL.finditer(text))
    if not shells:
        raise NotApplicableError
    shell = shells[int(rng.integers(len(shells)))]
    faces = re.findall(r"#\d+", shell[1])
    gone = faces.pop(int(rng.integers(len(faces))))
    new = text[: shell.start(1)] + ",".join(faces) + text[shell.end(1) :]
    return new.encode(), f"face {gone} of {len(faces) + 1} is not in its shell"


_UNIT = replaced(
    ("SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT($,.METRE.)"),
    ("SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT(.CENTI.,.METRE.)"),
    ("SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT(.MICRO.,.METRE.)"),
)
STEP: Mutators = {
    "move": _moved,
    "scale": _scaled,
    "move a face": _face_moved,
    "number": _radius,
    "remove": _face_removed,
    "unit": _UNIT,
    "truncate": cut_short,
}
