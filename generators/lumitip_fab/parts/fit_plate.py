"""The fit test plate: pocket corners, pins, bolt holes and seats, each a little looser."""

from dataclasses import replace

import numpy as np
from build123d import Compound, Solid

from lumitip_fab.design import Box, Design, FitPlate, Mount
from lumitip_fab.design.frames import fit_corner_to_sensor, translation
from lumitip_fab.errors import BuildError
from lumitip_fab.parts import export
from lumitip_fab.parts.coupling import beside_nose
from lumitip_fab.parts.fit_corner import corner_solid
from lumitip_fab.parts.letters import value_cutters
from lumitip_fab.parts.plate import BEYOND_MM
from lumitip_fab.parts.shapes import box_solid, cylinder, placed
from lumitip_fab.pipeline.artefact import Artefact

NAME = "fit_plate"


def fit_plate_files(design: Design) -> tuple[Artefact, ...]:
    """The coupons as they lie on the bed; the matrix of what is printed leads to the sensor frame
    of which the first corner is cut."""
    files = export.part_files(f"fit/{NAME}", fit_plate_solids(design), np.eye(4), frame="")
    for corner in design.fit_plate.corners:
        to_sensor = fit_corner_to_sensor(corner, design.mount, design.stack)
        whole, *printed = files
        files = (whole, *(replace(f, to_sensor=to_sensor, frame="sensor") for f in printed))
    return files


def fit_plate_solids(design: Design) -> Compound:
    """The coupons on the bed.

    Raises:
        BuildError: if the kernel does not make one valid solid of each.
    """
    plate = design.fit_plate
    coupons = []
    for step, fits in enumerate(plate.steps):
        label = _shifted(plate.label, step * plate.pitch_mm)
        taken = value_cutters(plate.label_of(step), label, plate.thickness_mm, plate.label_mm)
        whole = _slice(plate, step, fits.of(design.mount))
        for corner in plate.corners:
            shown = corner_solid(corner, fits, design, plate.thickness_mm)
            whole = whole + placed(shown, translation(step * plate.pitch_mm, 0.0, 0.0))
        solids = (whole - taken).clean().solids()
        if len(solids) != 1 or not solids[0].is_valid:
            raise BuildError(
                f"fit test plate: the CAD kernel made {len(solids)} solids of a coupon, one valid "
                "solid is needed; change the coupling a little"
            )
        coupons += solids
    return Compound(coupons)


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
