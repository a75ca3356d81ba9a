"""The drawings of the manual's steps show the design: cuts to scale, each flap, each wire."""

import io
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as XmlTree

import numpy as np
import pytest
import shapely
import trimesh

from lumitip_fab.design import Box, Design, Finger, Insert
from lumitip_fab.design.cabling import COLOURS, codes_of
from lumitip_fab.design.encoding import read_design
from lumitip_fab.design.frames import mould_bed_to_sensor
from lumitip_fab.docs.casting import casting_steps
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.casting_page import Cast
from lumitip_fab.scenes.casting_views import filled_view
from lumitip_fab.scenes.clamped_view import clamped_view
from lumitip_fab.scenes.finger_views import cable_view
from lumitip_fab.scenes.system import finger_group
from lumitip_fab.scenes.work import bare_spot
from work_drawings import SVG, drawn, published_and, words


@pytest.fixture(params=published_and("flex", "dense", "integrated"))
def folder(request: pytest.FixtureRequest, built: Callable[[str], Path]) -> Path:
    return built(request.param)


def area_mm2(root: XmlTree.Element, group: str) -> float:
    """Area of a group's filled paths in the cut itself."""
    scale = float(root.attrib["data-scale"])
    paths = root.find(f"{SVG}g[@id='{group}']")
    assert paths is not None
    total = shapely.Polygon()
    for ring in re.findall(r"M([^MZ]*)Z", "".join(p.attrib["d"] for p in paths)):
        points = [tuple(map(float, pair.split(","))) for pair in ring.split("L")]
        total = shapely.symmetric_difference(total, shapely.Polygon(points))
    return float(total.area) / scale**2


def written(folder: Path, path: str) -> trimesh.Trimesh:
    return trimesh.load(io.BytesIO((folder / path).read_bytes()), file_type="stl")


def sliced_mm2(mesh: trimesh.Trimesh) -> float:
    """Area of a cut near x = 0, by trimesh's own slicing."""
    section = mesh.section([1.0, 0.0, 0.0], [0.02, 0.0, 0.0])
    return float(section.to_2D()[0].area)


def test_the_cut_mould_is_to_scale_and_full_to_its_rim(folder: Path) -> None:
    design, root = read_design(folder / "design.json"), drawn(folder, "filled")
    mould = written(folder, "mould/emitter_mould.stl")
    assert area_mm2(root, "mould") == pytest.approx(sliced_mm2(mould), rel=0.01)
    length_mm = design.outline.tip_y_mm - design.outline.end_y_mm
    below = length_mm * design.stack.cover_mm
    raised = design.mould.level_mm(design.outline.tip_y_mm) * length_mm / 2
    over = area_mm2(root, "silicone") - below - raised
    low, high = (-0.3, 0.1) if design.props else (-0.1, 1.3)
    assert low * length_mm - 0.1 * below < over < high * length_mm


def test_a_tilted_mould_lies_on_its_prop(folder: Path) -> None:
    design, root = read_design(folder / "design.json"), drawn(folder, "filled")
    for prop in design.props:
        mm2 = prop.plate.length_mm * prop.height_mm + prop.stop.length_mm * prop.stop_mm
        assert area_mm2(root, "clamp") == pytest.approx(mm2, rel=0.02)
    assert ("Prop" in words(root)) == bool(design.props)


@pytest.mark.parametrize("name", ["lowered", "lifted", "clamped"])
def test_a_mould_stands_on_its_prop_with_the_wires_over_its_weir(folder: Path, name: str) -> None:
    design, root = read_design(folder / "design.json"), drawn(folder, name)
    groups = [g.attrib["id"] for g in root.iter(f"{SVG}g")]
    props = groups.count("prop") if name == "clamped" else groups.count("clamp")
    drawings = 2 if name == "clamped" else 1
    assert props == drawings * len(design.props)
    wires = [p for p in root.findall(f"{SVG}path") if p.attrib.get("stroke-width") == ".8"]
    colours = [COLOURS[code][1] for c in pads(design, "emitter") for code in codes_of(c)]
    assert [path.attrib["stroke"] for path in wires] == colours * drawings


def test_screws_and_nuts_are_on_rails_and_clamp(folder: Path) -> None:
    design, root = read_design(folder / "design.json"), drawn(folder, "clamped")
    groups = [g.attrib["id"] for g in root.iter(f"{SVG}g")]
    for clamp in design.clamps:
        ends = clamp.screw_length_mm > clamp.top_mm + clamp.screw.nut_height_mm
        assert groups.count("screw") == 2 * len(clamp.screws) * (3 + ends)
    assert ("screw" in groups) == bool(design.clamps)


def test_the_mould_from_above_names_its_stops_and_where_silicone_is(folder: Path) -> None:
    design, root = read_design(folder / "design.json"), drawn(folder, "mould")
    plate = shapely.Polygon(design.outline.polygon())
    pads_mm2 = sum(
        (design.outline.half_width_at(y) - abs(x) + design.mould.pad_mm) * design.mould.pad_mm
        for x, y in design.mould.pads
    )
    under = area_mm2(root, "silicone")
    assert plate.area - 1.2 * pads_mm2 - 30 < under < plate.area - 0.8 * pads_mm2
    named = words(root)
    assert {"Tip line", "Pad", "Gap", "Weir", "Trough", "Pour", "Plate", "Board"} <= named
    assert ("Rail" in named) == bool(design.clamps)
    (dashed,) = root.findall(f"{SVG}g[@id='dashed']/{SVG}path")
    assert dashed.attrib["d"].count("M") == 2


def test_boards_face_each_other_with_all_their_parts(folder: Path) -> None:
    design, root = read_design(folder / "design.json"), drawn(folder, "facing")
    parts = [p for finger in design.fingers for p in finger.parts if p.side == "front"]
    white = [p for p in root.iter(f"{SVG}path") if p.attrib.get("fill") == "#fff"]
    assert len(white) == len(parts)
    wires = [p for p in root.findall(f"{SVG}path") if p.attrib.get("stroke-width") == ".8"]
    colours = [*pads(design), *pads(design, "emitter")]
    assert [w.attrib["stroke"] for w in wires] == [
        COLOURS[code][1] for colour in colours for code in codes_of(colour)
    ]


def test_the_drop_is_where_the_glue_is(folder: Path) -> None:
    design = read_design(folder / "design.json")
    x, y = bare_spot(design)
    pocket = design.board.pocket
    if design.stack.sunk:
        assert x == design.board.box.x_max_mm < design.outline.half_width_at(y)
    else:
        assert pocket.x_max_mm < x < design.outline.half_width_at(y)
    taken = [key.at for key in design.keys] + list(design.mould.pads)
    assert min(np.hypot(x - a, y - b) for a, b in taken) > 2.5
    assert "Drop" in {text.text for text in drawn(folder, "drop").iter(f"{SVG}text")}


def test_the_finger_goes_in_and_comes_out_as_it_is(folder: Path) -> None:
    """Turned, but neither cut anew nor stretched."""
    down, up = drawn(folder, "lowered"), drawn(folder, "lifted")
    for layer in ("backing", "board"):
        assert area_mm2(down, layer) == pytest.approx(area_mm2(up, layer), rel=0.01, abs=0.3)
    full, left = area_mm2(drawn(folder, "filled"), "silicone"), area_mm2(down, "silicone")
    assert left < full


@pytest.mark.parametrize("finger", ["emitter", "receiver"])
def test_each_flap_on_the_back_has_its_number(finger: str, folder: Path) -> None:
    note = (folder / f"mask/{finger}_wrapping.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d+) \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$", note, re.MULTILINE)
    numbers = [number for number, _, _, reach in rows if float(reach) > 0.0]
    shown = [text.text for text in drawn(folder, f"{finger}_folded").iter(f"{SVG}text")]
    assert shown == numbers
    dashed = [p for p in drawn(folder, f"{finger}_folded").iter() if "stroke-dasharray" in p.attrib]
    assert len(dashed) == len(read_design(folder / "design.json").props), "the lip of silicone"


def test_each_wire_has_its_colour_in_the_order_of_the_pads(folder: Path) -> None:
    design = read_design(folder / "design.json")
    inks = [path.attrib["stroke"] for path in drawn(folder, "cable").findall(f"{SVG}path")]
    wires = [ink for ink in inks if ink in {ink for _, ink in COLOURS.values()}]
    wanted = [COLOURS[code][1] for colour in pads(design) for code in codes_of(colour)]
    assert wires == wanted * 2  # behind the block, and before it


def pads(design: Design, board: str = "receiver") -> list[str]:
    ends = [
        (end.order, wire.colour)
        for cable in design.cabling.cables
        for wire in cable.wires
        for end in (wire.start, wire.end)
        if end.board == board
    ]
    return [colour for _, colour in sorted(ends)]


def test_the_board_hangs_over_its_holes(folder: Path) -> None:
    design, root = read_design(folder / "design.json"), drawn(folder, "board")
    dashed = [p for p in root.findall(f"{SVG}path") if "stroke-dasharray" in p.attrib]
    assert sum(p.attrib["d"].count("M") for p in dashed) == len(design.emitter.holes)


def test_the_clamp_is_drawn_where_there_is_one(folder: Path) -> None:
    design, root = read_design(folder / "design.json"), drawn(folder, "clamped")
    groups = [g.attrib["id"] for g in root.iter(f"{SVG}g")]
    assert ("clamp" in groups) == bool(design.clamps)


def test_marks_of_leg_and_mould_are_enlarged_in_one_line(folder: Path) -> None:
    design, root = read_design(folder / "design.json"), drawn(folder, "clamped")
    details = root.findall(f"{SVG}g[@id='detail']")
    assert len(details) == len(design.clamps)
    for detail in details:
        circle, *lines = (_lines(path) for path in detail.iter(f"{SVG}path"))
        middle = (circle[0][:, 0].min() + circle[0][:, 0].max()) / 2
        sides: dict[bool, list[float]] = {True: [], False: []}
        for line in (line for path in lines for line in path):
            (x0, y0), (x1, y1) = line[np.argmin(line[:, 0])], line[np.argmax(line[:, 0])]
            right = x0 > middle - 1.0
            if x1 - x0 > 5.0 and abs(y1 - y0) < 0.1 * (x1 - x0) and (right or x1 < middle + 1.0):
                sides[right].append(y0 + (y1 - y0) / (x1 - x0) * (middle - x0))
        marks = sorted(sides[True])[:3]
        assert len(marks) == 3 and marks[2] - marks[0] > 4.0
        assert all(min(abs(y - other) for other in sides[False]) < 0.5 for y in marks)


def _lines(path: XmlTree.Element) -> list[np.ndarray]:
    """Lines of a path, shape `(n, 2)` each."""
    return [
        np.array([tuple(map(float, pair.split(","))) for pair in line.split("L")])
        for line in re.findall(r"M([^MZ]*)", path.attrib["d"])
    ]


def bodies(folder: Path, finger: Finger) -> dict[str, Mesh]:
    scene = trimesh.load(folder / "assembly/assembly.glb")
    group = finger_group(scene, finger, np.eye(4))
    return {body.name.rpartition(".")[2]: body.mesh for body in group.bodies}


def test_without_lugs_the_wires_go_straight_on(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    seen, colours = bodies(outputs, design.receiver), pads(design)
    mounts = (design.mount, replace(design.mount, lugs=()))
    tied, free = (
        cable_view(design.receiver, seen, colours, mount, design.stack) for mount in mounts
    )
    assert ["Cable lug" in tied, "Cable lug" in free] == [True, False]
    assert tied.count('stroke-width=".8"') == free.count('stroke-width=".8"') >= 18


@pytest.mark.slow
def test_without_a_clamp_step_and_drawing_name_none(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    bare = replace(design, clamps=())
    titles = [[step.title for step in casting_steps(d, d.fingers)] for d in (design, bare)]
    dry = [
        next(s.text for s in casting_steps(d, d.fingers) if s.title == "Try the mould")
        for d in (design, bare)
    ]
    assert ["four feet" in text for text in dry] == [True, False]
    assert [("Clamp it, and wait" in t, "Tape it down, and wait" in t) for t in titles] == [
        (True, False),
        (False, True),
    ]
    drawing = clamped_view(cast(outputs, bare), None, None)
    assert 'id="clamp"' not in drawing and "Nut" not in drawing
    assert 'id="mould"' in drawing


def test_a_film_lies_on_the_floor_below_the_stops(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    film = Insert("insert", "film", 0.2, Box(-18, 18, -15, 15), 0.3)
    mould = replace(design.mould, inserts=(film,))
    assert mould.stops_mm(1.5) == design.mould.stops_mm(1.5) + 0.2
    laid = Box(-15, 15, mould.wall_mm, mould.floor_mm)
    root = XmlTree.fromstring(filled_view(replace(cast(outputs, design), films=(laid,))))
    assert area_mm2(root, "film") == pytest.approx(30 * 0.2, rel=0.05)


def cast(folder: Path, design: Design) -> Cast:
    surface = written(folder, "mould/emitter_mould.stl")
    mould = Mesh(np.asarray(surface.vertices), np.asarray(surface.faces))
    to_bed = np.linalg.inv(mould_bed_to_sensor(design.stack, design.mould))
    layers = {n: m.moved(to_bed) for n, m in bodies(folder, design.emitter).items()}
    rim_mm = design.mould.stops_mm(design.stack.cover_mm)
    return Cast(mould, layers, rim_mm, -design.outline.tip_y_mm, ())
