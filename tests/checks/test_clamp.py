"""Damage the clamp's files, and exactly the right checks fail."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from manifold3d import Manifold

from damages import Body, box, carve, excerpt, failing, flip_a_triangle
from lumitip_fab.design.encoding import read_design
from lumitip_fab.design.frames import clamp_bed_to_sensor, mould_bed_to_sensor

pytestmark = pytest.mark.slow

Damage = Callable[[Body], Body]
CLAMP, MOULD = "mould/clamp.stl", "mould/receiver_mould.stl"
BACKING = "backing/receiver_backing.stl"


@pytest.fixture
def copied(outputs: Path, tmp_path: Path) -> Path:
    """The files that the clamp's checks read, to damage."""
    return excerpt(outputs, tmp_path / "clamped", "mould", "backing")


# On the published mould: plate's back at 6.3, feet to 9.3, flat back at 13.35, rail to 3.9; right
# arm at x = 18.75 to 26.75, legs to x = 39.356 at y = 25.25 to 30.25 and -18.35 to -13.35, their
# marks at 1.95; screws at (±35.206, 5.95).


def foot_shorter(part: Body) -> Body:
    return part - box((20, 22, 6), (24, 27, 6.45))


def foot_longer(part: Body) -> Body:
    return part + box((20.75, 22.75, 6.1), (23.75, 26.75, 6.4))


def foot_beside_the_pad(part: Body) -> Body:
    return part - box((22.6, 22, 6), (24, 27, 9.2))


def foot_at_the_tip_gone(part: Body) -> Body:
    return part - box((0.2, -15, 6), (5, -10, 9.25))


def against_the_block(part: Body) -> Body:
    return part + box((-19, 10, 9.5), (-7.9, 20, 13.35))


def against_the_rail(part: Body) -> Body:
    return part + box((37, -13.5, 1), (38.4, -13, 13.35))


def over_the_wires(part: Body) -> Body:
    return part + box((-19, 29, 9.3), (-10.5, 30.2, 13.35))


def mark_filled(part: Body) -> Body:
    return part + box((37, 25.25, 0.6), (39.356, 30.25, 3))


def mark_higher(part: Body) -> Body:
    """A leg whose mark is 0.2 mm higher."""
    cut = Manifold.batch_hull(
        [box((38.956, 25, 2.149), (39.356, 31, 2.151)), box((39.356, 25, 1.75), (39.4, 31, 2.55))]
    )
    return mark_filled(part) - cut


def leg_out(part: Body) -> Body:
    return part + box((38.9, 25.25, 0.6), (39.6, 30.25, 13.35))


def screw_hole_off(part: Body) -> Body:
    filled = part + box((33, 3, 9.3), (38, 9, 13.35))
    return filled - Manifold.cylinder(5, 1.8, circular_segments=64).translate((35.4, 5.95, 9))


def screw_hole_wide(part: Body) -> Body:
    return part - Manifold.cylinder(5, 2.1, circular_segments=64).translate((35.206, 5.95, 9))


def lug_thicker(part: Body) -> Body:
    return part + box((28, 2, 13), (31, 9, 18))


def arm_thinner(part: Body) -> Body:
    return part - box((18, -8, 9), (27, 20, 10.7))


def leg_slotted(part: Body) -> Body:
    return part - box((37.2, 25, 5), (38.6, 31, 7))


def island_added(part: Body) -> Body:
    return part + box((300, 0, 10), (303, 3, 13.35))


CARVED = {
    foot_shorter: {"seats"},
    foot_longer: {"seats", "clear", "marks"},
    foot_beside_the_pad: {"seats", "over_pads", "marks"},
    foot_at_the_tip_gone: {"seats", "over_tip", "marks"},
    against_the_block: {"clear"},
    against_the_rail: {"off_mould"},
    over_the_wires: {"wires"},
    mark_filled: {"marks"},
    mark_higher: {"marks"},
    leg_out: {"flush", "marks"},
    screw_hole_off: {"screws"},
    screw_hole_wide: {"screw_clearance"},
    lug_thicker: {"screw_length"},
    arm_thinner: {"press"},
    leg_slotted: {"min_wall", "overhang"},
    island_added: {"bodies", "fits_bed"},
}


@pytest.mark.parametrize("damage", CARVED, ids=lambda d: d.__name__)
def test_a_damaged_clamp(damage: Damage, copied: Path) -> None:
    design = read_design(copied / "design.json")
    to_mould = np.linalg.inv(mould_bed_to_sensor(design.stack, design.mould))
    frame = to_mould @ clamp_bed_to_sensor(design.stack, design.clamps[0])
    carve(copied / CLAMP, damage, frame)
    assert failing(copied, "clamp") == CARVED[damage]


def rail_mark_filled(part: Body) -> Body:
    return part + box((38, 20, 0), (39.356, 24.75, 3.5))


def pads_higher(part: Body) -> Body:
    """A crumb of silicone on a pad: the plate, and the clamp on it, stand 0.2 mm higher."""
    return part + box((22.2, 24.2, 3.9), (23.3, 25.3, 4.1))


def head_too_wide(part: Body) -> Body:
    return part - Manifold.cylinder(0.3, 3.6, circular_segments=64).translate((35.206, 5.95, 0))


def nut_against_the_wall(part: Body) -> Body:
    return part + box((32.3, 4, 3.8), (32.9, 8, 7))


def wall_below_the_nuts(part: Body) -> Body:
    """As round a thin plate: walls end beside the nuts, not above them."""
    return part - box((-60, -60, 4.2), (60, 60, 12))


MOULDS = {
    wall_below_the_nuts: set(),
    rail_mark_filled: {"marks"},
    pads_higher: {"marks"},
    head_too_wide: {"head_clearance"},
    nut_against_the_wall: {"nut_room"},
}


@pytest.mark.parametrize("damage", MOULDS, ids=lambda d: d.__name__)
def test_a_damaged_mould_under_the_clamp(damage: Damage, copied: Path) -> None:
    carve(copied / MOULD, damage)
    assert failing(copied, "clamp") == MOULDS[damage]


def triangle_flipped(folder: Path) -> None:
    flip_a_triangle(folder / CLAMP)


def clamp_missing(folder: Path) -> None:
    (folder / CLAMP).unlink()


def mould_missing(folder: Path) -> None:
    (folder / MOULD).unlink()


def window_under_a_foot(folder: Path) -> None:
    """A hole through the receiver's plate, in the frame in which it is printed."""
    carve(folder / BACKING, lambda part: part - box((21.5, -5, 7.5), (22.5, 6, 9)))


FILES = {
    triangle_flipped: {"watertight", "clear"},
    clamp_missing: {"readable"},
    mould_missing: {"readable"},
    window_under_a_foot: {"seats"},
}


@pytest.mark.parametrize("damage", FILES, ids=lambda d: d.__name__)
def test_a_damaged_file(damage: Callable[[Path], None], copied: Path) -> None:
    damage(copied)
    assert failing(copied, "clamp") == FILES[damage]


def test_an_undamaged_clamp_passes(outputs: Path) -> None:
    assert failing(outputs, "clamp") == set()
