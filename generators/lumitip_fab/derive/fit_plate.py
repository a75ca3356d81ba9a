"""Where everything is on the fit test plate."""

import math
from dataclasses import replace

import numpy as np

from lumitip_fab.derive.boards import Plan
from lumitip_fab.derive.faults import Faults
from lumitip_fab.derive.fits import derive_fits
from lumitip_fab.derive.flex import stiff_mm
from lumitip_fab.design import Box, FitPlate, Fits, Mount, Point
from lumitip_fab.load import Input

STEPS_MM = (-0.1, -0.05, 0.0, 0.05, 0.1)
WALL = 1.5  # of the thinnest wall
SEAT_MM = 1.0  # of a tower's floor round its pin
OVER_MM = 0.2  # a board over the next lower tower
CHARACTERS = 3  # of a value
LABEL_MM = 3.0  # its height
LABEL_DEPTH_MM = 0.4
DIGIT_WIDTH = 0.6  # of the height
DIGIT_PITCH = 0.85
MARGIN_MM = 0.6
APART_MM = 0.8  # between slices


def derive_fit_plate(given: Input, plan: Plan, mount: Mount, faults: Faults) -> FitPlate:
    """The plate, refused where it does not fit the bed."""
    p = given.parameters
    printer = given.catalogue.printers[p.printer.profile]
    wall, thickness = WALL * p.printer.min_wall_mm, 3 * p.printer.min_wall_mm
    steps = tuple(derive_fits(given, step) for step in STEPS_MM)
    to_edges = _hole_to_edges(plan)
    gap, reach = steps[-1].pocket_gap_mm, steps[0].pin_mm / 2 + SEAT_MM
    corner = (wall + gap, reach + to_edges[1])
    pin = (corner[0] + to_edges[0], reach)
    tower = Box(0.0, pin[0] + reach, 0.0, corner[1] + gap + wall)
    high = min(LABEL_MM, tower.length_mm - 2 * MARGIN_MM)
    wide = (CHARACTERS - 1) * DIGIT_PITCH * high + DIGIT_WIDTH * high
    left, middle = tower.x_max_mm + MARGIN_MM, tower.length_mm / 2
    label = Box(left, left + wide, middle - high / 2, middle + high / 2)
    part = _slice(mount, wall)
    pitch = max(label.x_max_mm + MARGIN_MM, part.width_mm + APART_MM)
    rise = stiff_mm(p) + OVER_MM
    plate = FitPlate(
        steps=steps,
        pitch_mm=pitch,
        tower=tower,
        pin=pin,
        corner=corner,
        floors_mm=tuple(thickness + rise * below for below in reversed(range(len(steps)))),
        pocket_mm=stiff_mm(p),
        label=label,
        label_mm=LABEL_DEPTH_MM,
        slice=part,
        slice_at=(pitch / 2 + part.centre_mm[0], tower.y_max_mm + part.y_max_mm),
        thickness_mm=thickness,
        land_mm=thickness - p.printer.min_wall_mm,
        pin_depth_mm=p.printer.min_wall_mm if mount.sleeved else thickness,
        volume_ml=0.0,
    )
    width, depth, _ = plate.size_mm
    bed = printer.bed_mm
    faults.refuse_unless(
        width <= bed[0] and depth <= bed[1],
        "printer.profile",
        f"{p.printer.profile!r} given, its bed of {bed[0]:g} x {bed[1]:g} mm cannot take a fit "
        f"test plate of {width:.0f} x {depth:.0f} mm",
    )
    return replace(plate, volume_ml=_volume_mm3(plate, mount) / 1000)


def _hole_to_edges(plan: Plan) -> Point:
    """From the hole nearest to the gripper end and farthest right to the board's edges there."""
    box = plan.board.box
    x, y = min(plan.receiver.holes, key=lambda hole: (hole[1], -hole[0]))
    return box.x_max_mm - x, y - box.y_min_mm


def _slice(mount: Mount, wall_mm: float) -> Box:
    """The part of the coupling that each step shows: all of it where there is a seat or pins
    beside the bolt, else what is round one bolt."""
    if mount.nose or (mount.pin_u_mm and not mount.sleeved):
        half = mount.block_width_mm / 2
        return Box(-half, half, mount.block_front_w_mm, mount.block_back_w_mm)
    reach = max(mount.counterbore_mm, mount.pin_mm) / 2 + wall_mm
    u, w = mount.bolt_u_mm[-1], mount.bolt_w_mm
    return Box(u - reach, u + reach, w - reach, w + reach)


def _volume_mm3(plate: FitPlate, mount: Mount) -> float:
    """Strip, towers on it and slices, without engraving and chamfers."""
    strip = plate.size_mm[0] * plate.tower.length_mm * plate.thickness_mm
    towers = sum(
        _tower_mm3(plate, fits, floor)
        for fits, floor in zip(plate.steps, plate.floors_mm, strict=True)
    )
    return strip + towers + sum(_slice_mm3(plate, fits.of(mount)) for fits in plate.steps)


def _tower_mm3(plate: FitPlate, fits: Fits, floor_mm: float) -> float:
    """A tower over the strip."""
    tower, (x, y), gap = plate.tower, plate.corner, fits.pocket_gap_mm
    foot = tower.width_mm * tower.length_mm
    walls = foot - (tower.x_max_mm - x + gap) * (y + gap - tower.y_min_mm)
    pin = math.pi / 4 * fits.pin_mm**2
    return foot * (floor_mm - plate.thickness_mm) + (walls + pin) * plate.pocket_mm


def _slice_mm3(plate: FitPlate, drawn: Mount) -> float:
    """A slice of the coupling less its holes."""
    box, quarter = plate.slice, math.pi / 4
    wide = np.full(200, box.width_mm)
    if drawn.nose:
        w = np.linspace(box.y_min_mm, box.y_max_mm, len(wide)) - drawn.nose.front_w_mm
        spread = 2 * w * math.tan(math.radians(drawn.nose.half_angle_deg))
        wide = np.minimum(wide, drawn.nose.front_width_mm + spread)
    body = float(wide.mean()) * box.length_mm * plate.thickness_mm
    bolts = sum(box.x_min_mm < u < box.x_max_mm for u in drawn.bolt_u_mm)
    head_mm = plate.thickness_mm - plate.land_mm
    hole = quarter * (drawn.bolt_hole_mm**2 * plate.land_mm + drawn.counterbore_mm**2 * head_mm)
    pins = 0 if drawn.sleeved else len(drawn.pin_u_mm)
    return body - bolts * hole - pins * quarter * drawn.pin_mm**2 * plate.thickness_mm
