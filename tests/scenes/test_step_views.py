"""Drawings of steps that measure, cut and compare: they show this design's own figures."""

import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as XmlTree

import numpy as np
import pytest
import shapely

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.cabling import COLOURS, STRIP_MM, codes_of
from lumitip_fab.design.encoding import read_design
from lumitip_fab.scenes.coupling_view import SCALE as COUPLING_SCALE
from lumitip_fab.scenes.holder_view import _loops
from lumitip_fab.scenes.marks_view import MARK, PROBES, marks_view
from work_drawings import SVG, drawn, published_and, words


@pytest.fixture(params=published_and("flex", "wsg50", "robotiq_2f140"))
def folder(request: pytest.FixtureRequest, built: Callable[[str], Path]) -> Path:
    return built(request.param)


@pytest.fixture(scope="module")
def published() -> Design:
    return derive(load(Path(__file__).parents[2] / "design/presets/published.toml"))


def read(folder: Path, name: str) -> tuple[Design, XmlTree.Element]:
    """The design, and a drawing of it."""
    return read_design(folder / "design.json"), drawn(folder, name)


def points(path: XmlTree.Element) -> np.ndarray:
    """Corners of a path with y up, shape `(n, 2)`."""
    pairs = re.findall(r"(-?[\d.]+),(-?[\d.]+)", path.attrib["d"])
    return np.array([(float(x), -float(y)) for x, y in pairs])


def group(root: XmlTree.Element, name: str) -> list[XmlTree.Element]:
    found = root.find(f"{SVG}g[@id='{name}']")
    assert found is not None, name
    return list(found)


def test_the_foot_names_what_the_step_asks_for_and_nothing_else(folder: Path) -> None:
    design, root = read(folder, "measured")
    html = (folder / "manual/manual.html").read_text(encoding="utf-8")
    _, _, later = html.partition("Measure your gripper</h2>")
    step = later.partition("<h2>")[0]
    table = set(re.findall(r"<td><code>([\w.]+)</code></td>", step))
    asked = {figure.name for figure in design.mount.unsure} & table
    needed = set(re.findall(r"(?<=<td>)\w+_mm(?=, plus)", step))
    figures = {name for name in words(root) if name.endswith(("_mm", "_deg")) or name == "bolt"}
    assert figures == asked | needed | {"bolt"}
    into_mm = design.mount.bolt_length_mm - design.mount.land_mm
    assert f"{design.mount.bolt}, {into_mm:.1f} mm into it" in words(root)


def test_the_foot_is_to_scale(folder: Path) -> None:
    design, root = read(folder, "measured")
    tips = [points(p)[0] for p in root.iter(f"{SVG}path") if p.attrib.get("fill") == "#1a1a1a"]
    ends = list(zip(tips[::2], tips[1::2], strict=True))
    lengths = [math.dist(*pair) / COUPLING_SCALE for pair in ends]
    mount = design.mount
    into_mm = mount.bolt_length_mm - mount.land_mm
    for length in (into_mm, mount.seat_back_w_mm):
        assert min(abs(length - other) for other in lengths) < 0.01


def test_wires_are_as_long_and_as_coloured_as_they_are_cut(folder: Path) -> None:
    design, root = read(folder, "lengths")
    scale = float(root.attrib["data-scale"])
    for cable in design.cabling.cables:
        cores = [p for p in group(root, cable.name) if p.attrib.get("stroke-width") == ".8"]
        ink = [COLOURS[code][1] for wire in cable.wires for code in codes_of(wire.colour)]
        assert [core.attrib["stroke"] for core in cores] == ink
        for core in cores:
            assert np.ptp(points(core)[:, 0]) / scale == pytest.approx(cable.length_mm, abs=0.1)
    assert f"{STRIP_MM:g} mm" in words(root)


def test_the_picture_is_dark_where_the_card_is(folder: Path) -> None:
    design, root = read(folder, "card")
    cells = np.array(design.receiver.cells)
    circles = group(root, "picture")
    centres = np.array([points(circle)[:-1].mean(axis=0) for circle in circles])
    moved = centres - centres.mean(axis=0)
    scale = float(root.attrib["data-scale"])
    assert moved == pytest.approx(scale * (cells - cells.mean(axis=0)), abs=0.05)
    (card,) = group(root, "card")
    corners = points(card)
    lightness = {}
    for cell, circle in zip(cells, circles, strict=True):
        fill = circle.attrib["fill"]
        lightness[tuple(cell)] = sum(int(fill[k : k + 2], 16) for k in (1, 3, 5))
    edges = np.roll(corners, -1, axis=0) - corners
    edge = int(np.hypot(*edges.T).argmax())
    slope = edges[edge, 1] / edges[edge, 0]
    assert math.degrees(math.atan(slope)) == pytest.approx(
        float(root.attrib["data-angle-deg"]), abs=0.1
    )
    seen = set()
    for (x, y), light in lightness.items():
        over = scale * y - (corners[edge, 1] + slope * (scale * x - corners[edge, 0]))
        if abs(over) > 0.7 * scale * design.layout.pitch_mm:
            assert light > 400 if over > 0 else light < 150
            seen.add(over > 0)
    assert seen == {True, False}


def test_the_gauge_card_is_drawn_where_there_is_one(folder: Path) -> None:
    design = read_design(folder / "design.json")
    html = (folder / "manual/manual.html").read_text(encoding="utf-8")
    assert (folder / "manual/gauge.svg").exists() == bool(design.gauge_cards)
    assert ('data-file="manual/gauge.svg"' in html) == bool(design.gauge_cards)
    if design.gauge_cards:
        _, root = read(folder, "gauge")
        assert {"Stop", "Edge", "Rails"} <= words(root)


def test_a_loop_of_ties_goes_through_both_lugs_behind_the_gripper(folder: Path) -> None:
    design = read_design(folder / "design.json")
    assert (folder / "manual/holder.svg").exists() == bool(design.holders)
    for holder in design.holders:
        _, root = read(folder, "holder")
        ties = [p for p in group(root, "ties") if p.attrib.get("stroke-width") == ".8"]
        assert len(ties) == len(_loops(holder)) == len(holder.arm_lugs) / 2
        for loop in _loops(holder):
            length_mm = np.linalg.norm(np.diff(loop, axis=0), axis=1).sum()
            assert length_mm == pytest.approx(holder.tie_loop_mm, rel=0.05)
            radius = np.hypot(loop[:, 0], loop[:, 1] + holder.axis_z_mm)
            assert radius.min() > holder.body_mm / 2
            for lug in holder.arm_lugs:
                out, up = lug.side * loop[:, 0] - lug.face_mm, loop[:, 2]
                box = lug.opening
                inside = (out > box.x_min_mm) & (out < box.x_max_mm)
                inside &= (up > box.y_min_mm) & (up < box.y_max_mm)
                level = abs(up[0] - box.centre_mm[1]) < 0.1
                assert not level or np.ptp(loop[inside, 1]) >= np.ptp(lug.along_mm)


def test_a_worn_skin_is_cut_round_the_board(folder: Path) -> None:
    design, root = read(folder, "skin")
    scale, box = float(root.attrib["data-scale"]), design.board.box
    (cut,) = group(root, "cut")
    edge = points(cut) / scale
    notch = design.emitter.notch
    over = shapely.LineString(edge) & shapely.box(*notch.grown(-0.1).bounds_mm)
    assert over.is_empty
    assert edge.min(axis=0) == pytest.approx((box.x_min_mm, box.y_min_mm), abs=0.02)
    assert edge.max(axis=0) == pytest.approx((box.x_max_mm, box.y_max_mm), abs=0.02)
    rings = "".join(path.attrib["d"] for path in group(root, "plugs"))
    assert rings.count("M") == len(design.keys)


@pytest.mark.parametrize(("led", "left"), [("cathode", "black"), ("anode", "red")])
@pytest.mark.parametrize(("detector", "light"), [("collector", "red"), ("emitter", "black")])
def test_the_probes_are_where_the_meter_shows_something(
    published: Design, led: str, left: str, detector: str, light: str
) -> None:
    packages = published.packages
    marked = replace(
        packages,
        led=packages.led.model_copy(update={"marked": led}),
        photodetector=packages.photodetector.model_copy(update={"marked": detector}),
    )
    root = XmlTree.fromstring(marks_view(marked))
    for kind, colour in (("LED", left), ("photodetector", light)):
        paths = [p for p in group(root, kind) if "fill" in p.attrib]
        middles = {p.attrib["fill"]: points(p)[:, 0].mean() for p in paths}
        other = next(name for name in PROBES if name != colour)
        assert middles[PROBES[colour]] < middles[MARK] < middles[PROBES[other]]


def test_a_part_whose_mark_is_known_is_not_tested(published: Design) -> None:
    packages = published.packages
    known = packages.led.model_copy(update={"marked_confidence": "measured"})
    root = XmlTree.fromstring(marks_view(replace(packages, led=known)))
    assert [g.attrib["id"] for g in root.iter(f"{SVG}g")] == ["photodetector"]
