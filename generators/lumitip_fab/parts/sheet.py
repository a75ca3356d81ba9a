"""The mask as a sheet from a 3D printer: holes, flaps and folds of the film's artwork."""

from dataclasses import replace

import numpy as np
from manifold3d import CrossSection, FillRule

from lumitip_fab.design import Box, Design, Finger, Point, Sheet
from lumitip_fab.design.frames import sheet_bed_to_sensor
from lumitip_fab.mask.artwork import Artwork, Path, artwork_of
from lumitip_fab.parts.export import mesh_stl, surface_facts, three_mf, welded
from lumitip_fab.parts.letters import letter_rings
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.pipeline.artefact import Artefact

Ring = list[Point]
_ARC_STEPS = 12  # of a quarter circle: chords 3 µm off a hole of 2.5 mm


def sheet_files(design: Design, finger: Finger) -> tuple[Artefact, ...]:
    """STL and 3MF of a finger's sheet as it lies on the bed, outer face down."""
    sheet = design.mask.sheet
    drawn = tuple(round(size + sheet.hole_loss_mm, 6) for size in design.mask.holes_mm)
    mask = replace(design.mask, holes_mm=drawn)
    surface = sheet_mesh(artwork_of(design, finger, mask), mask.mark, sheet)
    path, bed = f"mask/{finger.name}_sheet", sheet_bed_to_sensor()
    facts = surface_facts(surface)
    words = (
        f"{sheet.layers} layers of {sheet.layer_mm:g} mm, lines of {sheet.line_mm:g} mm, "
        f"{sheet.filament}, opaque to infrared; outer face on the bed"
    )
    return (
        Artefact(f"{path}.stl", mesh_stl(surface), bed, facts=facts),
        Artefact(f"{path}.3mf", three_mf(surface, f"{finger.name}_sheet", words), bed),
    )


def sheet_mesh(artwork: Artwork, mark: Box, sheet: Sheet) -> Mesh:
    """The sheet on its bed: the film's outline, window and apertures through all layers, and
    grooves above the first layer along the folds and in the shape of the finger's first letter.

    Args:
        artwork: of the finger; its apertures are the holes as drawn.
        mark: box of the letter, in the sensor frame.
        sheet: layers and widths.
    """
    through = [_flattened(p) for p in (artwork.cut, artwork.window, *artwork.apertures)]
    body = CrossSection(through, FillRule.EvenOdd).extrude(sheet.thickness_mm)
    if sheet.layers > 1:
        folds = [_groove(*flap.fold, sheet.fold_mm) for flap in artwork.flaps]
        sunk = CrossSection(folds, FillRule.NonZero)
        if sheet.letter:
            sunk += CrossSection(letter_rings(artwork.name, mark.mirrored()), FillRule.EvenOdd)
        body -= sunk.extrude(sheet.thickness_mm).translate((0.0, 0.0, sheet.layer_mm))
    found = body.to_mesh64()
    return welded(found.vert_properties[:, :3], found.tri_verts)


def _on_bed(point: Point) -> Point:
    return -point[0], point[1]


def _flattened(path: Path) -> Ring:
    """A path on the bed, its curves as chords."""
    ring, at = [path.start], np.array(path.start)
    for segment in path.segments:
        if len(segment) == 1:
            ring.append(segment[0])
        else:
            a, b, c = map(np.array, segment)
            t = np.linspace(0.0, 1.0, _ARC_STEPS + 1)[1:, None]
            curve = (1 - t) ** 3 * at + 3 * t * (1 - t) ** 2 * a + 3 * t * t * (1 - t) * b
            ring += [(float(x), float(y)) for x, y in curve + t**3 * c]
        at = np.array(ring[-1])
    return [_on_bed(point) for point in ring]


def _groove(start: Point, end: Point, width_mm: float) -> Ring:
    """A fold as a strip on the bed, half its width longer at each end: strips of neighbouring
    flaps overlap."""
    a, b = np.array(_on_bed(start)), np.array(_on_bed(end))
    more = (b - a) / np.hypot(*(b - a)) * width_mm / 2
    side = np.array([-more[1], more[0]])
    a, b = a - more, b + more
    return [(float(x), float(y)) for x, y in (a - side, b - side, b + side, a + side)]
