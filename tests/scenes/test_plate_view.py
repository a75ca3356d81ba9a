"""The drawing of the fit test plate in the manual."""

from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as XmlTree

import pytest

from lumitip_fab.design.encoding import read_design

SVG = "{http://www.w3.org/2000/svg}"
BOLD = "bold"


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["published", "flex"])
def test_each_coupon_has_its_value_and_what_is_tried_has_a_name(
    built: Callable[[str], Path], preset: str
) -> None:
    plate = read_design(built(preset) / "design.json").fit_plate
    root = XmlTree.parse(built(preset) / "manual/plate.svg").getroot()
    words = [(float(e.attrib["x"]), e.text, e.attrib) for e in root.iter(f"{SVG}text")]
    values = [
        text for _, text, look in sorted(words, key=lambda w: w[0]) if "middle" in look.values()
    ]
    assert values == [plate.label_of(step) for step in range(len(plate.steps))]
    names = {text for _, text, look in words if look.get("font-weight") == BOLD}
    assert names == {"Value", "Slice"} | ({"Corner"} if plate.corners else set())
