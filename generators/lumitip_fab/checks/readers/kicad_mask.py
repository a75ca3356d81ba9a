"""Openings of the solder mask of a `.kicad_pcb`. Places are on KiCad's page: mm, y down."""

from collections.abc import Iterator
from dataclasses import dataclass

from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.readers import kicad_shapes as shapes
from lumitip_fab.checks.readers.kicad_shapes import Node, child, children, numbers, words

_FRONT, _BACK = {"F.Mask", "*.Mask", "F&B.Mask"}, {"B.Mask", "*.Mask", "F&B.Mask"}


@dataclass(frozen=True, eq=False)
class Opening:
    """Where a pad is free of the solder mask."""

    front: bool
    area: BaseGeometry


def openings(root: Node) -> Iterator[Opening]:
    """The openings of all pads of a board."""
    general = numbers(child(child(root, "setup") or [], "pad_to_mask_clearance")) or (0.0,)
    for part in children(root, "footprint", "module"):
        place, of_part = shapes.Place.of(part), _margin(part) or general
        for pad in children(part, "pad"):
            margin = (_margin(pad) or of_part)[0]
            area = shapes.pad(pad, place.of_pad(pad)).buffer(margin, quad_segs=shapes.STEPS)
            layers = set(words(child(pad, "layers")))
            for front, names in ((True, _FRONT), (False, _BACK)):
                if layers & names:
                    yield Opening(front, area)


def _margin(node: Node) -> tuple[float, ...]:
    """Beyond the copper, mm; none where a node does not state it."""
    return numbers(child(node, "solder_mask_margin"))
