"""Bodies of parts: their outline on the fabrication layer, and their 3D model."""

from collections.abc import Iterator

import shapely

from lumitip_fab.boards.kicad.sexpr import Node, Quoted
from lumitip_fab.boards.model import PlacedComponent, Stroke
from lumitip_fab.boards.silk.shrouds import notch
from lumitip_fab.design import Box, Footprint
from lumitip_fab.design.pcb import MODELS

_FAB_MM = 0.1
_COURTYARD_MM = 0.05
_FOLDER = f"${{KIPRJMOD}}/../{MODELS.rpartition('/')[2]}"


def body_strokes(shape: Footprint) -> Iterator[Stroke]:
    """The body seen from above; of a box header also the shroud with its notch."""
    yield around(shape.body, _FAB_MM)
    if shape.shroud:
        yield around(shape.shroud.box, _FAB_MM)
        yield from (Stroke(ends, _FAB_MM) for ends in notch(shape.shroud))


def courtyard_strokes(part: PlacedComponent) -> Iterator[Stroke]:
    """The courtyard, with that of the shroud as one outline where they meet: KiCad takes lines
    that cross for a fault."""
    yards = [yard for yard in (part.courtyard, part.shroud_yard) if yard]
    joined = shapely.union_all([shapely.box(*yard.bounds_mm) for yard in yards])
    for area in shapely.get_parts(joined.normalize()):
        yield Stroke(tuple(area.exterior.coords), _COURTYARD_MM)


def around(box: Box, width_mm: float) -> Stroke:
    """A rectangle as a closed polyline."""
    left, right, low, high = box.x_min_mm, box.x_max_mm, box.y_min_mm, box.y_max_mm
    corners = (left, low), (right, low), (right, high), (left, high), (left, low)
    return Stroke(corners, width_mm)


def model(shape: Footprint) -> Iterator[Node]:
    """The 3D model, in the footprint's frame; none of bare copper."""
    if not shape.model:
        return
    turn_deg = 180 if shape.shroud and shape.shroud.facing == "south" else 0
    yield (
        "model",
        Quoted(f"{_FOLDER}/{shape.model}"),
        ("offset", ("xyz", 0, 0, 0)),
        ("scale", ("xyz", 1, 1, 1)),
        ("rotate", ("xyz", 0, 0, turn_deg)),
    )
