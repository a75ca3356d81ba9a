"""The drawing of the flange's parts in the manual."""

from collections import Counter
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as XmlTree

import pytest

from lumitip_fab.design.cabling import front_headers
from lumitip_fab.design.encoding import read_design

SVG = "{http://www.w3.org/2000/svg}"


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["published", "integrated"])
def test_each_part_of_the_flange_is_drawn_and_named(
    built: Callable[[str], Path], preset: str
) -> None:
    design = read_design(built(preset) / "design.json")
    (flange,) = design.flanges
    board = next(b for b in design.auxiliary_boards if b.name == flange.auxiliary)
    root = XmlTree.parse(built(preset) / "manual/flange.svg").getroot()
    drawn = Counter(group.attrib["id"] for group in root.iter(f"{SVG}g"))
    assert (drawn["lower"], drawn["board"], drawn["upper"], drawn["coupling"]) == (1, 1, 1, 1)
    assert (drawn["pin"], drawn["nut"]) == (1, len(flange.screws))
    assert (drawn["screw"], drawn["bolt"]) == (2 * len(flange.screws), 2 * len(flange.bolts))
    assert drawn["contacts"] >= 1 and drawn["part"] > 3
    words = {text.text for text in root.iter(f"{SVG}text")}
    assert {"Locating pin", "Peg", "Screws", "Nuts", "Flange bolts"} <= words
    assert {part.ref for part in front_headers(board)} <= words
    assert f"{flange.pin_mm:g} x {flange.pin_length_mm:g}, glued into the lower part" in words
    assert f"{len(flange.bolts)} x {flange.bolt}, through gripper and flange" in words


@pytest.mark.slow
def test_a_design_without_a_flange_has_no_drawing_of_it(built: Callable[[str], Path]) -> None:
    assert not (built("wsg50") / "manual/flange.svg").exists()
