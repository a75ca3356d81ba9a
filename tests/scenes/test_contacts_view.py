"""The drawing of the coupling's contacts in the manual."""

import dataclasses
import re
from pathlib import Path
from xml.etree import ElementTree as XmlTree

import numpy as np
import pypdfium2
import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Flange
from lumitip_fab.docs.sheet import pdf_sheets
from lumitip_fab.scenes.contacts_view import SCALE, contacts_view

SVG = "{http://www.w3.org/2000/svg}"
PUBLISHED = {  # the published board's nets by place, seen from its front, y up
    ("1", "GND"): (7.62, 1.27),
    ("2", "GND"): (7.62, -1.27),
    ("3", "24V"): (10.16, 1.27),
    ("4", "NC"): (10.16, -1.27),
    ("5", "CASING"): (12.7, 1.27),
    ("6", "Von"): (12.7, -1.27),
    ("7", "485+"): (15.24, 1.27),
    ("8", "485-"): (15.24, -1.27),
    ("9", "3V3_out"): (17.78, 1.27),
    ("10", "485GND"): (17.78, -1.27),
}


@pytest.fixture(scope="module")
def flange() -> Flange:
    file = Path(__file__).parents[2] / "design" / "presets" / "published.toml"
    (found,) = derive(load(file)).flanges
    return found


def _shown(drawing: str) -> dict[tuple[str, str], tuple[float, float]]:
    """Place in mm that the leader of each number and name ends at."""
    root = XmlTree.fromstring(drawing)
    words = [(float(e.attrib["y"]), e.text or "") for e in root.iter(f"{SVG}text")]
    found = {}
    for path in root.iter(f"{SVG}path"):
        points = [
            tuple(map(float, p.split(",")))
            for p in re.findall(r"[-\d.]+,[-\d.]+", path.get("d", ""))
        ]
        if len(points) != 3 or path.get("fill") != "none":
            continue
        number, name = (text for y, text in words if abs(y - 1.2 - points[-1][1]) < 0.02)
        found[number, name] = points[0][0] / SCALE, -points[0][1] / SCALE
    return found


def test_numbers_and_signals_stand_at_the_published_places(flange: Flange) -> None:
    shown = _shown(contacts_view(flange))
    assert shown.keys() == PUBLISHED.keys()
    for key, at in PUBLISHED.items():
        assert shown[key] == pytest.approx(at, abs=0.01)


def test_no_leader_crosses_another(flange: Flange) -> None:
    shapely = pytest.importorskip("shapely")
    root = XmlTree.fromstring(contacts_view(flange))
    lines = [
        shapely.LineString(
            [
                tuple(map(float, p.split(",")))
                for p in re.findall(r"[-\d.]+,[-\d.]+", path.get("d", ""))
            ]
        )
        for path in root.iter(f"{SVG}path")
        if path.get("fill") == "none" and path.get("d", "").count("L") in (1, 2)
    ]
    assert len(lines) == len(flange.contacts) + 1
    apart = [a.distance(b) for i, a in enumerate(lines) for b in lines[i + 1 :]]
    assert min(apart) > 1.0


def test_a_mirrored_map_is_another_drawing(flange: Flange) -> None:
    contacts = tuple(dataclasses.replace(c, at=(c.at[0], -c.at[1])) for c in flange.contacts)
    shown = _shown(contacts_view(dataclasses.replace(flange, contacts=contacts)))
    assert np.sign(shown["3", "24V"][1]) == -1


@pytest.mark.parametrize("words", range(500, 800, 60))
def test_a_page_of_the_manual_shows_it_in_true_size(flange: Flange, words: int) -> None:
    """However full the page is: other drawings shrink where that saves a page."""
    drawing = contacts_view(flange)
    root = XmlTree.fromstring(drawing)
    rows = [float(e.attrib["y"]) for e in root.iter(f"{SVG}text") if e.text == "GND"]
    text = f"# A\n\n## B\n\n![c](a.svg)\n\n{'words ' * words}\n"
    page = pypdfium2.PdfDocument(pdf_sheets("A", text, _Drawing(drawing)))[0].get_textpage()
    letters = page.get_text_range()
    shown = [page.get_charbox(found.start())[1] for found in re.finditer("GND(?!\\w)", letters)]
    shown_mm = (max(shown) - min(shown)) * 25.4 / 72
    assert shown_mm == pytest.approx(max(rows) - min(rows), abs=0.2)


class _Drawing:
    """One file."""

    def __init__(self, text: str) -> None:
        self._text = text

    def read(self, _: str) -> bytes:
        return self._text.encode()
