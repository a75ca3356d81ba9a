"""The fit test plate: pocket corners, pins, bolt holes and seats, each a little looser."""

import numpy as np
from build123d import Compound, Solid

from lumitip_fab.design import Box, Design, FitPlate, Fits, Mount
from lumitip_fab.design.frames import translation
from lumitip_fab.errors import BuildError
from lumitip_fab.parts import export
from lumitip_fab.parts.backing import BEYOND_MM, pin_solid
from lumitip_fab.parts.coupling import beside_nose
from lumitip_fab.parts.letters import value_cutters
from lumitip_fab.parts.shapes import box_solid, cylinder, placed
from lumitip_fab.pipeline.artefact import Artefact

NAME = "fit_plate"


def fit_plate_files(design: Design) -> tuple[Artefact, ...]:
    """The coupons as they lie on the bed."""
    coupons = fit_plate_solids(design.fit_plate, design.mount)
    return export.part_files(f"fit/{NAME}", coupons, np.eye(4), frame="")


def fit_plate_solids(plate: FitPlate, mount: Mount) -> Compound:
    """The coupons on the bed.

    Args:
        plate: the steps and where they are.
        mount: the coupling of which each step shows a slice.

    Raises:
        BuildError: if the kernel does not make one valid solid of each.
    """
    coupons = []
    for step, fits in enumerate(plate.steps):
        label = _shifted(plate.label, step * plate.pitch_mm)
        taken = value_cutters(plate.label_of(step), label, plate.thickness_mm, plate.label_mm)
        whole = _corner(plate, step, fits) + _slice(plate, step, fits.of(mount))
        solids = (whole - taken).clean().solids()
        if len(solids) != 1 or not solids[0].is_valid:
            raise BuildError(
                f"fit test plate: the CAD kernel made {len(solids)} solids of a coupon, one valid "
                "solid is needed; change the coupling a little"
            )
        coupons += solids
    return Compound(coupons)


def _corner(plate: FitPlate, step: int, fits: Fits) -> Solid:
    """A corner of the pocket on its foot, open to the right and to the reader, with a pin."""
    floor, top = plate.floor_mm, plate.floor_mm + plate.pocket_mm
    foot = _shifted(plate.foot, step * plate.pitch_mm)
    x, y = plate.at(step, plate.corner)
    gap = fits.pocket_gap_mm
    pocket = Box(x - gap, foot.x_max_mm + BEYOND_MM, foot.y_min_mm - BEYOND_MM, y + gap)
    corner = box_solid(foot, 0.0, top) - box_solid(pocket, floor, top + BEYOND_MM)
    return corner + pin_solid(
        plate.at(step, plate.pin), fits.pin_mm, floor / 2, top, plate.pocket_mm
    )


def _slice(plate: FitPlate, step: int, drawn: Mount) -> Solid:
    """A slice of the coupling's foot, as it stands on the gripper."""
    thick = plate.thickness_mm
    body = box_solid(plate.slice, 0.0, thick)
    for side in beside_nose(drawn):
        body = body - side
    low, high = -BEYOND_MM, thick + BEYOND_MM
    axes = [(u, drawn.bolt_w_mm) for u in drawn.bolt_u_mm]
    holes = [cylinder(axis, drawn.bolt_hole_mm, low, high) for axis in axes]
    depth = plate.pin_depth_mm if drawn.sleeved else high
    holes += [cylinder((u, drawn.bolt_w_mm), drawn.pin_mm, low, depth) for u in drawn.pin_u_mm]
    x, y = plate.at(step, plate.slice_at)
    turned = translation(x, y, 0.0) @ np.diag([-1.0, -1.0, 1.0, 1.0])
    return placed(body - holes, turned)


def _shifted(box: Box, by_mm: float) -> Box:
    return Box(box.x_min_mm + by_mm, box.x_max_mm + by_mm, box.y_min_mm, box.y_max_mm)
