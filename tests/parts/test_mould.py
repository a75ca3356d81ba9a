"""The mould's solids, note and files."""

import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely
import trimesh

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.making.mould import whole_layers
from lumitip_fab.design import Box, Design, Insert, Mould
from lumitip_fab.design.encoding import read_design
from lumitip_fab.design.making import FOOT_CHAMFER_MM, LEDGE_MM
from lumitip_fab.docs import casting
from lumitip_fab.parts import export, mould, skin

pytestmark = pytest.mark.slow

PRESETS = ("published", "asymmetric", "dense")


@pytest.fixture(scope="module")
def design(design_dir: Path) -> Design:
    return derive(load(design_dir / "presets" / "published.toml"))


def test_the_same_design_gives_the_same_files_in_any_process(outputs: Path) -> None:
    built = read_design(outputs / "design.json")
    made = mould.mould_files(built, built.receiver)
    assert {a.path for a in made} == {
        "mould/receiver_mould.step",
        "mould/receiver_mould.stl",
        "mould/receiver_mould.3mf",
    }
    for artefact in made:
        assert artefact.data == (outputs / artefact.path).read_bytes(), artefact.path


@pytest.mark.parametrize("preset", PRESETS)
def test_the_mould_is_one_piece_round_the_finger(preset: str, built: Callable[[str], Path]) -> None:
    folder = built(preset)
    shape = read_design(folder / "design.json")
    mesh = trimesh.load(folder / "mould/emitter_mould.stl", force="mesh")
    assert mesh.is_watertight
    assert mesh.body_count == 1
    wide = np.ptp(shape.outline.polygon()[:, 0])
    (clamp,) = shape.clamps
    assert mesh.extents[0] == pytest.approx(2 * clamp.rails[1].x_max_mm, abs=1e-4)
    (low, _, _), (high, _, _) = mesh.slice_plane((0, 0, clamp.rail_mm + 0.1), (0, 0, 1)).bounds
    assert wide + 2 * shape.mould.wall_mm < high - low < wide + 2 * shape.mould.wall_mm + 1
    assert mesh.bounds[0, 2] == pytest.approx(0.0, abs=1e-6)
    assert mesh.extents[2] == pytest.approx(
        shape.mould.wall_mm + shape.stack.silicone_mm + shape.stack.pcb_mm
    )


def test_the_wall_ends_and_the_trough_begins_where_the_design_has_them(
    outputs: Path,
) -> None:
    shape = read_design(outputs / "design.json")
    cast, outline = shape.mould, shape.outline
    ends_mm = outline.end_y_mm - cast.outside_mm - LEDGE_MM
    assert cast.weir_y_mm == pytest.approx(ends_mm, abs=1e-6)
    assert [prop.weir_y_mm for prop in shape.props] == [cast.weir_y_mm]
    mesh = trimesh.load(outputs / "mould/receiver_mould.stl", force="mesh")
    rim = cast.stops_mm(shape.stack.cover_mm)
    # The weir is level with the rim plane up to its edge; beyond it is the slope of the trough.
    ys = [-cast.weir_y_mm - 0.02, -cast.weir_y_mm + 0.02]
    down = trimesh.ray.ray_triangle.RayMeshIntersector(mesh)
    above = [(1.0, y, mesh.bounds[1, 2] + 1) for y in ys]
    places, rays, _ = down.intersects_location(above, [(0, 0, -1)] * 2, multiple_hits=False)
    heights = dict(zip(rays.tolist(), places[:, 2].tolist(), strict=True))
    assert heights[0] == pytest.approx(rim, abs=1e-4) and heights[1] < rim - 0.05
    wall = mesh.slice_plane((0, 0, rim + 0.3), (0, 0, 1)).bounds[0, 1]
    assert wall == pytest.approx(-(outline.tip_y_mm + cast.outside_mm), abs=1e-3)


def test_offset_wires_keep_their_distance(design: Design) -> None:
    shapely = pytest.importorskip("shapely")
    inner = shapely.Polygon(design.outline.polygon(400)).exterior
    for by_mm in (-0.4, 0.15, 2.6):
        wire = skin.offset_wire(design.outline, by_mm, 0.0)
        points = [wire.position_at(t) for t in np.linspace(0, 1, 150)]
        apart = [inner.distance(shapely.Point(p.X, p.Y)) for p in points]
        assert max(abs(d - abs(by_mm)) for d in apart) < 0.001


def test_the_silicone_tapers_and_keeps_its_thickness(design: Design) -> None:
    body = skin.silicone_solid(design.stack, design.outline, design.board, design.mould, [])
    box = body.bounding_box()
    heights = [tuple(box.min)[2], tuple(box.max)[2]]
    assert heights == pytest.approx([-1.6, -0.1], abs=1e-6)
    for y_mm, z_mm in ((0.0, -0.11), (21.84, -1.42), (20.35, -0.76), (-32.3, -0.4)):
        assert body.is_inside((5.5, y_mm, z_mm)), (y_mm, z_mm)
    for y_mm, z_mm in ((0.0, -0.09), (21.84, -1.38), (20.35, -0.74), (-32.8, -0.4)):
        assert not body.is_inside((5.5, y_mm, z_mm)), (y_mm, z_mm)


def test_stops_leave_their_hollow_in_the_silicone(design: Design) -> None:
    body = skin.silicone_solid(design.stack, design.outline, design.board, design.mould, [])
    for x, y in design.mould.pads:
        assert not body.is_inside((x, y, -0.8))
    assert not body.is_inside((0.0, design.outline.tip_y_mm - 0.1, -1.5))


def test_the_film_lies_on_the_silicone(design: Design) -> None:
    film = skin.film_solid(design.stack, design.outline, design.mould)
    assert tuple(film.bounding_box().max)[2] == pytest.approx(0.0, abs=1e-6)
    assert film.is_inside((0.0, 0.0, -0.05))
    assert not film.is_inside((0.0, 0.0, -0.11))


def noted(design: Design, of: Mould) -> str:
    design = replace(design, mould=of)
    return casting.casting_note(design, design.emitter, casting.silicone_mix(4.0, of))


def test_the_note_says_primer_tape_test_and_the_order_of_demoulding(design: Design) -> None:
    note = " ".join(noted(design, design.mould).split())
    assert "a thin film of silicone primer DOWSIL PR-1200" in note
    assert "with polyimide tape 12 mm" in note and "masking tape" in note
    assert "Let it harden for 24 h" in note
    steps = [
        "Put a drop",
        "Leave it for 24 h",
        "Lift the gripper end first",
        "The tip edge comes last",
    ]
    assert sorted(steps, key=note.index) == steps
    closed = replace(design, emitter=replace(design.emitter, reliefs=()))
    assert "Close every window" in note
    assert "Close every window" not in noted(closed, design.mould)
    bare = noted(design, replace(design.mould, primer="", primer_dry_min=0.0))
    assert "Brush a thin film" in note and "Brush a thin film" not in bare


def test_the_note_says_how_a_smooth_film_is_cut_laid_and_peeled(design: Design) -> None:
    bare = noted(design, design.mould)
    assert "film" not in bare.replace("thin film", "") and "recess" not in bare
    box = Box(-19.04, 19.04, -15.45, 15.45)
    film = Insert("insert", "PET transparency 100 µm", 0.1, box, 0.3)
    note = " ".join(noted(design, replace(design.mould, inserts=(film,))).split())
    assert "The floor at 2.5 mm, the recess in it at 2.4 mm and the stops at 4 mm" in note
    steps = ["38.08 x 30.90 mm", "Keep primer away", "Lay the film into its recess"]
    steps += ["Pour in all that runs", "Cut the flash", "Peel it off the skin"]
    assert sorted(steps, key=note.index) == steps


def test_the_note_of_a_tilted_mould_tells_of_its_prop(design: Design) -> None:
    tilted = " ".join(noted(design, design.mould).split())
    level = " ".join(noted(design, replace(design.mould, props=())).split())
    for words, in_tilted in (
        ("`mould/prop.3mf`", True),
        ("Pour in all that runs", True),
        ("Leave it on round the tip, 2 mm from the edge", True),
        ("on its prop", True),
        ("Fill it from one corner of the tip up to the weir", False),
    ):
        assert (words in tilted, words in level) == (in_tilted, not in_tilted), words


def test_the_note_weighs_both_parts(design: Design) -> None:
    mixed = replace(design.mould, mix_ratio=(10.0, 1.0), density_g_ml=1.1, waste_fraction=0.5)
    note = noted(design, mixed)
    masses = [float(m) for m in re.findall(r"\*\*([0-9.]+) g\*\*", note)]
    assert masses == pytest.approx([6.0, 0.6])
    assert "6.00 mL" in note


@pytest.mark.parametrize(
    ("usual", "heights", "wanted"),
    [
        (0.2, (2.4, 3.9), (0.15, 0)),
        (0.2, (2.4, 4.0), (0.2, 0)),
        (0.3, (2.0, 3.5), (0.25, 0)),
        (0.2, (2.411, 3.907), (0.2, 0.093)),
        (0.125, (2.5, 4.0), (0.125, 0)),
        (0.075, (2.4, 4.0), (0.05, 0)),
        (0.04, (2.4, 4.1), (0.04, 0.02)),
    ],
)
def test_layers_divide_the_heights_that_count(
    usual: float, heights: tuple[float, float], wanted: tuple[float, float]
) -> None:
    assert whole_layers(usual, heights) == pytest.approx(wanted)


def test_layers_divide_the_recess_where_they_cannot_divide_all() -> None:
    assert whole_layers(0.2, (2.4, 2.5, 4.0), 0.1) == pytest.approx((0.1, 0.0))
    assert whole_layers(0.2, (2.411, 2.511, 4.007), 0.1) == pytest.approx((0.1, 0.011))
    assert whole_layers(0.2, (2.4, 2.533, 4.0), 0.133) == pytest.approx((0.05, 0.017))


def test_the_note_says_what_the_slicer_rounds(design: Design) -> None:
    rounded = replace(design.mould, layer_mm=0.2, off_layer_mm=0.093)
    whole, told = (" ".join(noted(design, m).split()) for m in (design.mould, rounded))
    assert "in layers of 0.15 mm. The floor at 2.4 mm and the stops at 3.9 mm" in whole
    assert "are then whole layers" not in told
    assert "by 0.09 mm" in told


def test_each_finger_s_mould_has_its_letter(design: Design) -> None:
    """The letters take the same wall, and nothing else differs."""
    one, other = (
        mould.mould_solid(f, design.stack, design.outline, design.mould, design.clamps)
        for f in design.fingers
    )
    letter = design.mould.letter
    stroke = letter.box.width_mm * letter.box.length_mm * letter.depth_mm
    for left, right in ((one, other), (other, one)):
        apart = left - right
        box = apart.bounding_box()
        assert 0.05 * stroke < apart.volume < 0.5 * stroke
        assert pytest.approx(letter.depth_mm) == box.max.Y - box.min.Y


def test_no_triangle_leaves_the_curved_wall(design_dir: Path, tmp_path: Path) -> None:
    """Middles of the edges of the wall's triangles are as far from the outline as the wall is."""
    file = Path(shutil.copytree(design_dir, tmp_path / "design")) / "mine.toml"
    lines = "[grid]\npitch_mm = 7\ncolumns = [6, 5, 6, 5, 6]\n"
    file.write_text(f'extends = "fingertip.toml"\n{lines}', encoding="utf-8")
    design = derive(load(file))
    stack, made = design.stack, design.mould
    solid = mould.mould_solid(design.receiver, stack, design.outline, made, design.clamps)
    surface = export.mesh(solid, mould.CHORD_MM)
    corners = surface.points_mm[surface.triangles]
    middles = (corners + np.roll(corners, 1, axis=1)) / 2
    plate = shapely.Polygon(design.outline.polygon(512))
    off_mm = shapely.distance(plate, shapely.points(middles[..., :2])) - made.outside_mm
    low = stack.silicone_z_mm + made.floor_mm - FOOT_CHAMFER_MM - 0.1
    wall = (middles[..., 2] < low) & (np.abs(off_mm) < made.wall_mm / 4)
    at_tip = wall & (middles[..., 1] > design.outline.tip_y_mm - 6)
    assert at_tip.sum() > 100
    assert np.abs(off_mm[at_tip]).max() < 2 * mould.CHORD_MM
