"""Damage the fit test plate's files, and exactly the right checks fail."""

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh
from manifold3d import Manifold

from damages import box, carve, cut_short, failing, flip_a_triangle
from lumitip_fab.checks import fit_plate
from lumitip_fab.checks.run import run_checks
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design, FitPlate, Point
from lumitip_fab.design.encoding import read_design
from lumitip_fab.design.frames import fit_corner_to_sensor, translation

pytestmark = pytest.mark.slow

STL = "fit/fit_plate.stl"
NEXT_MM = 0.05  # from a step to the next


def tube(at: Point, diameter: float, z_min: float, z_max: float) -> Manifold:
    return Manifold.cylinder(z_max - z_min, diameter / 2, -1.0, 128).translate((*at, z_min))


def in_sensor(
    part: Manifold, design: Design, step: int, damage: Callable[[Manifold], Manifold]
) -> Manifold:
    """Change a coupon's corner in the sensor frame of which it is cut."""
    plate = design.fit_plate
    to_sensor = fit_corner_to_sensor(plate.corners[0], design.mount, design.stack)
    to_sensor = to_sensor @ translation(-step * plate.pitch_mm, 0.0, 0.0)
    return damage(part.transform(to_sensor[:3])).transform(np.linalg.inv(to_sensor)[:3])


def wall_of_the_next_step(part: Manifold, design: Design) -> Manifold:
    """The wall at the left of the middle corner where that of the next one would be."""
    board, stack = design.board.box, design.stack
    inner, y = board.x_min_mm - design.fit_plate.steps[2].pocket_gap_mm, board.y_max_mm
    low, high = stack.pocket_z_mm + 0.02, stack.rim_z_mm + 1
    beside = box((inner - NEXT_MM, y - 3.5, low), (inner + 1, y - 0.3, high))
    return in_sensor(part, design, 2, lambda whole: whole - beside)


def roof_of_the_next_step(part: Manifold, design: Design) -> Manifold:
    """The roof of the middle corner where that of the next one would be."""
    board, stack = design.board.box, design.stack
    at, low = board.y_max_mm + design.fit_plate.steps[2].pocket_gap_mm, stack.pocket_z_mm
    above = box(
        (board.x_min_mm + 0.2, at - 0.1, low + 0.01), (0.0, at + 3 * NEXT_MM, low + 2 * NEXT_MM)
    )
    return in_sensor(part, design, 2, lambda whole: whole - above)


def pin_replaced(part: Manifold, design: Design, step: int, diameter: float, by: float) -> Manifold:
    (x, y), stack = design.fit_plate.corners[0].pin, design.stack
    low, high = stack.pocket_z_mm, stack.rim_z_mm
    without = tube((x, y), 3.0, low, high + 0.5)
    pin = tube((x + by, y), diameter, low - 0.3, high)
    return in_sensor(part, design, step, lambda whole: whole - without + pin)


def pin_of_the_next_step(part: Manifold, design: Design) -> Manifold:
    return pin_replaced(part, design, 1, design.fit_plate.steps[2].pin_mm, 0.0)


def pin_shifted(part: Manifold, design: Design) -> Manifold:
    return pin_replaced(part, design, 4, design.fit_plate.steps[4].pin_mm, 0.1)


def floor_raised(part: Manifold, design: Design) -> Manifold:
    y, low = design.fit_plate.corners[0].pin[1], design.stack.pocket_z_mm
    x = design.board.box.x_min_mm
    raised = box((x + 0.05, y - 1.0, low - 0.3), (x + 2.0, y + 1.0, low + 0.1))
    return in_sensor(part, design, 0, lambda whole: whole + raised)


def beam(part: Manifold, design: Design) -> Manifold:
    """A bar behind the plates from the first coupon to the last, over nothing between gussets."""
    plate, y = design.fit_plate, design.fit_plate.corners[0].foot.y_max_mm - 2.5
    return part + box((1.5, y - 0.5, 4.0), (plate.size_mm[0] - 1.5, y + 1.5, 5.0))


def thin_on_the_bed(part: Manifold, design: Design) -> Manifold:
    """Coupons that stand on their edges alone."""
    plate = design.fit_plate
    for step in range(len(plate.steps)):
        x, y = plate.at(step, (0.3, 0.5))
        high = plate.size_mm[1] - 0.3
        part = part - box((x, y, -1.0), (x + plate.width_mm - 0.6, high, 0.05))
    return part


def bolt(plate: FitPlate, step: int) -> Point:
    x, y = plate.at(step, plate.slice_at)
    return x, y - 13.8


def bolt_hole_of_the_next_step(part: Manifold, design: Design) -> Manifold:
    plate = design.fit_plate
    return part - tube(bolt(plate, 3), plate.steps[4].bolt_hole_mm, -1, 5)


def bolt_moved(part: Manifold, design: Design) -> Manifold:
    plate = design.fit_plate
    x, y = bolt(plate, 0)
    hole = plate.steps[0].bolt_hole_mm
    return part + tube((x, y), hole + 0.3, 0.0, 1.0) - tube((x, y + 0.1), hole, -1, 5)


def gripper_pin_hole_of_the_next_step(part: Manifold, design: Design) -> Manifold:
    plate = design.fit_plate
    x, y = bolt(plate, 1)
    return part - tube((x + 4.5, y), plate.steps[2].gripper_pin_mm, -1, 5)


def gripper_pin_moved(part: Manifold, design: Design) -> Manifold:
    plate = design.fit_plate
    x, y = bolt(plate, 2)
    hole = plate.steps[2].gripper_pin_mm
    filled = part + tube((x - 4.5, y), hole + 0.1, 0.0, 1.0)
    return filled - tube((x - 4.6, y), hole, -1, 5)


def nose_of_the_step_before(part: Manifold, design: Design) -> Manifold:
    plate = design.fit_plate
    x, y = plate.at(3, plate.slice_at)
    return part + box((x + 6.0, y - 9.0, 0.0), (x + 7.1, y - 8.0, 1.0))


def value_of_another_step(part: Manifold, design: Design) -> Manifold:
    """The sign of the second step made a plus."""
    plate = design.fit_plate
    label, top = plate.label, plate.thickness_mm
    x = plate.pitch_mm + label.x_min_mm + 0.3 * label.length_mm
    y = label.centre_mm[1]
    return part - box((x - 0.25, y - 0.8, top - 0.4), (x + 0.25, y + 0.8, top + 1))


def steps_swapped(part: Manifold, design: Design) -> Manifold:
    """The plate in a mirror: every step where another should be."""
    plate = design.fit_plate
    middle = plate.size_mm[0] / 2
    return part.translate((-middle, 0, 0)).mirror((1, 0, 0)).translate((middle, 0, 0))


def hollow(part: Manifold, design: Design) -> Manifold:
    """Roofs thin behind."""
    plate, corner = design.fit_plate, design.fit_plate.corners[0]
    y, high = corner.foot.y_min_mm + design.stack.pcb_mm, corner.height_mm
    return part - box((-1.0, y - 0.5, high - 1.6), (plate.size_mm[0] + 1, y + 5.0, high + 1))


def longer(part: Manifold, _: Design) -> Manifold:
    return part.scale((1.002, 1.0, 1.0))


def crumb(part: Manifold, design: Design) -> Manifold:
    plate = design.fit_plate
    x = plate.pitch_mm - 0.4
    return part + box((x - 0.1, 1.0, 0.2), (x + 0.1, 1.2, 0.4))


def joined(part: Manifold, design: Design) -> Manifold:
    """Two coupons that hang together."""
    plate = design.fit_plate
    x = plate.pitch_mm
    return part + box((x - 1.2, 6.5, 0.0), (x + 0.4, 6.7, 0.2))


PLACED = {
    "bolt",
    "bolt_hole",
    "gripper_pins",
    "gripper_pin_hole",
    "nose",
    "pocket_gap",
    "pins",
    "pin",
    "pocket_depth",
    "label",
}
DAMAGES = {
    wall_of_the_next_step: {"pocket_gap"},
    roof_of_the_next_step: {"pocket_gap"},
    pin_of_the_next_step: {"pin"},
    pin_shifted: {"pins"},
    floor_raised: {"pocket_depth"},
    beam: {"bodies", "overhang", "span", "volume"},
    thin_on_the_bed: {"bed_contact", "overhang"},
    bolt_hole_of_the_next_step: {"bolt_hole"},
    bolt_moved: {"bolt"},
    gripper_pin_hole_of_the_next_step: {"gripper_pin_hole"},
    gripper_pin_moved: {"gripper_pins"},
    nose_of_the_step_before: {"nose"},
    value_of_another_step: {"label"},
    steps_swapped: PLACED - {"bolt", "gripper_pins"},
    hollow: {"volume"},
    longer: {"size", "pocket_gap", "pins", "bolt", "gripper_pins", "nose"},
    crumb: {"bodies"},
    joined: {"bodies"},
}


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damaged_plate(damage: Callable[[Manifold, Design], Manifold], damaged: Path) -> None:
    design = read_design(damaged / "design.json")
    carve(damaged / STL, lambda part: damage(part, design))
    assert failing(damaged, "fit_plate") == DAMAGES[damage]


def in_inches(folder: Path) -> None:
    trimesh.load(folder / STL, force="mesh").apply_scale(1 / 25.4).export(folder / STL)


FILES: dict[Callable[[Path], None], set[str]] = {
    lambda folder: flip_a_triangle(folder / STL): {"watertight"},
    lambda folder: cut_short(folder / STL): {"readable"},
    lambda folder: (folder / STL).unlink(): {"readable"},
    in_inches: PLACED | {"size", "volume", "bed_contact"},
}


@pytest.mark.parametrize("damage", FILES, ids=["flipped", "cut", "gone", "inches"])
def test_a_damaged_file(damage: Callable[[Path], None], damaged: Path) -> None:
    damage(damaged)
    assert failing(damaged, "fit_plate") == FILES[damage]


def test_every_check_fails_for_some_damage(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    names = {m.check.removeprefix("fit_plate.") for m in fit_plate.measure(outputs, design)}
    assert names == set().union(*DAMAGES.values(), *FILES.values())


def test_the_plate_is_small(outputs: Path) -> None:
    plate = read_design(outputs / "design.json").fit_plate
    assert plate.volume_ml < 1.5
    assert [fits.fit_mm for fits in plate.steps] == [-0.1, -0.05, 0.0, 0.05, 0.1]


def test_the_steps_do_not_move_with_the_fit_that_was_read(
    outputs: Path, design_dir: Path, tmp_path: Path
) -> None:
    """The plate of a design that already has a fit tells the same values."""
    file = tmp_path / "design/mine.toml"
    shutil.copytree(design_dir, tmp_path / "design")
    file.write_text('extends = "presets/published.toml"\n[printer]\nfit_mm = 0.05\n')
    plate = derive(load(file)).fit_plate
    assert plate == read_design(outputs / "design.json").fit_plate


def test_an_undamaged_plate_passes(outputs: Path) -> None:
    assert run_checks(outputs, ["fit_plate"]).failed == ()
