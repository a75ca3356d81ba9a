"""Lugs for cable ties as solids, in the frame in which their part is printed."""

from build123d import Face, Solid, Vector, Wire

from lumitip_fab.design import Point, TieLug

BEYOND_MM = 1.0  # how far a cutter reaches past what it cuts


def lug_solids(lugs: tuple[TieLug, ...]) -> list[Solid]:
    """What is added to the part."""
    return [_drawn(lug, list(lug.profile), 0.0) for lug in lugs]


def lug_openings(lugs: tuple[TieLug, ...]) -> list[Solid]:
    """What is cut out of it for the ties."""
    cutters = []
    for lug in lugs:
        low, high = (lug.opening.y_min_mm, lug.opening.y_max_mm)
        inner, outer = lug.opening.x_min_mm, lug.opening.x_max_mm
        corners = [(inner, low), (outer, low), (outer, high), (inner, high)]
        cutters.append(_drawn(lug, corners, BEYOND_MM))
    return cutters


def _drawn(lug: TieLug, profile: list[Point], beyond_mm: float) -> Solid:
    """A profile drawn out along the wall."""
    first, last = lug.along_mm[0] - beyond_mm, lug.along_mm[1] + beyond_mm
    points = [(lug.side * (lug.face_mm + out), first, up) for out, up in profile]
    return Solid.extrude(Face(Wire.make_polygon(points, close=True)), Vector(0, last - first, 0))
