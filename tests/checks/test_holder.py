"""Damage the holder's files, and exactly the right checks fail."""

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from manifold3d import Manifold

from board_damages import moved_part
from damages import Body, box, carve, failing, flip_a_triangle
from lumitip_fab.checks import holder as checks
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design.encoding import design_text, read_design
from lumitip_fab.design.frames import holder_bed_to_auxiliary
from lumitip_fab.docs.spec import outside
from lumitip_fab.parts.holder import holder_files

pytestmark = pytest.mark.slow

Damage = Callable[[Body], Body]
HOLDER = "holder/holder.stl"
ON_A_COUPLING = ("robotiq_2f85", "robotiq_2f140")
AXIS_Z, RADIUS = -43.8, 37.8


def screws_farther_apart(body: Body) -> Body:
    """The fault of the published holder: its holes are 0.44 mm farther apart than the board's."""
    for side in (-1, 1):
        at = (side * 17.78, 0.0, -5.9)
        body = body + Manifold.cylinder(5.87, 1.3, circular_segments=64).translate(at)
        hole = Manifold.cylinder(12.0, 1.1, circular_segments=64)
        body = body - hole.translate((side * 18.0, 0.0, -11.0))
    return body


def nut_pocket_round(body: Body) -> Body:
    cutter = Manifold.cylinder(7.9, 2.45, circular_segments=61)
    return body - cutter.translate((17.78, 0.0, -13.87))


def nut_pocket_askew(body: Body) -> Body:
    return body - box((17.78, -0.8, -13.0), (20.6, 0.8, -6.2))


def screw_hole_wide(body: Body) -> Body:
    return body - Manifold.cylinder(9.0, 1.2, circular_segments=61).translate((17.78, 0.0, -8.5))


def nuts_too_deep(body: Body) -> Body:
    return body - Manifold.cylinder(4.0, 2.0, circular_segments=64).translate((17.78, 0.0, -9.0))


def nut_sits_lower(body: Body) -> Body:
    """A floor in the pocket, 2.5 mm under the nut's seat."""
    floor = Manifold.cylinder(2.5, 2.5) - Manifold.cylinder(2.5, 1.15, circular_segments=64)
    return body + floor.translate((17.78, 0.0, -8.5))


def tray_narrower(body: Body) -> Body:
    return body + box((22.95, -16.4, -2.9), (23.5, 16.4, 1.6))


def rim_higher(body: Body) -> Body:
    return body + box((-26.0, -16.4, 1.0), (-24.0, 16.4, 1.8))


def tails_touch(body: Body) -> Body:
    return body + box((-10.0, -16.4, -3.5), (10.0, 16.4, -2.0))


def boss_low(body: Body) -> Body:
    return body - box((14.0, -3.0, -0.2), (22.0, 3.0, 0.5))


def cradle_wide(body: Body) -> Body:
    bore = Manifold.cylinder(60.0, RADIUS + 0.2, circular_segments=256).rotate((90.0, 0.0, 0.0))
    return body - bore.translate((0.0, 30.0, AXIS_Z))


def arms_short(body: Body) -> Body:
    return body - box((-60.0, -60.0, -90.0), (60.0, 60.0, AXIS_Z - 2.0))


def ribs_worn(body: Body) -> Body:
    """The ribs of both arms down to the cradle's radius."""
    bore = Manifold.cylinder(60.0, RADIUS, circular_segments=512).rotate((90.0, 0.0, 0.0))
    arms = box((-60.0, -60.0, AXIS_Z - 30.0), (60.0, 60.0, AXIS_Z))
    return body - (bore.translate((0.0, 30.0, AXIS_Z)) ^ arms)


def strap_hole_wide(body: Body) -> Body:
    hole = Manifold.cylinder(60.0, 2.2, circular_segments=64).rotate((0.0, 72.4398, 0.0))
    return body - hole.translate((0.0, 6.0, AXIS_Z))


def strap_hole_filled(body: Body) -> Body:
    plug = Manifold.cylinder(RADIUS + 2.9, 3.0, circular_segments=64)
    plug = plug - Manifold.cylinder(RADIUS + 0.05, 4.0, circular_segments=64)
    return body + plug.rotate((0.0, 72.4398, 0.0)).translate((0.0, 6.0, AXIS_Z))


def arm_hollow(body: Body) -> Body:
    """A slot that leaves 0.6 mm of an arm, seen from outside."""
    return body - box((RADIUS + 0.6, -14.0, AXIS_Z - 1.5), (60.0, -11.0, AXIS_Z + 1.5))


def arm_barred(body: Body) -> Body:
    """A block outside an arm, where a tie leaves its lug."""
    return body + box((RADIUS + 2.0, -14.5, AXIS_Z - 6.0), (RADIUS + 4.5, -12.5, AXIS_Z - 4.0))


def foot_missing(body: Body) -> Body:
    """The end that it stands on cut away but for a rib."""
    return body - box((-60.0, -20.0, -90.0), (20.0, -16.0, 10.0))


def loose_piece(body: Body) -> Body:
    return body + box((13.0, -16.51, 20.0), (17.0, -10.0, 24.0))


DAMAGES: dict[Damage, set[str]] = {
    screws_farther_apart: {"screws", "spacing", "screw_clearance"},
    nut_pocket_round: {"nut_width", "nut_clearance"},
    nuts_too_deep: {"nut_seat"},
    nut_sits_lower: {"nut_seat", "nut_room", "nut_width", "nut_clearance"},
    nut_pocket_askew: {"nuts", "nut_width"},
    screw_hole_wide: {"screw_width"},
    tray_narrower: {"tray_gap"},
    rim_higher: {"rim"},
    tails_touch: {"tail_room", "overhang", "span"},
    boss_low: {"bosses"},
    cradle_wide: {"cradle", "preload"},
    ribs_worn: {"preload"},
    arms_short: {"cradle", "grip", "preload"},
    strap_hole_wide: {"strap_width"},
    strap_hole_filled: {"straps", "strap_width"},
    arm_hollow: {"min_wall"},
    arm_barred: {"tie_way"},
    foot_missing: {"bed_contact", "overhang", "span"},
    loose_piece: {"bodies", "rim"},
}


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_the_holder(damage: Damage, damaged: Path) -> None:
    (holder,) = read_design(damaged / "design.json").holders
    carve(damaged / HOLDER, damage, np.asarray(holder_bed_to_auxiliary(holder)))
    assert failing(damaged, "holder") == DAMAGES[damage]


def test_an_open_surface_is_told(damaged: Path) -> None:
    flip_a_triangle(damaged / HOLDER)
    assert "watertight" in failing(damaged, "holder")


def test_the_boards_holes_are_what_counts(damaged: Path) -> None:
    """The board's file is read too: one of its holes elsewhere does not meet the holder's."""
    path = damaged / "boards/breakout/breakout.kicad_pcb"
    path.write_text(moved_part(path.read_text(), "H2", 0.44, 0.0))
    assert failing(damaged, "holder") == {"screws", "spacing", "screw_clearance"}


def test_a_missing_file_is_seen(damaged: Path) -> None:
    (damaged / HOLDER).unlink()
    assert failing(damaged, "holder") == {"readable"}


def test_every_check_fails_for_some_damage(outputs: Path) -> None:
    found = list(checks.measure(outputs, read_design(outputs / "design.json")))
    assert [m for m in found if not m.passed] == []
    names = {m.check.removeprefix("holder.") for m in found}
    assert names == set().union(*DAMAGES.values(), {"readable", "watertight"})


def test_a_holder_goes_round_a_round_body_alone(design_dir: Path, tmp_path: Path) -> None:
    """By the gripper's entry, or by the figure that a user gives.

    The breakout comes without one; the flange follows the arm side of the 2F grippers alone.
    """
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    file, made = folder / "presets/mine.toml", {}
    for gripper in load(folder / "presets/published.toml").catalogue.grippers:
        file.write_text(f'extends = "published.toml"\n[coupling]\ngripper = "{gripper}"\n')
        design = derive(load(file))
        boards = [auxiliary.name for auxiliary in design.auxiliary_boards]
        assert boards == ["breakout"] + ["flange"] * (gripper in ON_A_COUPLING)
        made[gripper] = [(holder.body_mm, holder.body_from) for holder in design.holders]
        told = " ".join(f"{row.quantity} {row.reason}" for row in outside(design))
        assert ("fix the board beside it" in told) == (not design.holders)
    assert made == {
        "robotiq_2f85": [(75.0, "Robotiq 2F-85, inferred")],
        "robotiq_2f140": [(75.0, "Robotiq 2F-140, assumed")],
        "wsg50": [],
        "onrobot_rg2": [],
        "franka_hand": [],
        "two_hole_jaw": [],
    }
    file.write_text(f"{file.read_text()}[holder]\nbody_mm = 80\n")
    design = derive(load(file))
    assert [holder.body_from for holder in design.holders] == ["holder.body_mm"]
    assert design.system.holders == ()  # the body that is drawn is another


def test_screws_of_a_board_without_a_holder_are_the_makers_own(
    design_dir: Path, tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    file = folder / "presets/mine.toml"
    file.write_text(
        'extends = "published.toml"\n[coupling]\ngripper = "wsg50"\n[breakout]\nhole_mm = 3.2\n'
    )
    assert derive(load(file)).holders == ()


@pytest.mark.parametrize(
    "straps",
    ["strap_hole_mm = 10.0\nstrap_spacing_mm = 18.0", "strap_spacing_mm = 27.0\nwall_mm = 2.0"],
)
def test_arms_with_other_holes_pass_every_check(
    straps: str, design_dir: Path, damaged: Path, tmp_path: Path
) -> None:
    """Rays and limits keep clear of the holes wherever they are."""
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    file = folder / "presets/mine.toml"
    file.write_text(f'extends = "published.toml"\n[holder]\n{straps}\n')
    design = derive(load(file))
    (damaged / "design.json").write_text(design_text(design), encoding="utf-8")
    for made in holder_files(design, design.holders[0]):
        (damaged / made.path).write_bytes(made.data)
    assert failing(damaged, "holder") == set()
