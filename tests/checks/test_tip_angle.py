"""Tips of any angle: backing, mould and mask as written, measured apart from what derived them."""

import shutil
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

from finger_notes import noted_mask, noted_mould
from lumitip_fab.checks import backing as backing_checks
from lumitip_fab.checks import mask as mask_checks
from lumitip_fab.checks import mould as mould_checks
from lumitip_fab.checks.mask_flaps import FILLETS_MM, Flap, flaps_of, folds_of
from lumitip_fab.checks.mask_holes import cut_of, place, registration_of
from lumitip_fab.checks.mould import GAP_MM
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.mask_page import read_page
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import design_text, read_design
from lumitip_fab.design.frames import backing_bed_to_sensor, mould_bed_to_sensor
from lumitip_fab.parts.backing import backing

pytestmark = pytest.mark.slow

ANGLES = (0, 10, 30, 45)
PRESETS = ("published", "flex")
STEP_MM = 0.05
UP = np.array([0.0, 0.0, 1.0])
MAKERS = (backing, noted_mould, noted_mask)
Made = Callable[..., tuple[Path, Design]]


@pytest.fixture(scope="module")
def made(design_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Made:
    """`made("flex", 30)`: a folder with backings, moulds and masks, or with what other makers make,
    and the design. Do not change it."""
    folder = tmp_path_factory.mktemp("tips")
    shutil.copytree(design_dir, folder / "design")

    def make(
        preset: str, angle_deg: float, more: str = "", makers: Sequence[Any] = MAKERS
    ) -> tuple[Path, Design]:
        names = "_".join(maker.__name__ for maker in makers)
        out = folder / f"{preset}_{angle_deg}_{more}_{names}"
        if out.is_dir():
            return out, read_design(out / "design.json")
        file = folder / "design" / "mine.toml"
        file.write_text(
            f'extends = "presets/{preset}.toml"\n'
            f'[tip]\nangle_deg = {angle_deg}\nslant_start_mm = "auto"\n{more}\n'
        )
        design = derive(load(file))
        for finger in design.fingers:
            for maker in makers:
                for artefact in maker(design, finger):
                    (out / artefact.path).parent.mkdir(parents=True, exist_ok=True)
                    (out / artefact.path).write_bytes(artefact.data)
        out.mkdir(exist_ok=True)
        (out / "design.json").write_text(design_text(design), encoding="utf-8")
        return out, design

    return make


def part(out: Path, design: Design, finger: str) -> Any:
    """The backing in the sensor frame."""
    mesh = solids.read_mesh(out / f"backing/{finger}_backing.stl")
    return solids.moved(mesh, backing_bed_to_sensor(design.mount, design.stack))


def backs(out: Path, design: Design, finger: str) -> tuple[Any, Any]:
    """Distances from the tip edge, and height of the back there, by rays from behind."""
    tip_y, mesh = design.outline.tip_y_mm, part(out, design, finger)
    assert mesh.bounds[1, 1] == pytest.approx(tip_y, abs=0.02)
    along = np.arange(STEP_MM, 6.0 if design.interfaces else 13.0, STEP_MM)
    beside = (x for x in np.arange(1.0, 12.0, 0.3) if clear_of_keys(design, x))
    x = np.full(len(along), next(beside))
    starts = np.column_stack([x, tip_y - along, np.full(len(along), -40)])
    reach, _ = solids.cast(mesh, starts, UP, 80.0).first(len(starts))
    return along, reach - 40.0


def clear_of_keys(design: Design, x_mm: float) -> bool:
    """Whether no key is on a line along y."""
    return all(abs(x_mm - key.at[0]) > key.wide_mm for key in design.keys)


def wedge(out: Path, design: Design, finger: str) -> tuple[float, float, float]:
    """Angle of the back at the tip, thickness of the edge, and length of the wedge along the
    finger: from the file, and the plate's thickness."""
    along, z = backs(out, design, finger)
    low = z < z[0] - 1e-3
    rises = np.abs(np.diff(z)) > 1e-3
    run = float(along[:-1][rises].max() + STEP_MM / 2) if low.any() else 0.0
    inner = along < run - 2 * STEP_MM if run else along < 3
    slope, at_edge = np.polyfit(along[inner], z[inner], 1)
    edge = design.stack.face_z_mm - at_edge
    return float(-np.degrees(np.arctan(slope))), float(edge), run


def cavity(out: Path, design: Design) -> list[Any]:
    """Sections of the receiver's mould within the middle of its wall: outside it, the rails of the
    clamp follow the wedge."""
    stack, mould = design.stack, design.mould
    mesh = solids.read_mesh(out / "mould/receiver_mould.stl")
    mesh = solids.moved(mesh, mould_bed_to_sensor(stack, mould))
    inside = shapely.Polygon(design.outline.polygon()).buffer(mould.wall_gap_mm + mould.wall_mm / 2)
    face, floor = stack.face_z_mm, stack.silicone_z_mm
    heights = (face - 0.3, face + 0.2, (face + floor) / 2, floor + mould.wall_mm / 2)
    return [solids.section(mesh, z).intersection(inside) for z in heights]


def tip_flap(out: Path, design: Design, finger: str) -> Flap:
    """The flap over the tip, from the page."""
    page = read_page(out / f"mask/{finger}_mask_a4.pdf")
    placed = place(registration_of(page), design.mask)
    folds = folds_of(page, placed, np.array(design.mask.registration))
    flaps = flaps_of(cut_of(page, placed), folds)
    return max(flaps, key=lambda flap: float(flap.fold[:, 1].min()))


def failures(out: Path, design: Design) -> list[str]:
    """What the checks of all three parts find."""
    found = [m for c in (backing_checks, mould_checks, mask_checks) for m in c.measure(out, design)]
    assert {"backing.slant", "mould.seat", "mask.reach"} <= {m.check for m in found}
    return [f"{m.check} {m.subject}: {m.measured}" for m in found if not m.passed]


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("angle", ANGLES)
def test_the_written_backing_has_the_angle(preset: str, angle: float, made: Made) -> None:
    out, design = made(preset, angle)
    for finger in ("emitter", "receiver"):
        measured, edge, run = wedge(out, design, finger)
        assert measured == pytest.approx(angle, abs=0.05)
        assert edge == pytest.approx(design.tip.edge_mm, abs=0.01)
        assert edge >= design.printing.line_mm - 0.01
        left = design.stack.plate_mm - run * np.tan(np.radians(angle))
        assert edge == pytest.approx(left, abs=2 * STEP_MM)


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("angle", ANGLES)
def test_the_checks_of_backing_mould_and_mask_pass(preset: str, angle: float, made: Made) -> None:
    assert failures(*made(preset, angle)) == []


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("angle", ANGLES)
def test_the_tip_lies_in_the_cavity(preset: str, angle: float, made: Made) -> None:
    """At the height of half the edge the cavity is as far round the tip as at any angle, and the
    silicone below the edge is what the mould leaves there."""
    out, design = made(preset, angle)
    mould = solids.read_mesh(out / "mould/receiver_mould.stl")
    mould = solids.moved(mould, mould_bed_to_sensor(design.stack, design.mould))
    z = design.stack.face_z_mm - design.printing.line_mm / 2
    wall, tip = solids.section(mould, z), solids.section(part(out, design, "receiver"), z)
    assert not tip.intersects(wall)
    half = design.outline.tip_width_mm / 2 - 1.0
    edge = shapely.box(-half, design.outline.tip_y_mm - 0.5, half, 1e3)
    gap = shapely.distance(tip.intersection(edge), wall)
    assert GAP_MM[0] <= gap <= GAP_MM[1]


@pytest.mark.parametrize("preset", PRESETS)
def test_the_cavity_is_the_same_at_every_angle(preset: str, made: Made) -> None:
    """But for the triangles of a wall that is higher where silicone wraps the tip."""
    first, *others = [cavity(*made(preset, angle)) for angle in ANGLES]
    for other in others:
        for one, same in zip(first, other, strict=True):
            assert one.area > 50
            assert one.symmetric_difference(same).area < 1e-3 * one.length


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("angle", ANGLES)
def test_the_flap_at_the_tip_is_as_long_as_what_it_lies_on(
    preset: str, angle: float, made: Made
) -> None:
    """Round the edge, over the whole wedge and onto the back, and no farther than the coupling."""
    out, design = made(preset, angle)
    flap = tip_flap(out, design, "receiver")
    measured, edge, run = wedge(out, design, "receiver")
    side = edge + design.mould.tip_silicone_mm
    on_back = flap.length_mm + design.mask.allowance_mm - side
    sloped = run / np.cos(np.radians(measured))
    assert on_back > sloped, "the flap ends on the wedge"
    ends_y = design.outline.tip_y_mm - run - (on_back - sloped)
    mount, stack = design.mount, design.stack
    coupling_y = mount.ramp_end_y_mm(stack.back_z_mm, stack.rim_z_mm) + mount.flare_mm
    held = [coupling_y, *(i.box.y_max_mm for i in design.interfaces)]
    assert ends_y > max(held) + (0.0 if design.interfaces else FILLETS_MM)


@pytest.mark.parametrize(("angle", "other"), [(10, 12), (30, 28), (0, 3)])
def test_a_backing_of_another_angle_fails(angle: float, other: float, made: Made) -> None:
    _, design = made("published", angle, makers=())
    out, _ = made("published", other, makers=(backing,))
    failed = {m.check for m in backing_checks.measure(out, design) if not m.passed}
    assert "backing.slant" in failed


def test_a_thin_edge_at_a_small_angle_makes_all_parts_longer(made: Made) -> None:
    """Outline, pocket, mould and mask follow, for the wedge is to end before the pocket."""
    usual, (out, design) = made("published", 10)[1], made("published", 10, "edge_mm = 0.45")
    assert failures(out, design) == []
    measured, edge, run = wedge(out, design, "receiver")
    assert measured == pytest.approx(10, abs=0.05)
    assert edge == pytest.approx(0.45, abs=0.01)
    assert run == pytest.approx((design.stack.plate_mm - 0.45) / np.tan(np.radians(10)), abs=0.1)
    assert design.outline.length_mm > usual.outline.length_mm + 4
    assert design.board.pocket.y_max_mm <= design.outline.tip_y_mm - run + STEP_MM
