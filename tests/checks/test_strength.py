"""The fingers' strength and the spans of their print, on backings by themselves, to damage."""

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.spans import longest_span_mm
from lumitip_fab.checks.strength import measure
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import read_design
from lumitip_fab.design.frames import backing_bed_to_sensor, mount_to_sensor
from printed_fingers import written

PART = "backing/receiver_backing.stl"


@pytest.fixture(scope="module", params=["published", "flex"])
def fingers(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, design_dir: Path
) -> Path:
    """The printed fingers of a preset."""
    design = derive(load(design_dir / "presets" / f"{request.param}.toml"))
    return written(design, design, tmp_path_factory.mktemp("fingers") / request.param)


def failed(out: Path) -> set[str]:
    """Names of the checks that fail."""
    return {m.check for m in measure(out, read_design(out / "design.json")) if not m.passed}


def figures(out: Path) -> dict[str, float]:
    """Measured figures of the damaged finger."""
    found = measure(out, read_design(out / "design.json"))
    return {m.check: float(m.measured) for m in found if m.subject == PART}


@pytest.mark.slow_cases
def test_both_kinds_of_finger_bear_their_load(fingers: Path) -> None:
    design = read_design(fingers / "design.json")
    assert not failed(fingers)
    for m in design.fingers[0].name, design.fingers[1].name:
        mesh = solids.read_mesh(fingers / f"backing/{m}_backing.stl")
        assert longest_span_mm(mesh, design.printing)[0] < 5.0


Damage = Callable[[Design], Design]


def thin(design: Design) -> Design:
    """As before there was a flare."""
    return replace(design, mount=replace(design.mount, flare_depth_mm=0.6))


def upright(design: Design) -> Design:
    """The end of the pocket as it was, level in the print."""
    return replace(design, board=replace(design.board, roof_mm=0.0))


@pytest.fixture(scope="module")
def published(design_dir: Path) -> Design:
    """The published design."""
    return derive(load(design_dir / "presets" / "published.toml"))


@pytest.mark.slow
def test_a_thin_flare_is_found(published: Design, tmp_path: Path) -> None:
    out = written(published, thin(published), tmp_path / "thin")
    assert {"strength.bend", "strength.board"} <= failed(out)


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    ("check", "size_mm", "at_mm"),
    [
        ("strength.layers", (30.0, 14.0, 1.0), (0.0, 8.0, 3.5)),  # a saw cut over the mount plane
        ("strength.glue", (60.0, 4.0, 36.0), (0.0, 2.0, 30.0)),  # no floor behind the board
    ],
)
def test_a_cut_is_found(
    check: str,
    size_mm: tuple[float, float, float],
    at_mm: tuple[float, float, float],
    published: Design,
    tmp_path: Path,
) -> None:
    out = written(published, published, tmp_path / "cut")
    whole = trimesh.load(out / PART, force="mesh")
    away = trimesh.creation.box(size_mm).apply_translation(at_mm)
    trimesh.boolean.difference([whole, away], engine="manifold").export(out / PART)
    assert check in failed(out)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("check", "diameter_mm", "low_mm", "high_mm"),
    [
        ("strength.bolt_head", 8.0, -1.0, 6.0),  # a drill for the head went through the land
        ("strength.bolt_seat", 8.9, -1.0, 3.0),  # a recess in the foot leaves a thin land
    ],
)
def test_a_weak_seat_of_a_bolt_is_found(
    check: str,
    diameter_mm: float,
    low_mm: float,
    high_mm: float,
    published: Design,
    tmp_path: Path,
) -> None:
    out = written(published, published, tmp_path / "drilled")
    mount, stack = published.mount, published.stack
    bed_to_mount = np.linalg.inv(mount_to_sensor(mount, stack)) @ backing_bed_to_sensor(
        mount, stack
    )
    whole = trimesh.load(out / PART, force="mesh").apply_transform(bed_to_mount)
    away = trimesh.creation.cylinder(diameter_mm / 2, high_mm - low_mm)
    away.apply_translation((mount.bolt_u_mm[0], mount.bolt_w_mm, (low_mm + high_mm) / 2))
    drilled = trimesh.boolean.difference([whole, away], engine="manifold")
    drilled.apply_transform(np.linalg.inv(bed_to_mount)).export(out / PART)
    assert check in failed(out)


@pytest.mark.slow
def test_a_seat_that_ends_near_the_bolts_pulls_their_heads_in(
    published: Design, tmp_path: Path
) -> None:
    near = replace(published.mount, seat_back_w_mm=published.mount.bolt_w_mm + 1.0)
    short = replace(published, mount=near)
    found = failed(written(short, published, tmp_path / "short"))
    assert "strength.bolt_head" in found or "strength.bolt_seat" in found


@pytest.mark.slow
def test_light_leaves_the_apertures_of_a_finger_that_bends_far(
    published: Design, tmp_path: Path
) -> None:
    strong = replace(published, strength=replace(published.strength, rated_force_n=400.0))
    assert "strength.light_path" in failed(written(strong, published, tmp_path / "bent"))


@pytest.mark.slow
def test_a_plate_with_a_neck_twists_and_shades(fingers: Path, tmp_path: Path) -> None:
    """Saw cuts from both sides, between interface and tip; a rigid finger has its board there."""
    out = Path(shutil.copytree(fingers, tmp_path / "neck"))
    design, before = read_design(out / "design.json"), figures(out)["strength.twist"]
    to_sensor = backing_bed_to_sensor(design.mount, design.stack)
    whole = trimesh.load(out / PART, force="mesh").apply_transform(to_sensor)
    for side in (-1, 1):
        away = trimesh.creation.box((30.0, 8.0, 30.0)).apply_translation((side * 20.0, 6.0, 0.0))
        whole = trimesh.boolean.difference([whole, away], engine="manifold")
    whole.apply_transform(np.linalg.inv(to_sensor)).export(out / PART)
    compliant = bool(design.interfaces)
    assert figures(out)["strength.twist"] > (1.3 if compliant else 1.02) * before
    assert ("strength.light_path" in failed(out)) == compliant


@pytest.mark.slow
def test_a_missing_part_is_named(fingers: Path, tmp_path: Path) -> None:
    out = Path(shutil.copytree(fingers, tmp_path / "missing"))
    (out / PART).unlink()
    assert failed(out) == {"strength.readable"}


@pytest.mark.slow
def test_the_level_end_of_a_pocket_is_a_long_span(published: Design, tmp_path: Path) -> None:
    """As issue 15 measured it: a strand as long as the pocket is wide, under the tip."""
    out = written(published, upright(published), tmp_path / "level")
    span, at_mm = longest_span_mm(solids.read_mesh(out / PART), published.printing)
    assert span == pytest.approx(published.board.pocket.width_mm, abs=0.5)
    assert at_mm == pytest.approx(48.8, abs=0.3)
    assert span > published.printing.bridge_mm


def test_spans_of_plain_bodies(published: Design) -> None:
    """A shelf hangs over nothing, a cone of 45° does not."""
    foot = trimesh.creation.box((10.0, 10.0, 10.0)).apply_translation((0.0, 0.0, 5.0))
    shelf = trimesh.creation.box((30.0, 10.0, 2.0)).apply_translation((10.0, 0.0, 11.0))
    table = trimesh.boolean.union([foot, shelf], engine="manifold")
    span, at_mm = longest_span_mm(table, published.printing)
    assert span == pytest.approx(20.0, abs=0.5)
    assert at_mm == pytest.approx(10.1, abs=0.2)
    cone = trimesh.creation.cone(10.0, 10.0, sections=128).apply_transform(
        [[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 10], [0, 0, 0, 1]]
    )
    assert longest_span_mm(cone, published.printing)[0] == 0.0
