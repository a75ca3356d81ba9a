"""The fit test plate: pocket corners, pins, bolt holes and seats, each a little looser."""

import numpy as np
from build123d import Solid

from lumitip_fab.artefact import Artefact
from lumitip_fab.design import Box, FitPlate, Fits, Mount
from lumitip_fab.errors import BuildError
from lumitip_fab.frames import translation
from lumitip_fab.mechanical import export
from lumitip_fab.mechanical.backing import BEYOND_MM, pin_solid
from lumitip_fab.mechanical.coupling import beside_nose
from lumitip_fab.mechanical.digits import value_cutters
from lumitip_fab.mechanical.shapes import box_solid, cylinder, placed

NAME = "fit_plate"


def fit_plate_files(fit_plate: FitPlate, mount: Mount) -> tuple[Artefact, ...]:
    """STEP, STL and 3MF of the plate, all as it lies on the bed."""
    solid = fit_plate_solid(fit_plate, mount)
    return (
        Artefact(f"fit/{NAME}.step", export.step(solid, NAME), frame=""),
        Artefact(f"fit/{NAME}.stl", export.stl(solid), frame=""),
        Artefact(f"fit/{NAME}.3mf", export.three_mf(solid, NAME), frame=""),
    )


def fit_plate_solid(plate: FitPlate, mount: Mount) -> Solid:
    """The plate on the bed.

    Args:
        plate: the steps and where they are.
        mount: the coupling of which each step shows a slice.

    Raises:
        BuildError: if the kernel does not make one valid solid of it.
    """
    strip = Box(0.0, plate.size_mm[0], 0.0, plate.tower.length_mm)
    whole = box_solid(strip, 0.0, plate.thickness_mm)
    taken = []
    for step, fits in enumerate(plate.steps):
        whole = whole + _tower(plate, step, fits) + _slice(plate, step, fits.of(mount))
        left = step * plate.pitch_mm
        label = _shifted(plate.label, left)
        taken += value_cutters(plate.label_of(step), label, plate.thickness_mm, plate.label_mm)
    solids = (whole - taken).clean().solids()
    if len(solids) != 1 or not solids[0].is_valid:
        raise BuildError(
            f"fit test plate: the CAD kernel made {len(solids)} solids of it, one valid solid is "
            "needed; change printer.min_wall_mm or the coupling a little"
        )
    return solids[0]


def _tower(plate: FitPlate, step: int, fits: Fits) -> Solid:
    """A corner of the pocket on its floor, open to the right and to the reader, with a pin."""
    floor, top = plate.floors_mm[step], plate.floors_mm[step] + plate.pocket_mm
    tower = _shifted(plate.tower, step * plate.pitch_mm)
    x, y = plate.at(step, plate.corner)
    gap = fits.pocket_gap_mm
    pocket = Box(x - gap, tower.x_max_mm + BEYOND_MM, tower.y_min_mm - BEYOND_MM, y + gap)
    corner = box_solid(tower, 0.0, top) - box_solid(pocket, floor, top + BEYOND_MM)
    foot = floor - plate.thickness_mm / 2
    return corner + pin_solid(plate.at(step, plate.pin), fits.pin_mm, foot, top, plate.pocket_mm)


def _slice(plate: FitPlate, step: int, drawn: Mount) -> Solid:
    """The foot of the coupling as it stands on the gripper, with shallow counterbores."""
    thick = plate.thickness_mm
    body = box_solid(plate.slice, 0.0, thick)
    for side in beside_nose(drawn):
        body = body - side
    low, high = -BEYOND_MM, thick + BEYOND_MM
    holes = []
    for u in drawn.bolt_u_mm:
        axis = (u, drawn.bolt_w_mm)
        holes += [
            cylinder(axis, drawn.bolt_hole_mm, low, high),
            cylinder(axis, drawn.counterbore_mm, plate.land_mm, high),
        ]
    depth = plate.pin_depth_mm if plate.pin_depth_mm < thick else high
    holes += [cylinder((u, drawn.bolt_w_mm), drawn.pin_mm, low, depth) for u in drawn.pin_u_mm]
    x, y = plate.at(step, plate.slice_at)
    turned = translation(x, y, 0.0) @ np.diag([-1.0, -1.0, 1.0, 1.0])
    return placed(body - holes, turned)


def _shifted(box: Box, by_mm: float) -> Box:
    return Box(box.x_min_mm + by_mm, box.x_max_mm + by_mm, box.y_min_mm, box.y_max_mm)
