"""Damage the backings' files, and exactly the right checks fail."""

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from manifold3d import Manifold

from backing_damages import EMITTER_STL, FILES, STL
from damages import box, carve, failing
from lumitip_fab.checks import backing
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import read_design
from lumitip_fab.design.frames import mount_to_sensor
from printed_fingers import written

pytestmark = pytest.mark.slow


def tube(x: float, y: float, diameter: float, z_min: float, z_max: float) -> Manifold:
    return Manifold.cylinder(z_max - z_min, diameter / 2, -1.0, 96).translate((x, y, z_min))


# Damages of the mesh in the sensor frame, whose rim plane is at z = -1.6 and back at z = -4.


def pin_shifted(part: Manifold, design: Design) -> Manifold:
    x, y = design.receiver.holes[0]
    without = part - tube(x, y, 2.2, -3.19, -1.0)
    return without + tube(x + 0.2, y, design.board.pin_mm, -3.4, -1.6)


def pin_thinner(part: Manifold, design: Design) -> Manifold:
    x, y = design.receiver.holes[1]
    return part - tube(x, y, 2.2, -3.19, -1.0) + tube(x, y, 1.6, -3.4, -1.6)


def pin_taller(part: Manifold, design: Design) -> Manifold:
    return part + tube(*design.receiver.holes[3], 1.2, -1.8, -1.3)


def pin_missing(part: Manifold, design: Design) -> Manifold:
    return part - tube(*design.receiver.holes[2], 2.2, -3.19, -1.0)


def pocket_enlarged(part: Manifold, design: Design) -> Manifold:
    x = design.board.pocket.x_max_mm
    return part - box((x - 1, -10, -3.2), (x + 0.2, 0, -1.0))


def pocket_shallower(part: Manifold, _: Design) -> Manifold:
    return part + box((-14, -8, -3.4), (14, 8, -3.1))


def floor_thinned(part: Manifold, _: Design) -> Manifold:
    return part - box((10, 0, -4.5), (13, 3, -3.8))


def outline_shaved(part: Manifold, _: Design) -> Manifold:
    return part - box((23.7, -20, -5), (30, -16, 0))


def notch_plugged(part: Manifold, design: Design) -> Manifold:
    x, y = design.receiver.notch.x_max_mm, design.outline.end_y_mm
    return part + box((x - 1.5, y + 1, -4), (x + 1, y + 3, -1.6))


def tip_cut(part: Manifold, design: Design) -> Manifold:
    y = design.outline.tip_y_mm
    return part - box((-20, y - 0.15, -5), (20, y + 1, -1.6 - design.tip.edge_mm + 0.1))


def slant_filled(part: Manifold, design: Design) -> Manifold:
    y = design.tip.slant_start_y_mm
    return part + box((-20, y - 0.5, -4), (20, y + 2, -3.2))


def block_nearer(part: Manifold, _: Design) -> Manifold:
    """Plastic on the block's front, where a wire fits behind the board, but no thread over it."""
    return part + box((-3.0, -31.0, -7.0), (3.0, -26.1, -4.7))


def shelf_added(part: Manifold, _: Design) -> Manifold:
    return part + box((-24, 5, -11), (24, 17, -3.5))


def key_filled(part: Manifold, design: Design) -> Manifold:
    x, y = max(design.keys, key=lambda key: key.sink_mm).at
    return part + box((x - 1, y - 1, -3.9), (x + 1, y + 1, -1.6))


def island_added(part: Manifold, _: Design) -> Manifold:
    return part + box((15, 0, -8), (17, 2, -6))


# Damages of the part in the mount frame: the bolt's axis is at u = 0, w = 13.8.


def bolt_moved(part: Manifold, _: Design) -> Manifold:
    return part + tube(0, 13.8, 5.5, 0, 4.34) - tube(0, 14.0, 5.3, -1, 5)


def bolt_hole_narrow(part: Manifold, _: Design) -> Manifold:
    return part + (tube(0, 13.8, 5.5, 0, 4.34) - tube(0, 13.8, 5.0, -1, 5))


def gripper_pins_apart(part: Manifold, _: Design) -> Manifold:
    for side in (-1, 1):
        part = part + tube(side * 4.5, 13.8, 2.5, 0, 2.84) - tube(side * 4.7, 13.8, 2.4, -1, 2.84)
    return part


def gripper_pin_hole_narrow(part: Manifold, _: Design) -> Manifold:
    return part + (tube(4.5, 13.8, 2.5, 0, 2.84) - tube(4.5, 13.8, 2.1, -1, 2.84))


def gripper_pin_hole_shallow(part: Manifold, _: Design) -> Manifold:
    return part + tube(4.5, 13.8, 2.5, 2.4, 2.84)


def lump_in_counterbore(part: Manifold, _: Design) -> Manifold:
    return part + box((2.0, 13, 7), (5.0, 15, 9))


def nose_widened(part: Manifold, _: Design) -> Manifold:
    return part + box((2.0, 4.0, 0.5), (6.5, 5.5, 2.9))


def foot_hollow(part: Manifold, _: Design) -> Manifold:
    return part - box((-9, 2.8, -1), (9, 20, 0.15))


def letter_filled(part: Manifold, _: Design) -> Manifold:
    return part + box((-3, 18.0, 0.1), (3, 19.1, 4.3))


def letter_shallow(part: Manifold, _: Design) -> Manifold:
    return part + box((-3, 18.0, 0.1), (3, 18.75, 4.3))


SENSOR_FRAME = {
    pin_shifted: {"pins"},
    pin_thinner: {"pin_clearance"},
    pin_taller: {"pin_height"},
    pin_missing: {"pins", "pin_clearance", "pin_height"},
    pocket_enlarged: {"pocket_gap"},
    pocket_shallower: {"pocket_depth"},
    floor_thinned: {"min_wall"},
    outline_shaved: {"outline"},
    notch_plugged: {"notch"},
    tip_cut: {"tip_edge", "min_wall"},
    slant_filled: {"slant"},
    shelf_added: {"overhang", "span", "keys_open", "key_sink"},
    key_filled: {"keys", "key_hole", "keys_open", "key_sink"},
    island_added: {"bodies"},
    block_nearer: {"thread_room"},
}
MOUNT_FRAME = {
    bolt_moved: {"bolt", "bolt_clearance", "screw_seat"},
    bolt_hole_narrow: {"bolt_hole", "bolt_clearance"},
    gripper_pins_apart: {"gripper_pins"},
    gripper_pin_hole_narrow: {"gripper_pin_hole"},
    gripper_pin_hole_shallow: {"gripper_pin_depth"},
    lump_in_counterbore: {"screw_seat"},
    nose_widened: {"nose"},
    foot_hollow: {"bed_contact", "span"},
    letter_filled: {"letter"},
    letter_shallow: {"letter"},
}

Damage = Callable[[Manifold, Design], Manifold]


def damage_solid(folder: Path, damage: Damage, in_sensor_frame: bool) -> None:
    design = read_design(folder / "design.json")
    to_sensor = mount_to_sensor(design.mount, design.stack)
    frame = to_sensor if in_sensor_frame else np.eye(4)
    carve(folder / STL, lambda part: damage(part, design), frame)


@pytest.mark.parametrize("damage", SENSOR_FRAME, ids=lambda d: d.__name__)
def test_a_damage_in_the_sensor_frame(damage: Damage, damaged: Path) -> None:
    damage_solid(damaged, damage, in_sensor_frame=True)
    assert failing(damaged, "backing") == SENSOR_FRAME[damage]


@pytest.mark.parametrize("damage", MOUNT_FRAME, ids=lambda d: d.__name__)
def test_a_damage_in_the_mount_frame(damage: Damage, damaged: Path) -> None:
    damage_solid(damaged, damage, in_sensor_frame=False)
    assert failing(damaged, "backing") == MOUNT_FRAME[damage]


@pytest.mark.parametrize("damage", FILES, ids=lambda d: d.__name__)
def test_a_damaged_file(damage: Callable[[Path], None], damaged: Path) -> None:
    damage(damaged)
    assert failing(damaged, "backing") == FILES[damage]


def test_the_other_finger_s_backing_is_told_apart(
    built: Callable[[str], Path], tmp_path: Path
) -> None:
    """Boards of an uneven grid are each other's mirror image; so are their pins."""
    folder = Path(shutil.copytree(built("asymmetric"), tmp_path / "swapped"))
    shutil.copy(folder / EMITTER_STL, folder / STL)
    assert failing(folder, "backing") == {
        "pins",
        "pin_clearance",
        "pin_height",
        "letter",
    }


def test_every_check_fails_for_some_damage(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    names = {m.check.removeprefix("backing.") for m in backing.measure(outputs, design)}
    assert names == set().union(*SENSOR_FRAME.values(), *MOUNT_FRAME.values(), *FILES.values())


@pytest.mark.parametrize("gap_mm", [0.1, 0.3])
def test_a_pocket_s_gap_may_be_at_either_end_of_its_range(
    gap_mm: float, design_dir: Path, tmp_path: Path
) -> None:
    file = Path(shutil.copytree(design_dir, tmp_path / "design")) / "mine.toml"
    lines = f"[backing]\npocket_clearance_mm = {gap_mm}\n"
    file.write_text(f'extends = "fingertip.toml"\n{lines}', encoding="utf-8")
    design = derive(load(file))
    out = written(design, design, tmp_path / "out")
    assert not [m for m in backing.measure(out, design) if not m.passed]
