"""The drawings of the manual's steps show the design: cuts to scale, each flap, each wire."""

import io
import re
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as XmlTree

import numpy as np
import pytest
import shapely
import trimesh

from lumitip_fab.design import Design
from lumitip_fab.design.cabling import COLOURS, codes_of
from lumitip_fab.design.encoding import read_design
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.cut import cut, rings_of
from lumitip_fab.scenes.drawing import silhouette, view
from lumitip_fab.scenes.system import block, socket

SVG = "{http://www.w3.org/2000/svg}"
PRESETS = [
    "published",
    *(pytest.param(name, marks=pytest.mark.slow) for name in ("flex", "dense", "integrated")),
]


@pytest.fixture(params=PRESETS)
def folder(request: pytest.FixtureRequest, built: Callable[[str], Path]) -> Path:
    return built(request.param)


def drawn(folder: Path, name: str) -> XmlTree.Element:
    return XmlTree.parse(folder / f"manual/{name}.svg").getroot()


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
    assert 0.9 * below < area_mm2(root, "silicone") < below + 1.3 * length_mm


def test_the_finger_goes_in_and_comes_out_as_it_is(folder: Path) -> None:
    """Turned, but neither cut anew nor stretched."""
    down, up = drawn(folder, "lowered"), drawn(folder, "lifted")
    for layer in ("backing", "board"):
        assert area_mm2(down, layer) == pytest.approx(area_mm2(up, layer), rel=0.01, abs=0.3)
    full, left = area_mm2(drawn(folder, "filled"), "silicone"), area_mm2(down, "silicone")
    assert left < full


def test_each_flap_on_the_back_has_its_number(folder: Path) -> None:
    note = (folder / "mask/emitter_wrapping.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d+) \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$", note, re.MULTILINE)
    numbers = [number for number, _, _, reach in rows if float(reach) > 0.0]
    shown = [text.text for text in drawn(folder, "folded").iter(f"{SVG}text")]
    assert shown == numbers


def test_each_wire_has_its_colour_in_the_order_of_the_pads(folder: Path) -> None:
    design = read_design(folder / "design.json")
    inks = [path.attrib["stroke"] for path in drawn(folder, "cable").findall(f"{SVG}path")]
    wires = [ink for ink in inks if ink in {ink for _, ink in COLOURS.values()}]
    wanted = [COLOURS[code][1] for colour in pads(design) for code in codes_of(colour)]
    assert wires == wanted * 2  # behind the block, and before it


def pads(design: Design) -> list[str]:
    ends = [
        (end.order, wire.colour)
        for cable in design.cabling.cables
        for wire in cable.wires
        for end in (wire.start, wire.end)
        if end.board == "receiver"
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


def test_a_cut_keeps_what_is_hollow() -> None:
    whole = block((-5, 5), (0, 8), 0.0, 0.0, 3.0)
    assert cut(whole).area == pytest.approx(24.0)
    assert cut(block((1, 5), (0, 8), 0.0, 0.0, 3.0)).is_empty
    cup = cut(socket(20.0, 16.0, 10.0, 4.0))
    assert cup.area == pytest.approx(20 * 10 - 16 * 4, rel=1e-3)
    inner = block((-2, 2), (2, 6), 0.0, 1.0, 2.0)
    hollow = Mesh(
        np.concatenate([whole.points_mm, inner.points_mm]),
        np.concatenate([whole.triangles, inner.triangles[:, ::-1] + len(whole.points_mm)]),
    )
    area = cut(hollow)
    assert area.area == pytest.approx(24.0 - 4.0)
    assert len(rings_of(area)) == 2


@pytest.mark.parametrize("angles", [(0.0, 0.0), (32.0, 38.0), (35.0, 24.0)])
def test_a_silhouette_is_all_that_the_triangles_cover(
    angles: tuple[float, float], outputs: Path
) -> None:
    surface = written(outputs, "backing/receiver_backing.stl")
    mesh = Mesh(np.asarray(surface.vertices), np.asarray(surface.faces))
    eye = view(*angles)
    triangles = shapely.polygons(eye.seen(mesh.points_mm)[:, :2][mesh.triangles])
    covered = shapely.union_all(triangles[shapely.area(triangles) > 1e-6], grid_size=0.001)
    whole = shapely.Polygon()
    for ring in silhouette(mesh, eye):
        whole = shapely.symmetric_difference(whole, shapely.Polygon(ring))
    assert whole.area == pytest.approx(covered.area, rel=2e-4)
