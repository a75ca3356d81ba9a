"""The printer's fit is in everything that is printed round a board, metal or the gripper."""

import dataclasses
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip_fab.checks import backing, flange, holder
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import design_text, read_design
from lumitip_fab.errors import FabError
from lumitip_fab.parts.backing import backing as backing_files

pytestmark = pytest.mark.slow

Derived = Callable[..., Design]
ROUND_FLANGE = {"spigot", "recess", "pin_width", "socket_width", "peg_play"}
ROUND_BOARD = {"board_gap", "board_play"}
TIGHT = {"flange.bolt_clearance", "holder.screw_clearance", "holder.nut_clearance"}
"""Where nothing is to spare: too narrow as they are printed, if they were drawn for no fit."""
COMPLIANT = """
[stack]
floor_mm = 2.0
pcb_mm = 0.2
[backing]
variant = "flex"
material = "TPU 98A"
density_g_ml = 1.22
[tip]
slant_start_mm = 14.2
"""


@pytest.fixture
def fitted(design_dir: Path, tmp_path: Path) -> Derived:
    """`fitted(0.05)`: the published design for a printer of that fit."""

    def get(fit_mm: float, more: str = "") -> Design:
        folder = tmp_path / "design"
        if not folder.exists():
            shutil.copytree(design_dir, folder)
        file = folder / "mine.toml"
        file.write_text(
            f'extends = "presets/published.toml"\n{more}\n[printer]\nfit_mm = {fit_mm}\n'
        )
        return derive(load(file))

    return get


@pytest.mark.parametrize("fit_mm", [-0.1, -0.05, 0.05, 0.1])
def test_flange_and_holder_follow_the_fit(fit_mm: float, fitted: Derived) -> None:
    """Holes and pockets are wider, what stands in something narrower; nothing else moves."""
    snug, loose = fitted(0.0), fitted(fit_mm)
    wider = {
        "recess_mm": 2,
        "bolt_hole_mm": 2,
        "pin_hole_mm": 2,
        "socket_mm": 2,
        "screw_mm": 2,
        "peg_hole_mm": 2,
        "spigot_mm": -2,
        "peg_mm": -2,
        "pocket_corner_mm": 1,
    }
    (before,), (after,) = snug.flanges, loose.flanges
    for name, times in wider.items():
        assert getattr(after, name) - getattr(before, name) == pytest.approx(times * fit_mm), name
    grown = dataclasses.astuple(before.pocket.grown(fit_mm))
    assert dataclasses.astuple(after.pocket) == pytest.approx(grown)
    same = dict.fromkeys([*wider, "pocket"], 0)
    assert dataclasses.replace(after, **same) == dataclasses.replace(before, **same)

    (was,), (now,) = snug.holders, loose.holders
    assert now.cradle_mm - was.cradle_mm == pytest.approx(fit_mm)
    assert now.tray.x_max_mm - was.tray.x_max_mm == pytest.approx(fit_mm)
    assert now.nut_mm - was.nut_mm == pytest.approx(2 * fit_mm)
    assert now.screw_mm - was.screw_mm == pytest.approx(2 * fit_mm)
    kept = ("body_mm", "floor_z_mm", "seat_z_mm", "holes", "strap_hole_mm", "wall_mm", "wrap_deg")
    assert all(getattr(now, name) == getattr(was, name) for name in kept)


@pytest.mark.parametrize("fit_mm", [-0.1, 0.1])
def test_files_that_were_drawn_for_another_fit_fail(fit_mm: float, outputs: Path) -> None:
    """Limits come from the fit and from what is met, not from what was drawn."""
    tight = TIGHT if fit_mm > 0 else set()
    design = read_design(outputs / "design.json")
    fitting = dataclasses.replace(design.printing, fit_mm=fit_mm)
    other = dataclasses.replace(design, printing=fitting)
    failed = {m.check for m in flange.measure(outputs, other) if not m.passed}
    tight_flange = {name for name in tight if name.startswith("flange.")}
    assert failed == {f"flange.{name}" for name in ROUND_FLANGE | ROUND_BOARD} | tight_flange
    failed = {m.check for m in holder.measure(outputs, other) if not m.passed}
    assert failed == {"holder.tray_gap", "holder.cradle", "holder.preload"} | (tight - tight_flange)


def test_a_fit_that_leaves_no_gap_is_refused_with_the_numbers(fitted: Derived) -> None:
    with pytest.raises(FabError) as refusal:
        fitted(-0.1, "[flange]\nclearance_mm = 0.1\n[holder]\nclearance_mm = 0.05")
    told = str(refusal.value)
    assert "leaves 0.00 mm of flange.clearance_mm = 0.1, as drawn; at least -0.08 is needed" in told
    assert "leaves -0.05 mm of holder.clearance_mm = 0.05" in told


def test_a_fit_that_leaves_too_little_wall_is_refused_with_the_numbers(fitted: Derived) -> None:
    with pytest.raises(FabError) as refusal:
        fitted(0.1, "[flange]\nclearance_mm = 0.9")
    assert "with printer.fit_mm = 0.1; at least" in str(refusal.value)


@pytest.mark.parametrize("fit_mm", [-0.1, -0.05, 0.05, 0.1])
def test_the_rim_follows_the_fit_and_its_groove_does_not(fit_mm: float, fitted: Derived) -> None:
    """The reading is of the rim's filament: its outer edge and the pad's go back, nothing else."""
    (before,), (after,) = (fitted(fit, COMPLIANT).interfaces for fit in (0.0, fit_mm))
    assert after.rim_mm - before.rim_mm == pytest.approx(-2 * fit_mm)
    shrunk = dataclasses.astuple(before.box.grown(-fit_mm))
    wanted = (*shrunk[:2], before.box.y_min_mm, shrunk[3])  # it ends where the plate does
    assert dataclasses.astuple(after.box) == pytest.approx(wanted)
    assert after.rim_height_mm == before.rim_height_mm
    assert dataclasses.replace(after, gap_mm=before.gap_mm) == before


@pytest.mark.parametrize(
    ("fit_mm", "flex", "told"),
    [
        (-0.1, "glue_mm = 0.1", "leaves 0.00 mm of flex.glue_mm = 0.1, as drawn; at least -0.08"),
        (
            0.1,
            "groove_mm = 1.3",
            "leaves a rim of 0.80 mm between gaps of 0.15 and printer.fit_mm "
            "= 0.1; at least two printed lines of 0.45",
        ),
    ],
)
def test_a_fit_that_leaves_no_gap_or_rim_is_refused_with_the_numbers(
    fit_mm: float, flex: str, told: str, fitted: Derived
) -> None:
    fitted(0.0, f"{COMPLIANT}[flex]\n{flex}")
    with pytest.raises(FabError) as refusal:
        fitted(fit_mm, f"{COMPLIANT}[flex]\n{flex}")
    assert told in str(refusal.value)


def test_a_rim_that_was_drawn_for_another_fit_is_told(fitted: Derived, tmp_path: Path) -> None:
    """The gap is measured against glue and fit, not against what was drawn."""
    design = fitted(0.1, COMPLIANT)
    for finger in design.fingers:
        for made in backing_files(design, finger):
            (tmp_path / made.path).parent.mkdir(exist_ok=True)
            (tmp_path / made.path).write_bytes(made.data)
    (tmp_path / "design.json").write_text(design_text(design), encoding="utf-8")
    for fit_mm, failing in ((0.1, set()), (0.0, {"backing.glue"})):
        fitting = dataclasses.replace(design.printing, fit_mm=fit_mm)
        other = dataclasses.replace(design, printing=fitting)
        failed = {m.check for m in backing.measure(tmp_path, other) if not m.passed}
        assert failed == failing
