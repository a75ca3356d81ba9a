"""Damage what wraps the skin round the tip, and exactly the right checks fail."""

import math
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from damages import Body, box, carve, excerpt, failing, flip_a_triangle
from lumitip_fab.checks import wrap
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import design_text, read_design
from lumitip_fab.design.frames import (
    backing_bed_to_sensor,
    mould_bed_to_sensor,
    prop_bed_to_sensor,
)
from lumitip_fab.parts.mould import mould_files
from lumitip_fab.parts.prop import prop_files
from printed_fingers import written

pytestmark = pytest.mark.slow
Damage = Callable[[Body], Body]
PROP, MOULD = "mould/prop.stl", "mould/receiver_mould.stl"
BACKING = "backing/receiver_backing.stl"
EVERY = {"prop", "span", "slots", "level", "lip", "held"}


@pytest.fixture
def copied(outputs: Path, tmp_path: Path) -> Path:
    """The files that these checks read, to damage."""
    return excerpt(outputs, tmp_path / "wrapped", "mould", "backing")


def carved(copied: Path, file: str, damage: Damage) -> set[str]:
    """What fails once a part is damaged in the sensor frame."""
    design = read_design(copied / "design.json")
    (prop,), stack = design.props, design.stack
    frame = {
        PROP: prop_bed_to_sensor(stack, design.mould, prop),
        MOULD: mould_bed_to_sensor(stack, design.mould),
        BACKING: backing_bed_to_sensor(design.mount, stack),
    }[file]
    carve(copied / file, damage, frame)
    return failing(copied, "wrap")


# In the sensor frame: the published tip edge is at y = 21.85, with slots of 0.6 mm from x = 2.84 to
# 13.25; rim plane at z = -1.6, bed of the mould at 2.3, weir from y = -36 to -32.6 at the gripper
# end, prop from y = -44.6 to -37.4.


def prop_low(part: Body) -> Body:
    return part - box((-20, -42.5, 2), (20, -30, 2.6))


def prop_high(part: Body) -> Body:
    return part + box((-10, -42, 2), (10, -37.3, 2.4))


def prop_without_a_stop(part: Body) -> Body:
    return part - box((-20, -50, -5), (20, -42.4, 2.25))


def prop_wider(part: Body) -> Body:
    return part + box((-20, -44.6, 2.3), (20, -37.4, 3.5))


@pytest.mark.parametrize(
    ("damage", "fails"),
    [
        (prop_low, {"prop", "level", "lip"}),
        (prop_high, {"prop", "level", "held"}),
        (prop_without_a_stop, {"prop"}),
        (prop_wider, {"prop"}),
    ],
)
def test_a_damaged_prop(damage: Damage, fails: set[str], copied: Path) -> None:
    assert carved(copied, PROP, damage) == fails


def prop_of(design_dir: Path, folder: Path, lines: str, to: Path) -> Design:
    """The prop of another design, in the place of what is there."""
    other = of_lines(design_dir, folder, lines)
    for artefact in prop_files(other, other.props[0]):
        (to / artefact.path).write_bytes(artefact.data)
    return other


@pytest.mark.parametrize(
    ("lines", "fails"),
    [
        ("[mould]\ntip_lip_mm = 0.1\n", {"prop", "level", "lip"}),
        ("[mould]\nwall_mm = 3.2\n", {"prop"}),
        ("[breakout]\nboard_mm = [45.72, 38.1]\n", set()),
    ],
)
def test_a_prop_of_another_design_is_seen(
    lines: str, fails: set[str], copied: Path, design_dir: Path, tmp_path: Path
) -> None:
    own = read_design(copied / "design.json").props[0]
    other = prop_of(design_dir, tmp_path, lines, copied).props[0]
    assert (other == own) == (not fails)
    assert failing(copied, "wrap") >= fails
    assert bool(failing(copied, "wrap")) == bool(fails)


def test_a_prop_that_an_earlier_design_left_is_seen(
    copied: Path, design_dir: Path, tmp_path: Path
) -> None:
    flat = of_lines(design_dir, tmp_path, "[mould]\ntip_lip_mm = 0\n")
    (copied / "design.json").write_text(design_text(flat), encoding="utf-8")
    found = list(wrap.measure(copied, flat))
    assert [m.subject for m in found] == [f"mould/prop.{end}" for end in ("3mf", "step", "stl")]
    assert not [m for m in found if m.passed]
    for file in (copied / "mould").glob("prop.*"):
        file.unlink()
    assert not list(wrap.measure(copied, flat))


def slot_filled(part: Body) -> Body:
    return part + box((2.5, 21.2, -1.9), (13.4, 21.85, -1.6))


def slot_shallow(part: Body) -> Body:
    return part + box((2.5, 21.0, -2.0), (13.4, 21.4, -1.6))


def slot_too_wide(part: Body) -> Body:
    return part - box((12, 21.25, -3), (13.4, 22, -1))


def tip_too_thick(part: Body) -> Body:
    return part + box((6, 20.8, -2.6), (12, 21.25, -2.0))


@pytest.mark.parametrize(
    ("damage", "fails"),
    [
        (slot_filled, {"slots"}),
        (slot_shallow, {"slots"}),
        (slot_too_wide, {"slots"}),
        (tip_too_thick, {"lip"}),
    ],
)
def test_a_damaged_tip(damage: Damage, fails: set[str], copied: Path) -> None:
    assert carved(copied, BACKING, damage) == fails


def weir_raised(part: Body) -> Body:
    return part + box((-12, -35, -1.8), (12, -33, -1.5))


def weir_cut(part: Body) -> Body:
    return part - box((-4, -40, -1.9), (4, -32.5, -1.1))


def groove_beside_the_middle(part: Body) -> Body:
    return part - box((4, -40, -1.9), (6, -32.5, -1.1))


def slit_under_the_level(part: Body) -> Body:
    return part - box((-1, 21.9, -2.6), (1, 30, -2.45))


def wall_low_at_the_tip(part: Body) -> Body:
    return part - box((-5, 21.9, -4), (5, 30, -2.6))


def grip_too_deep(part: Body) -> Body:
    return part - box((20, -12, -4), (40, -2, -2.0))


@pytest.mark.parametrize(
    ("damage", "fails"),
    [
        (weir_raised, {"level", "held"}),
        (weir_cut, {"level", "lip"}),
        (groove_beside_the_middle, {"level", "lip"}),
        (slit_under_the_level, {"held"}),
        (wall_low_at_the_tip, {"held"}),
        (grip_too_deep, {"held"}),
    ],
)
def test_a_damaged_mould(damage: Damage, fails: set[str], copied: Path) -> None:
    assert carved(copied, MOULD, damage) == fails


def test_damaged_files(copied: Path) -> None:
    flip_a_triangle(copied / PROP)
    assert "prop" in failing(copied, "wrap")
    (copied / PROP).unlink()
    assert failing(copied, "wrap") == {"prop"}
    (copied / BACKING).unlink()
    assert failing(copied, "wrap") == {"prop"}


def of_lines(design_dir: Path, tmp_path: Path, lines: str) -> Design:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    file = folder / "mine.toml"
    file.write_text(f'extends = "fingertip.toml"\n{lines}', encoding="utf-8")
    return derive(load(file))


@pytest.mark.parametrize(
    "lines",
    [
        "[mould]\ntip_lip_mm = 0.3\n",
        "[tip]\nedge_mm = 0.5\n",
        "[mould]\ntip_lip_mm = 1.0\n",
        "[tip]\nangle_deg = 12.2\n",  # of the published part
        "[tip]\nangle_deg = 40\n",
        "[stack]\npcb_mm = 0.8\n",
        "[mould]\ndraft_deg = 8\n[printer]\nfit_mm = 0.1\n",
        'extends = "presets/flex.toml"',
    ],
)
def test_other_tips_pass_every_check(lines: str, design_dir: Path, tmp_path: Path) -> None:
    if lines.startswith("extends"):
        made = derive(load(design_dir / "presets" / "flex.toml"))
    else:
        made = of_lines(design_dir, tmp_path, lines)
    out = written(made, made, tmp_path / "made")
    (out / "mould").mkdir()
    files = [a for finger in made.fingers for a in mould_files(made, finger)]
    for artefact in (*files, *prop_files(made, made.props[0])):
        (out / artefact.path).write_bytes(artefact.data)
    found = [*wrap.measure(out, read_design(out / "design.json"))]
    assert {m.check for m in found} == {f"wrap.{name}" for name in EVERY}
    assert not [m for m in found if not m.passed]


def test_the_level_is_that_of_a_liquid_at_rest(design_dir: Path) -> None:
    """A plane through the weir, level in the world: height over the rim grows with sin and cos."""
    design = derive(load(design_dir / "fingertip.toml"))
    (prop,) = design.props
    turn = math.radians(prop.tilt_deg)
    y = design.outline.tip_y_mm
    world = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    weir, tip = world @ (prop.weir_y_mm, 0.0), world @ (y, -prop.level_mm(y))
    assert weir[1] == pytest.approx(tip[1], abs=1e-9)
    assert prop.level_mm(y) > design.tip.edge_mm + prop.lip_mm
