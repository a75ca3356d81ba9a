"""Damage the files of a compliant finger, and exactly the right checks fail."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from manifold3d import Manifold

from damages import box, carve, failing, swap
from lumitip_fab.checks import backing
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import read_design
from lumitip_fab.design.frames import backing_bed_to_sensor, mount_to_sensor

pytestmark = pytest.mark.slow
PLATE = "backing/receiver_backing.stl"
EMITTER_PLATE = "backing/emitter_backing.stl"
INTERFACE = "interface/receiver_interface.stl"
EMITTER_INTERFACE = "interface/emitter_interface.stl"
Damage = Callable[[Manifold, Design], Manifold]


@pytest.fixture
def hurt(built: Callable[[str], Path], tmp_path: Path) -> Path:
    """The printed parts of the preset, to damage."""
    folder = tmp_path / "flex"
    folder.mkdir()
    for name in ("backing", "interface", "mould"):
        shutil.copytree(built("flex") / name, folder / name)
    shutil.copy(built("flex") / "design.json", folder)
    return folder


def tube(x: float, y: float, diameter: float) -> Manifold:
    return Manifold.cylinder(8.0, diameter / 2, -1.0, 96).translate((x, y, -6.0))


# Damages in the sensor frame: the plate's front is at z = -1.8, its back at z = -3.8.


def hole_moved(part: Manifold, design: Design) -> Manifold:
    x, y = design.receiver.holes[-1]
    whole = part + (tube(x, y, 2.4) ^ box((x - 2, y - 2, -3.8), (x + 2, y + 2, -1.8)))
    return whole - tube(x + 0.2, y, 2.2)


def holes_narrow(part: Manifold, design: Design) -> Manifold:
    x, y = design.receiver.holes[-1]
    ring = tube(x, y, 2.4) - tube(x, y, 2.0)
    return part + (ring ^ box((x - 2, y - 2, -3.8), (x + 2, y + 2, -1.8)))


def hole_plugged(part: Manifold, design: Design) -> Manifold:
    x, y = design.receiver.holes[-1]
    return part + box((x - 1.2, y - 1.2, -3.8), (x + 1.2, y + 1.2, -1.8))


def face_hollow(part: Manifold, _: Design) -> Manifold:
    return part - box((-6, -6, -2.0), (6, 6, -1.0))


def groove_shallow(part: Manifold, design: Design) -> Manifold:
    y = design.interfaces[0].groove.y_max_mm
    return part + box((-5, y - 1.5, -3.15), (5, y, -2.9))


def groove_wide(part: Manifold, design: Design) -> Manifold:
    x = design.interfaces[0].groove.x_max_mm
    return part - box((x - 0.1, -18, -4.5), (x + 0.3, -14, -3.05))


def notch_narrow(part: Manifold, design: Design) -> Manifold:
    x, y = design.receiver.notch.x_max_mm, design.outline.end_y_mm
    return part + box((x - 1.0, y + 2, -3.8), (x + 0.2, y + 4, -1.8))


def rim_thick(part: Manifold, design: Design) -> Manifold:
    x = design.interfaces[0].box.x_max_mm - design.interfaces[0].rim_mm
    return part + box((x - 0.1, -20, -3.9), (x + 0.2, -18, -3.2))


def rim_too_thick(part: Manifold, design: Design) -> Manifold:
    x = design.interfaces[0].box.x_max_mm - design.interfaces[0].rim_mm
    return part + box((x - 0.4, -20, -3.9), (x + 0.2, -18, -3.2))


def rim_low(part: Manifold, _: Design) -> Manifold:
    return part - box((-20, -40, -3.3), (20, 0, -3.0))


def pad_hollow(part: Manifold, _: Design) -> Manifold:
    return part - box((-4, -22, -3.95), (4, -14, -3.5))


def pad_short(part: Manifold, design: Design) -> Manifold:
    y = design.interfaces[0].groove.y_max_mm
    return part - box((-20, y - 0.35, -10), (20, 0, -3.0))


ON_PLATE: dict[Damage, set[str]] = {
    hole_moved: {"ties"},
    holes_narrow: {"tie_hole"},
    hole_plugged: {"ties", "tie_hole"},
    face_hollow: {"face", "overhang"},
    groove_shallow: {"groove_depth"},
    groove_wide: {"groove"},
    notch_narrow: {"notch"},
}
ON_INTERFACE: dict[Damage, set[str]] = {
    rim_thick: {"glue"},
    rim_too_thick: {"glue", "joint"},
    rim_low: {"rim_height", "size"},
    pad_hollow: {"pad"},
    pad_short: {"size"},
}


def plates_swapped(folder: Path) -> None:
    swap(folder / PLATE, folder / EMITTER_PLATE)


def interfaces_swapped(folder: Path) -> None:
    swap(folder / INTERFACE, folder / EMITTER_INTERFACE)


def interface_gone(folder: Path) -> None:
    (folder / INTERFACE).unlink()


FILES: dict[Callable[[Path], None], set[str]] = {
    plates_swapped: {"letter"},
    interfaces_swapped: {"letter"},
    interface_gone: {"readable"},
}


def carved(folder: Path, part: str, damage: Damage) -> None:
    design = read_design(folder / "design.json")
    frame = backing_bed_to_sensor if part == PLATE else mount_to_sensor
    carve(folder / part, lambda solid: damage(solid, design), frame(design.mount, design.stack))


@pytest.mark.parametrize("damage", ON_PLATE, ids=lambda d: d.__name__)
def test_a_damaged_plate(damage: Damage, hurt: Path) -> None:
    carved(hurt, PLATE, damage)
    assert failing(hurt, "backing") == ON_PLATE[damage]


@pytest.mark.parametrize("damage", ON_INTERFACE, ids=lambda d: d.__name__)
def test_a_damaged_interface(damage: Damage, hurt: Path) -> None:
    carved(hurt, INTERFACE, damage)
    assert failing(hurt, "backing") == ON_INTERFACE[damage]


@pytest.mark.parametrize("damage", FILES, ids=lambda d: d.__name__)
def test_a_damaged_file(damage: Callable[[Path], None], hurt: Path) -> None:
    damage(hurt)
    assert failing(hurt, "backing") == FILES[damage]


def test_a_plate_that_does_not_lie_flat_is_seen_in_the_mould(hurt: Path) -> None:
    def bump(part: Manifold, _: Design) -> Manifold:
        return part + box((-10, 0, -3.0), (10, 5, 0.5))

    carved(hurt, PLATE, bump)
    assert failing(hurt, "mould") == {"seat"}


def test_every_check_of_a_compliant_finger_alone_fails_for_some_damage(
    built: Callable[[str], Path], outputs: Path
) -> None:
    def names(folder: Path) -> set[str]:
        found = backing.measure(folder, read_design(folder / "design.json"))
        return {m.check.removeprefix("backing.") for m in found}

    alone = names(built("flex")) - names(outputs)
    assert alone == {
        "face",
        "ties",
        "tie_hole",
        "groove",
        "groove_depth",
        "glue",
        "rim_height",
        "joint",
        "pad",
    }
    assert alone <= set().union(*ON_PLATE.values(), *ON_INTERFACE.values(), *FILES.values())
