"""Both fingers with boards, silicone and film, facing each other in the gripper frame."""

from collections.abc import Iterator
from copy import copy

import numpy as np
from build123d import Color, Compound, Shape, Solid

from lumitip_fab.design import Design
from lumitip_fab.design.frames import finger_to_gripper
from lumitip_fab.parts import export
from lumitip_fab.parts.shapes import placed
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.pipeline.artefact import Artefact
from lumitip_fab.scenes.bodies import Bodies, finger_bodies, layers_of
from lumitip_fab.scenes.exploded import exploded_view
from lumitip_fab.scenes.glb import Body, Group, colour_of, glb

OPENING_MM = 30.0
CHORD_MM = 0.02
_M_TO_MM = np.diag([1000.0, 1000.0, 1000.0, 1.0])


def assembly(design: Design) -> tuple[Artefact, ...]:
    """STEP and GLB of the fingers in an open gripper, and an exploded drawing of each."""
    closing = design.closing
    both = [finger_bodies(design, finger) for finger in design.fingers]
    opening = min(OPENING_MM, closing.max_opening_mm)
    places = {
        f.name: finger_to_gripper(f.name, design.mount, closing, opening) for f in design.fingers
    }
    tree = Compound(children=[placed(_coloured(b), places[b.finger.name]) for b in both])
    groups = tuple(Group(b.finger.name, places[b.finger.name], tuple(_meshed(b))) for b in both)
    scene = glb("assembly", groups, {"opening_mm": opening})
    drawings = [
        Artefact(
            f"assembly/{bodies.finger.name}_exploded.svg",
            exploded_view(bodies, design.stack, design.outline).encode(),
            frame="",
        )
        for bodies in both
    ]
    return (
        Artefact("assembly/assembly.step", export.step(tree, "assembly"), frame="gripper"),
        Artefact("assembly/assembly.glb", scene, _M_TO_MM, "gripper"),
        *drawings,
    )


def _coloured(bodies: Bodies) -> Compound:
    """A finger as a tree of named and coloured shapes; parts of a kind are one shape."""
    name = bodies.finger.name
    children = [_layer(f"{name}.{kind}", solid, kind) for kind, solid in layers_of(bodies)]
    for kind in dict.fromkeys(part.kind for part in bodies.finger.parts):
        alike = [
            solid
            for part, solid in zip(bodies.finger.parts, bodies.parts, strict=True)
            if part.kind == kind
        ]
        children.append(_layer(f"{name}.{kind}s", Compound(alike), kind))
    return Compound(label=name, children=children)


def _layer(label: str, shape: Shape, kind: str) -> Shape:
    named = copy(shape)
    named.label, named.color = label, Color(*colour_of(kind))
    return named


def _meshed(bodies: Bodies) -> Iterator[Body]:
    """A finger's bodies for a GLB: parts of one size share a box, centred on its footprint."""
    name = bodies.finger.name
    for kind, solid in layers_of(bodies):
        yield Body(f"{name}.{kind}", export.mesh(solid, CHORD_MM), colour_of(kind))
    boxes: dict[tuple[float, float, float], Mesh] = {}
    for part, solid in zip(bodies.finger.parts, bodies.parts, strict=True):
        size = (part.size_x_mm, part.size_y_mm, part.height_mm)
        if size not in boxes:
            corner = np.array([-size[0] / 2, -size[1] / 2, 0.0])
            boxes[size] = export.mesh(Solid.make_box(*size))
            boxes[size] = Mesh(boxes[size].points_mm + corner, boxes[size].triangles)
        low = float(solid.bounding_box().min.Z)
        yield Body(
            bodies.finger.body_name(part),
            boxes[size],
            colour_of(part.kind),
            (part.x_mm, part.y_mm, low),
        )
