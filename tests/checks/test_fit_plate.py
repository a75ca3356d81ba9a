"""Damage the fit test plate's files, and exactly the right checks fail."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
import trimesh
from manifold3d import Manifold

from damages import box, carve, cut_short, failing, flip_a_triangle, remove_packages
from lumitip_fab.checks import fit_plate
from lumitip_fab.checks.run import run_checks
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import FitPlate, Point
from lumitip_fab.design.encoding import read_design

pytestmark = pytest.mark.slow

STL = "fit/fit_plate.stl"
NEXT_MM = 0.05  # from a step to the next


def tube(at: Point, diameter: float, z_min: float, z_max: float) -> Manifold:
    return Manifold.cylinder(z_max - z_min, diameter / 2, -1.0, 128).translate((*at, z_min))


def wall_of_the_next_step(part: Manifold, plate: FitPlate) -> Manifold:
    """The wall at the left of the middle corner where that of the next one would be."""
    x, y = plate.at(2, plate.corner)
    inner = x - plate.steps[2].pocket_gap_mm
    low = plate.floor_mm + 0.05  # clear of the floor, or slivers of it stay open
    return part - box((inner - NEXT_MM, 0.0, low), (inner + 1, y, 3.0))


def pin_replaced(
    part: Manifold, plate: FitPlate, step: int, diameter: float, by: float
) -> Manifold:
    (x, y), floor = plate.at(step, plate.pin), plate.floor_mm
    without = part - tube((x, y), 3.0, floor, floor + 2)
    return without + tube((x + by, y), diameter, floor - 0.5, floor + plate.pocket_mm)


def pin_of_the_next_step(part: Manifold, plate: FitPlate) -> Manifold:
    return pin_replaced(part, plate, 1, plate.steps[2].pin_mm, 0.0)


def pin_shifted(part: Manifold, plate: FitPlate) -> Manifold:
    return pin_replaced(part, plate, 4, plate.steps[4].pin_mm, 0.1)


def floor_raised(part: Manifold, plate: FitPlate) -> Manifold:
    (x, y), floor = plate.at(0, plate.corner), plate.floor_mm
    return part + box((x, 0.1, floor - 0.5), (x + 4.0, y, floor + 0.1))


def bolt(plate: FitPlate, step: int) -> Point:
    x, y = plate.at(step, plate.slice_at)
    return x, y - 13.8


def bolt_hole_of_the_next_step(part: Manifold, plate: FitPlate) -> Manifold:
    return part - tube(bolt(plate, 3), plate.steps[4].bolt_hole_mm, -1, 5)


def bolt_moved(part: Manifold, plate: FitPlate) -> Manifold:
    x, y = bolt(plate, 0)
    hole = plate.steps[0].bolt_hole_mm
    return part + tube((x, y), hole + 0.3, 0.0, 1.0) - tube((x, y + 0.1), hole, -1, 5)


def gripper_pin_hole_of_the_next_step(part: Manifold, plate: FitPlate) -> Manifold:
    x, y = bolt(plate, 1)
    return part - tube((x + 4.5, y), plate.steps[2].gripper_pin_mm, -1, 5)


def gripper_pin_moved(part: Manifold, plate: FitPlate) -> Manifold:
    x, y = bolt(plate, 2)
    hole = plate.steps[2].gripper_pin_mm
    filled = part + tube((x - 4.5, y), hole + 0.1, 0.0, 1.0)
    return filled - tube((x - 4.6, y), hole, -1, 5)


def nose_of_the_step_before(part: Manifold, plate: FitPlate) -> Manifold:
    x, y = plate.at(3, plate.slice_at)
    return part + box((x + 6.0, y - 9.0, 0.0), (x + 7.1, y - 8.0, 1.0))


def value_of_another_step(part: Manifold, plate: FitPlate) -> Manifold:
    """The sign of the second step made a plus."""
    label, top = plate.label, plate.thickness_mm
    x = plate.pitch_mm + label.x_min_mm + 0.3 * label.length_mm
    y = label.centre_mm[1]
    return part - box((x - 0.25, y - 0.8, top - 0.4), (x + 0.25, y + 0.8, top + 1))


def steps_swapped(part: Manifold, plate: FitPlate) -> Manifold:
    """The plate in a mirror: every step where another should be."""
    middle = plate.size_mm[0] / 2
    return part.translate((-middle, 0, 0)).mirror((1, 0, 0)).translate((middle, 0, 0))


def hollow(part: Manifold, plate: FitPlate) -> Manifold:
    for step in range(len(plate.steps)):
        x, y = plate.at(step, (0.3, 0.3))
        part = part - box((x, -1.0, 0.2), (x + 8.4, y + 3.9, 0.8))
    return part


def longer(part: Manifold, _: FitPlate) -> Manifold:
    return part.scale((1.002, 1.0, 1.0))


def crumb(part: Manifold, plate: FitPlate) -> Manifold:
    x = plate.pitch_mm - 0.4
    return part + box((x - 0.1, 1.0, 0.2), (x + 0.1, 1.2, 0.4))


def joined(part: Manifold, plate: FitPlate) -> Manifold:
    """Two coupons that hang together."""
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
    "floor",
    "label",
}
DAMAGES = {
    wall_of_the_next_step: {"pocket_gap"},
    pin_of_the_next_step: {"pin"},
    pin_shifted: {"pins"},
    floor_raised: {"floor"},
    bolt_hole_of_the_next_step: {"bolt_hole"},
    bolt_moved: {"bolt"},
    gripper_pin_hole_of_the_next_step: {"gripper_pin_hole"},
    gripper_pin_moved: {"gripper_pins"},
    nose_of_the_step_before: {"nose"},
    value_of_another_step: {"label"},
    steps_swapped: PLACED - {"bolt", "gripper_pins"},
    hollow: {"volume"},
    longer: {"size", "three_mf", "step", "pocket_gap", "pins", "bolt", "gripper_pins", "nose"},
    crumb: {"bodies"},
    joined: {"bodies"},
}


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damaged_plate(damage: Callable[[Manifold, FitPlate], Manifold], damaged: Path) -> None:
    plate = read_design(damaged / "design.json").fit_plate
    carve(damaged / STL, lambda part: damage(part, plate))
    assert failing(damaged, "fit_plate") == DAMAGES[damage]


def in_inches(folder: Path) -> None:
    trimesh.load(folder / STL, force="mesh").apply_scale(1 / 25.4).export(folder / STL)


FILES: dict[Callable[[Path], None], set[str]] = {
    lambda folder: flip_a_triangle(folder / STL): {"watertight"},
    lambda folder: cut_short(folder / STL): {"readable"},
    lambda folder: (folder / STL).unlink(): {"readable"},
    lambda folder: remove_packages(folder / STL): {"three_mf", "step"},
    in_inches: PLACED | {"size", "volume", "three_mf", "step"},
}


@pytest.mark.parametrize("damage", FILES, ids=["flipped", "cut", "gone", "no packages", "inches"])
def test_a_damaged_file(damage: Callable[[Path], None], damaged: Path) -> None:
    damage(damaged)
    assert failing(damaged, "fit_plate") == FILES[damage]


def test_every_check_fails_for_some_damage(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    names = {m.check.removeprefix("fit_plate.") for m in fit_plate.measure(outputs, design)}
    assert names == set().union(*DAMAGES.values(), *FILES.values())


def test_the_plate_is_small(outputs: Path) -> None:
    plate = read_design(outputs / "design.json").fit_plate
    assert plate.volume_ml < 1
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
