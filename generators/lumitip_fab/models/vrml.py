"""Named bodies to the text of a VRML 2.0 file, as the 3D libraries of KiCad have them."""

from collections.abc import Iterable, Iterator

from lumitip_fab.models.shapes import Named
from lumitip_fab.parts.export import mesh

UNIT_MM = 2.54
"""Of a VRML file of KiCad: a tenth of an inch."""
CHORD_MM = 0.05
"""How far a triangle may lie off a curved face."""
_DECIMALS = 5


def vrml(bodies: Iterable[Named]) -> bytes:
    """A shape with its colour for each body, z up from the board."""
    lines = ["#VRML V2.0 utf8", *(line for body in bodies for line in _shape(body))]
    return ("\n".join(lines) + "\n").encode("ascii")


def _shape(body: Named) -> Iterator[str]:
    surface = mesh(body.shape(), CHORD_MM)
    points = (surface.points_mm / UNIT_MM).round(_DECIMALS) + 0.0  # no negative zeros
    red, green, blue = body.colour
    yield f"# {body.name}"
    yield "Shape {"
    yield " appearance Appearance { material Material {"
    yield f"  diffuseColor {red:g} {green:g} {blue:g} ambientIntensity 0.2 shininess 0.1"
    yield " } }"
    yield " geometry IndexedFaceSet { creaseAngle 0.5 coord Coordinate { point ["
    yield ",\n".join(" ".join(f"{value:g}" for value in point) for point in points.tolist())
    yield " ] } coordIndex ["
    yield ",\n".join(f"{a},{b},{c},-1" for a, b, c in surface.triangles.tolist())
    yield " ] }"
    yield "}"
