"""Holes that hold the skin, in written backings: open, wider in the back, with walls all round."""

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import shapely

from finger_notes import noted_mould
from lumitip_fab.checks import backing as backing_checks
from lumitip_fab.checks.readers import solids
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design, Key
from lumitip_fab.design.frames import backing_bed_to_sensor
from lumitip_fab.parts.backing import backing
from lumitip_fab.parts.plate import key_fillings

pytestmark = pytest.mark.slow

Change = Callable[[Key], Key | None]
Made = Callable[..., tuple[Path, Design]]
DESIGNS = {
    "published": 'extends = "presets/published.toml"',
    "flex": 'extends = "presets/flex.toml"',
    "long": 'extends = "fingertip.toml"\n[grid]\ncolumns = [9, 8, 9]\npitch_mm = 6.0',
    "wsg50": 'extends = "presets/wsg50.toml"\n[tip]\nangle_deg = 0',
}


@pytest.fixture(scope="module")
def design(design_dir: Path) -> Design:
    return derive(load(design_dir / "presets" / "published.toml"))


@pytest.fixture
def made(design_dir: Path, tmp_path: Path) -> Made:
    """`made("flex", keys)`: the receiver's backing in a folder, with the design's keys or others,
    and the design."""

    def make(name: str, change: Change = lambda key: key) -> tuple[Path, Design]:
        folder = Path(shutil.copytree(design_dir, tmp_path / "design", dirs_exist_ok=True))
        file = folder / "mine.toml"
        file.write_text(DESIGNS[name], encoding="utf-8")
        design = derive(load(file))
        keys = tuple(new for key in design.keys if (new := change(key)))
        for artefact in backing(replace(design, keys=keys), design.receiver):
            path = tmp_path / artefact.path
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(artefact.data)
        return tmp_path, design

    return make


def failed(out: Path, design: Design) -> set[str]:
    found = backing_checks.measure(out, design)
    return {
        m.check.partition(".")[2]
        for m in found
        if m.subject.startswith("backing/receiver") and not m.passed and "key" in m.check
    }


@pytest.mark.parametrize("name", DESIGNS)
def test_keys_stand_beside_the_board_with_walls_all_round(made: Made, name: str) -> None:
    out, design = made(name)
    assert len(design.keys) >= 4
    assert not failed(out, design)
    mesh = solids.read_mesh(out / "backing/receiver_backing.stl")
    sensor = solids.moved(mesh, backing_bed_to_sensor(design.mount, design.stack))
    stack, tip = design.stack, design.tip
    for key in design.keys:
        heights = [stack.face_z_mm - 0.05]
        if key.at[1] < tip.slant_start_y_mm - key.wide_mm:  # else a level cut leaves the plate
            heights.append(stack.back_z_mm + 0.05)
        for z_mm in heights:
            cut = solids.section(sensor, z_mm)
            rings = [
                ring
                for piece in shapely.get_parts(cut)
                for ring in (piece.exterior, *piece.interiors)
            ]
            axis = shapely.Point(key.at)
            own = min(rings, key=axis.distance)
            assert shapely.Polygon(own).contains(axis)
            walls = [own.distance(ring) for ring in rings if ring is not own]
            assert min(walls) >= design.printing.min_wall_mm


def test_keys_are_alike_on_both_sides(made: Made) -> None:
    _, design = made("published")
    places = {key.at for key in design.keys}
    assert places == {(-x, y) for x, y in places}
    assert {key.hole_mm for key in design.keys} == {1.6}


@pytest.mark.parametrize(
    ("change", "caught"),
    [
        (lambda key: key if key.at[1] < 0 else None, {"keys", "key_hole", "keys_open", "key_sink"}),
        (lambda key: replace(key, sink_mm=0.05), {"key_sink"}),
        (lambda key: replace(key, hole_mm=1.2), {"key_hole", "key_sink"}),
        (lambda key: replace(key, at=(key.at[0] + 0.2, key.at[1])), {"keys", "key_sink"}),
    ],
    ids=["closed", "straight", "narrow", "moved"],
)
def test_keys_that_do_not_hold_are_caught(made: Made, change: Change, caught: set[str]) -> None:
    assert failed(*made("published", change)) == caught


def test_a_finger_without_keys_has_none(design: Design) -> None:
    bare = replace(design, keys=())
    assert key_fillings(bare.keys, bare.stack, bare.outline, bare.tip) == []
    notes = [noted_mould(each, each.receiver)[-1].data.decode() for each in (design, bare)]
    assert "small holes beside the board" in notes[0]
    assert "small holes beside the board" not in notes[1]


def test_silicone_fills_the_keys_to_the_back(design: Design) -> None:
    fillings = key_fillings(design.keys, design.stack, design.outline, design.tip)
    for key, filling in zip(design.keys, fillings, strict=True):
        box = filling.bounding_box()
        assert pytest.approx(design.stack.face_z_mm, abs=1e-6) == box.max.Z
        assert design.stack.back_z_mm - 1e-6 <= box.min.Z
        assert key.wide_mm - 1e-6 <= box.size.X
