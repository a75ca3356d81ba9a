"""The coupon: the mask's material without holes, by which the sensor itself tests whether it is
opaque (`lumitip doctor --opacity`). A film that is cut needs no file: its note has the size."""

import trimesh

from lumitip_fab.design import Design
from lumitip_fab.mask.artwork import PAPERS_MM
from lumitip_fab.mask.pdf import coupon_page
from lumitip_fab.parts.export import mesh_stl, surface_facts, three_mf, welded
from lumitip_fab.pipeline.artefact import Artefact


def coupon_files(design: Design) -> tuple[Artefact, ...]:
    """Pages for a printed film; STL and 3MF for a printed sheet."""
    mask = design.mask
    left, low, right, high = mask.coupon.bounds_mm
    corners = [[left, low, 0.0], [right, high, mask.sheet.thickness_mm]]
    block = trimesh.creation.box(bounds=corners)
    surface = welded(block.vertices, block.faces)
    facts = surface_facts(surface)
    words = f"{mask.sheet.layers} layers of {mask.sheet.layer_mm:g} mm, {mask.sheet.filament}"
    return (
        *(
            Artefact(f"mask/coupon_{paper}.pdf", coupon_page(mask, design.title, paper), frame="")
            for paper in PAPERS_MM
        ),
        Artefact("mask/coupon.stl", mesh_stl(surface), frame="", facts=facts),
        Artefact("mask/coupon.3mf", three_mf(surface, "coupon", words), frame=""),
    )
