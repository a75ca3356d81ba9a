"""The page: it needs nothing else, its drawings have true proportions, and no names overlap."""

import math
import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from build123d import Box as Block
from build123d import Location

from lumitip_fab.catalogue.grippers import Gripper
from lumitip_fab.config.load import Input, load
from lumitip_fab.design.frames import mount_to_sensor
from lumitip_fab.grippers.drawing import BODY_MM, body_drawing
from lumitip_fab.grippers.figures import figures, value_of
from lumitip_fab.grippers.page import page
from lumitip_fab.grippers.trial import design_with, example
from lumitip_fab.parts.backing import backing_solid
from lumitip_fab.parts.export import mesh
from lumitip_fab.parts.gauge import gauge_solid
from lumitip_fab.parts.shapes import placed
from lumitip_fab.scenes.coupling_view import SCALE, coupling_view
from lumitip_fab.scenes.dimensions import LETTER_MM, WORDS_MM

Box = tuple[float, float, float, float]
NOT_DRAWN = {"force_n", "supply_a", "envelope.mass_kg", "envelope.payload_kg"}


def gripper_of(name: str, config: Input) -> Gripper:
    return example(config.catalogue) if name == "example" else config.catalogue.grippers[name]


def drawings(name: str, config: Input) -> dict[str, str]:
    gripper = gripper_of(name, config)
    held = design_with(config, name, gripper)
    known = {f.name for f in figures() if value_of(gripper, f.name) is not None}
    coupling = coupling_view(held.mount, mesh(gauge_solid(held)), known)
    return {"coupling": coupling, "body": body_drawing(gripper)}


def names(svg: str) -> Iterator[tuple[str, Box]]:
    """Each name of a drawing with the box round it, on the page with y down."""
    for text in ElementTree.fromstring(svg).iter("{http://www.w3.org/2000/svg}text"):
        words = str(text.text)
        x, y = float(text.attrib["x"]), float(text.attrib["y"])
        wide = LETTER_MM * len(words)
        start = {"start": 0.0, "middle": -wide / 2}[text.attrib["text-anchor"]]
        high = 0.75 * WORDS_MM
        if "rotate(-90" in text.get("transform", ""):
            yield words, (x - high, y - start - wide, x, y - start)
        else:
            yield words, (x + start, y - high, x + start + wide, y)


GRIPPERS = ["example", "robotiq_2f85", "wsg50", "onrobot_rg2", "franka_hand", "two_hole_jaw"]


@pytest.mark.slow_cases
@pytest.mark.parametrize("name", GRIPPERS)
def test_every_figure_is_named_once_and_no_names_overlap(name: str, config: Input) -> None:
    found: list[str] = []
    for svg in drawings(name, config).values():
        boxes = list(names(svg))
        found += [words.partition(" (")[0] for words, _ in boxes]
        for (one, a), (other, b) in combinations(boxes, 2):
            apart = a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1]
            assert apart, f"{one} and {other} overlap"
        left, top, width, height = map(float, re.findall(r'viewBox="(.*?)"', svg)[0].split())
        for words, box in boxes:
            assert left <= box[0] and top <= box[1], words
            assert box[2] <= left + width and box[3] <= top + height, words
    gripper = gripper_of(name, config)
    asked = {f.name for f in figures() if value_of(gripper, f.name) is not None} - NOT_DRAWN
    assert asked <= set(found)
    assert len(found) == len(set(found))


def lengths(svg: str) -> dict[str, float]:
    """How long each dimension is drawn, between the tips of its arrows: arrows come in pairs
    before their names do."""
    tips = [
        tuple(map(float, m))
        for m in re.findall(r'fill="#1a1a1a" fill-rule="evenodd" d="M([-.\d]+),([-.\d]+)L', svg)
    ]
    return {k: math.dist(a, b) for k, (a, b) in enumerate(zip(tips[::2], tips[1::2], strict=True))}


def test_dimensions_are_drawn_to_scale(config: Input) -> None:
    gripper = example(config.catalogue)
    assert gripper.nose
    assert gripper.pins
    assert gripper.bolt_spacing_mm
    assert gripper.seat_back_w_mm
    drawn = drawings("example", config)
    flat = sorted(lengths(drawn["coupling"]).values())
    asked = [
        *(gripper.bolt_spacing_mm, gripper.pins.spacing_mm, gripper.pins.depth_mm),
        *(gripper.nose.front_width_mm, gripper.nose.front_w_mm, gripper.nose.height_mm),
        *(gripper.block_width_mm, gripper.seat_width_mm, gripper.land_mm),
        *(gripper.bolt_w_mm, gripper.block_back_w_mm, gripper.pad_w_mm),
        gripper.seat_back_w_mm,
    ]
    assert flat == pytest.approx(sorted(SCALE * size for size in asked), abs=0.02)
    body = gripper.envelope
    scale = BODY_MM / max(body.reach_mm, body.width_mm)
    sizes = (body.width_mm, body.depth_mm, body.length_mm, body.reach_mm, gripper.stroke_mm)
    whole = sorted(lengths(drawn["body"]).values())
    assert whole == pytest.approx(sorted(scale * size for size in sizes), abs=0.02)


def test_the_page_needs_nothing_else_and_lists_every_figure(config: Input) -> None:
    gripper = config.catalogue.grippers["wsg50"]
    html = page("my_jaw", "my_jaw.toml", gripper, gripper.title, drawings("wsg50", config))
    assert not re.search(r"(src|href)=", html)
    assert html.count("<svg") == html.count("</svg>") == 2
    for figure in figures():
        assert f"<code>{figure.name}</code>" in html
        assert figure.how.split(":")[0].split("'")[0] in html
    assert "<td>21</td>" in html
    assert "Weiss WSG 50" in html


@pytest.mark.slow
@pytest.mark.parametrize("name", ["example", "robotiq_2f85", "wsg50"])
def test_the_gauge_is_the_foot_of_the_printed_finger(name: str, config: Input) -> None:
    d = design_with(config, name, gripper_of(name, config))
    gauge = gauge_solid(d)
    mount = replace(d.mount, lugs=())  # a gauge has none
    finger = backing_solid(d.receiver, d.stack, d.outline, d.tip, d.board, mount, (), ())
    to_mount = np.linalg.inv(mount_to_sensor(d.mount, d.stack))
    high = gauge.bounding_box().max.Z
    behind = Block(100, 40, high).moved(Location((0, 22.7, high / 2)))  # of the plate
    foot = placed(finger, to_mount) & behind
    letter = d.mount.letter
    cut = letter.depth_mm * letter.box.width_mm * (letter.box.y_max_mm - letter.box.y_min_mm)
    assert 0.0 <= gauge.volume - foot.volume <= cut
    assert gauge.volume > 1000
    assert abs(gauge.bounding_box().min.Z) < 1e-6  # it stands on the print bed


@pytest.mark.slow
def test_the_gauge_of_a_compliant_finger_stays_behind_its_plate(
    config: Input, design_dir: Path
) -> None:
    flex = load(design_dir / "presets/flex.toml")
    d = design_with(flex, "my_jaw", config.catalogue.grippers["two_hole_jaw"])
    foot = mesh(gauge_solid(d)).points_mm
    low = foot[foot[:, 2] < 1e-6]
    assert low[:, 1].min() == pytest.approx(d.mount.block_front_w_mm, abs=1e-3)
    assert foot[:, 1].min() > 0
