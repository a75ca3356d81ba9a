"""Every gripper of the catalogue, and one that is added: each coupling from its entry alone."""

import dataclasses
import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from manifold3d import Manifold

from damages import carve, failing
from lumitip_fab.checks import fit_plate
from lumitip_fab.checks.run import run_checks
from lumitip_fab.cli.build import build
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design.encoding import design_text, read_design, round_trip
from lumitip_fab.errors import FabError
from lumitip_fab.parts.fit_plate import fit_plate_files
from lumitip_fab.parts.settings import print_settings
from lumitip_fab.parts.slicing import slice_parts
from programs import program

pytestmark = pytest.mark.slow

WITHOUT_PRESET = ("onrobot_rg2", "two_hole_jaw")
NEW = """
[bench_jaw]
source = "a jaw on the bench, measured with callipers"
confidence = "measured"
stroke_mm = 48.0
pad_w_mm = 9.0
tilt_deg = 0.5
block_width_mm = 26.0
block_corner_mm = 2.0
block_back_w_mm = 16.0
bolt = "M3"
bolt_w_mm = 10.0
bolt_spacing_mm = 15.0
bolt_hole_mm = 3.4
counterbore_mm = 6.4
land_mm = 4.0
seat_width_mm = 24.0
pins = { hole_mm = 3.1, spacing_mm = 6.0, depth_mm = 2.5 }
nose = { front_width_mm = 14.0, front_w_mm = 3.5, half_angle_deg = 45.0, height_mm = 2.0 }

[bench_jaw.envelope]
source = "the same callipers"
confidence = "measured"
width_mm = 60.0
depth_mm = 40.0
corner_mm = 2.0
length_mm = 70.0
reach_mm = 85.0
mass_kg = 0.9
payload_kg = 2.0
"""
File = Callable[..., Path]


@pytest.fixture
def held_by(design_dir: Path, tmp_path: Path) -> File:
    """`held_by("bench_jaw", NEW)`: the published sensor held by a gripper, whose entry is added to
    a copy of the catalogue, and with another fit."""

    def write(gripper: str, entry: str = "", fit_mm: float = 0.0) -> Path:
        folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
        with (folder / "parts/grippers.toml").open("a", encoding="utf-8") as parts:
            parts.write(entry)
        file = folder / "presets/mine.toml"
        file.write_text(
            f'extends = "published.toml"\n[coupling]\ngripper = "{gripper}"\n'
            f"[printer]\nfit_mm = {fit_mm}\n",
            encoding="utf-8",
        )
        return file

    return write


def failed(file: Path, outputs: Path, out: Path) -> list[str]:
    """Checks that fail once a file is built over the published design's outputs, as a user does who
    changes the gripper: what stays as it was is not made again, and is checked all the same."""
    shutil.copytree(outputs, out)
    build(file, out)
    return [f"{m.check} {m.subject}: {m.measured} {m.limit}" for m in run_checks(out).failed]


@pytest.mark.parametrize("gripper", WITHOUT_PRESET)
def test_a_gripper_of_the_catalogue(
    gripper: str, held_by: File, outputs: Path, tmp_path: Path
) -> None:
    assert failed(held_by(gripper), outputs, tmp_path / "out") == []


def test_a_new_gripper_needs_nothing_but_its_entry(
    held_by: File, outputs: Path, tmp_path: Path
) -> None:
    assert failed(held_by("bench_jaw", NEW), outputs, tmp_path / "out") == []


def test_every_gripper_of_the_catalogue_holds_the_published_sensor(design_dir: Path) -> None:
    config = load(design_dir / "presets/published.toml")
    tested = {*WITHOUT_PRESET, "robotiq_2f85"}
    tested |= {p.stem for p in (design_dir / "presets").glob("*.toml")}
    assert set(config.catalogue.grippers) <= tested


@pytest.mark.parametrize("fit_mm", [-0.1, 0.1])
def test_the_fit_of_the_printer_passes_every_check(
    fit_mm: float, held_by: File, outputs: Path, tmp_path: Path
) -> None:
    assert failed(held_by("robotiq_2f85", fit_mm=fit_mm), outputs, tmp_path / "out") == []


def test_the_fit_is_added_to_every_gap_and_moves_nothing_else(held_by: File) -> None:
    file = held_by("robotiq_2f85", fit_mm=0.05)
    snug = derive(load(file.with_name("published.toml")))
    loose = derive(load(file))
    grown = dataclasses.astuple(snug.board.pocket.grown(0.05))
    assert dataclasses.astuple(loose.board.pocket) == pytest.approx(grown)
    assert loose.board.pin_mm == pytest.approx(snug.board.pin_mm - 0.1)
    assert loose.mount.bolt_hole_mm == pytest.approx(snug.mount.bolt_hole_mm + 0.1)
    assert loose.mount.pin_mm == pytest.approx(snug.mount.pin_mm + 0.1)
    assert loose.mount.nose is not None
    assert snug.mount.nose is not None
    narrower = snug.mount.nose.front_width_mm - loose.mount.nose.front_width_mm
    assert narrower == pytest.approx(2 * 0.05 / 0.866, abs=1e-3)
    assert (loose.board.box, loose.receiver, loose.emitter) == (
        snug.board.box,
        snug.receiver,
        snug.emitter,
    )
    assert (loose.outline, loose.layout) == (snug.outline, snug.layout)


def test_a_figure_is_unsure_unless_a_datasheet_or_a_measurement_gives_it(design_dir: Path) -> None:
    grippers = load(design_dir / "presets/published.toml").catalogue.grippers
    assert tuple(grippers["robotiq_2f85"].unsure) == ("force_n", "bolt", "seat_back_w_mm")
    assert {"bolt_w_mm", "pins", "pad_w_mm"} <= set(grippers["wsg50"].unsure)
    assert not {"stroke_mm", "bolt_spacing_mm"} & set(grippers["wsg50"].unsure)


def changed(before: str, after: str) -> str:
    assert before in NEW
    return NEW.replace(before, after)


REFUSED = {
    changed(
        "bolt_spacing_mm = 15.0", "bolt_spacing_mm = 7.0"
    ): "whose block has 0.60 mm of wall between its counterbores",
    changed(
        "bolt_spacing_mm = 15.0", "bolt_spacing_mm = 19.0"
    ): "whose block has 0.30 mm of wall beside its counterbores",
    changed(
        "block_back_w_mm = 16.0", "block_back_w_mm = 13.5"
    ): "whose block has 0.30 mm of wall behind its counterbores",
    changed(
        "block_corner_mm = 2.0", "block_corner_mm = 11.0"
    ): "whose block has 0.37 mm of wall at its corners",
    changed(
        "counterbore_mm = 6.4", "counterbore_mm = 4.0"
    ): "whose block has 0.30 mm of wall round the bolts under their heads",
    changed("depth_mm = 2.5", "depth_mm = 3.5"): "whose block has 0.50 mm of wall over the pins",
    changed(
        "hole_mm = 3.1", "hole_mm = 5.1"
    ): "whose block has 0.25 mm of wall between bolts and pins",
    changed("pad_w_mm = 9.0", "pad_w_mm = 13.0"): "when it is closed",
    changed('bolt = "M3"', 'bolt = "3 mm"'): "bolt",
    changed("length_mm = 70.0", "length_mm = 90.0"): "length_mm is 90; at most reach_mm = 85",
    changed("corner_mm = 2.0\nlength", "corner_mm = 21.0\nlength"): "corner_mm is 21; at most 20",
    NEW
    + "[bench_jaw.origin]\n"
    + 'bold_mm = { source = "x", confidence = "assumed" }\n': "origin has bold_mm",
}


@pytest.mark.parametrize("entry", REFUSED, ids=REFUSED.get)
def test_a_coupling_that_cannot_be_made_is_refused_with_the_numbers(
    entry: str, held_by: File
) -> None:
    with pytest.raises(FabError) as refusal:
        derive(load(held_by("bench_jaw", entry)))
    assert REFUSED[entry] in str(refusal.value)


def tube(u: float, w: float, diameter: float, low: float, high: float) -> Manifold:
    return Manifold.cylinder(high - low, diameter / 2, -1.0, 96).translate((u, w, low))


# Damages of the coupling of two bolts with sleeves: axes at u = ±10.5, w = 9.5.


def second_bolt_moved(part: Manifold) -> Manifold:
    filled = part + tube(10.5, 9.5, 5.0, 2.6, 4.5)
    return filled - tube(10.3, 9.5, 4.3, 2.0, 4.6)


def second_bolt_hole_narrow(part: Manifold) -> Manifold:
    return part + (tube(10.5, 9.5, 5.0, 2.6, 4.5) - tube(10.5, 9.5, 4.0, 0.0, 5.0))


def sleeve_narrow(part: Manifold) -> Manifold:
    return part + (tube(-10.5, 9.5, 7.0, 0.0, 2.6) - tube(-10.5, 9.5, 5.8, -1.0, 5.0))


def sleeve_shallow(part: Manifold) -> Manifold:
    return part + (tube(10.5, 9.5, 6.2, 2.3, 2.7) - tube(10.5, 9.5, 4.3, 0.0, 5.0))


def second_seat_low(part: Manifold) -> Manifold:
    return part - tube(10.5, 9.5, 7.4, 4.3, 5.0)


DAMAGES = {
    second_bolt_moved: {"bolt", "bolt_clearance", "screw_seat"},
    second_bolt_hole_narrow: {"bolt_hole", "bolt_clearance"},
    sleeve_narrow: {"gripper_pin_hole"},
    sleeve_shallow: {"gripper_pin_depth", "min_wall"},
    second_seat_low: {"screw_seat"},
}


# A nose too narrow for a value before its holes, and one whose flanks end early.
NARROW = changed(
    "front_width_mm = 14.0, front_w_mm = 3.5, half_angle_deg = 45.0",
    "front_width_mm = 4.0, front_w_mm = 3.5, half_angle_deg = 60.0",
)
EARLY = changed("front_width_mm = 14.0", "front_width_mm = 20.0")
OWN = {"wide": NEW, "narrow": NARROW, "early": EARLY}


@pytest.mark.parametrize("gripper", [*OWN, "robotiq_2f85", "wsg50", "franka_hand", "two_hole_jaw"])
def test_a_fit_test_plate_passes_its_checks_and_prints_in_half_an_hour(
    gripper: str, held_by: File, tmp_path: Path
) -> None:
    file = held_by("bench_jaw", OWN[gripper]) if gripper in OWN else held_by(gripper)
    design = round_trip(derive(load(file)))
    made = fit_plate_files(design)
    made += print_settings(design)
    for artefact in made:
        (tmp_path / artefact.path).parent.mkdir(exist_ok=True)
        (tmp_path / artefact.path).write_bytes(artefact.data)
    measured = tuple(fit_plate.measure(tmp_path, design))
    assert [m for m in measured if not m.passed] == []
    assert any(m.check == "fit_plate.sleeve" for m in measured) == design.mount.sleeved
    (tmp_path / "design.json").write_text(design_text(design), encoding="utf-8")
    (tmp_path / "manifest.json").write_text(json.dumps({"files": [a.path for a in made]}))
    program("prusa-slicer")
    (sliced,) = slice_parts(tmp_path)
    assert sliced.warnings == ()
    assert sliced.seconds <= 30 * 60


def test_a_sleeve_of_the_fit_test_plate_too_deep(
    built: Callable[[str], Path], tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(built("wsg50"), tmp_path / "damaged"))
    design = read_design(folder / "design.json")
    plate, mount = design.fit_plate, design.mount
    x, y = plate.at(1, plate.slice_at)
    at = (x - mount.bolt_u_mm[-1], y - mount.bolt_w_mm)
    deeper = tube(*at, plate.steps[1].gripper_pin_mm, -1.0, plate.pin_depth_mm + 0.2)
    carve(folder / "fit/fit_plate.stl", lambda part: part - deeper)
    assert failing(folder, "fit_plate") == {"sleeve"}


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_the_second_bolt_or_of_a_sleeve(
    damage: Callable[[Manifold], Manifold], built: Callable[[str], Path], tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(built("wsg50"), tmp_path / "damaged"))
    carve(folder / "backing/receiver_backing.stl", damage)
    assert failing(folder, "backing") == DAMAGES[damage]
