"""The generated reference: it has every parameter, part, command and public name, and its drawings
are dimensioned as the design is."""

import argparse
import importlib
import json
import re
from dataclasses import replace
from html import unescape
from pathlib import Path

import pytest

from api_pages import packages
from catalogue_pages import FILES, read
from command_pages import PARSERS, commands
from design_drawings import PRESET, drawings
from dimensioned import Drawing
from lumitip_fab.config.load import load
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.derive import resolve
from markdown_pages import ROOT
from parameter_pages import allowed, unit

pytestmark = pytest.mark.slow

SCHEMA = json.loads((ROOT / "design/schema.json").read_text("utf-8"))
ROUNDING_MM = 0.06
"""A board's width is rounded to 0.1 mm."""


def _text(site: Path, page: str) -> str:
    return unescape((site / "reference" / page).read_text("utf-8"))


def _fields() -> set[str]:
    found = set()
    for name, shape in SCHEMA["properties"].items():
        model = SCHEMA["$defs"].get(shape.get("$ref", "").rpartition("/")[2])
        found |= {f"{name}.{field}" for field in model["properties"]} if model else {name}
    return found


def test_the_reference_has_every_parameter(doc_site: Path) -> None:
    text = _text(doc_site, "parameters.html")
    shown = set(re.findall(r'<span id="([^"]+)"></span><code>', text))
    assert shown == _fields()
    assert len(shown) > 140
    assert "Name of a filament in <code>parts/filaments.toml</code>." in text
    assert "Distance of a cell to each of its neighbours (mm)." in text


def test_units_and_ranges_are_those_of_the_schema() -> None:
    pitch = SCHEMA["$defs"]["Grid"]["properties"]["pitch_mm"]
    assert (unit(pitch["title"]), allowed(pitch)) == ("mm", "number (1.5 to 30)")
    either = {"anyOf": [{"const": "auto"}, {"type": "integer", "minimum": 2}]}
    assert allowed(either) == '<code>"auto"</code> or whole number (from 2 on)'


def _off(drawing: Drawing, parameters: Parameters) -> set[str]:
    """Dimensions whose length is not the value of their parameter."""
    found = set()
    for dimension in drawing.dimensions:
        section, field = dimension.parameter.split(".")
        value = getattr(getattr(parameters, section), field)
        if abs(dimension.length_mm - value) > ROUNDING_MM:
            found.add(dimension.parameter)
    return found


@pytest.mark.parametrize("name", ["face", "section"])
def test_each_dimension_is_as_long_as_its_parameter(name: str) -> None:
    parameters = resolve(load(PRESET)).config.parameters
    drawing = drawings()[name]
    assert _off(drawing, parameters) == set()
    first = drawing.dimensions[0]
    (x, y), moved = first.end, list(drawing.dimensions)
    moved[0] = replace(first, end=(x, y - 0.2))
    assert _off(replace(drawing, dimensions=moved), parameters) == {first.parameter}


def test_a_drawing_has_the_same_bytes_each_time(doc_site: Path) -> None:
    for name, drawing in drawings().items():
        written = (doc_site / f"reference/images/{name}.svg").read_text("utf-8")
        assert drawing.svg() == written
        assert written.count("<path") > 30


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_the_catalogue_has_every_entry(doc_site: Path, file: Path) -> None:
    text = _text(doc_site, f"parts/{file.stem}.html")
    shown = re.findall(r'<h2 id="[^"]*">(.*?)<a class="headerlink"', text)
    assert shown == [name for name, entry in read(file).items() if isinstance(entry, dict)]
    assert f'href="{file.stem}.html"' in _text(doc_site, "parts/index.html")


@pytest.mark.parametrize("program", PARSERS)
def test_the_reference_has_every_command_and_option(doc_site: Path, program: str) -> None:
    text = _text(doc_site, f"{program}.html")
    shown = commands(PARSERS[program]())
    assert re.findall(r'<h2 id="[^"]*">(.*?)<a class="headerlink"', text) == list(shown)
    for command, parser in shown.items():
        part = text.partition(f'<h2 id="{command}">')[2].partition("<h2 ")[0]
        for action in parser._actions:
            if action.help == argparse.SUPPRESS:
                continue
            value = action.metavar or ",".join(action.choices or [action.dest.upper()])
            for option in action.option_strings or [str(value)]:
                assert option in part, (command, option)


@pytest.mark.parametrize("name", packages())
def test_the_reference_has_every_public_name(doc_site: Path, name: str) -> None:
    text = _text(doc_site, f"api/{name}.html")
    public = importlib.import_module(name).__all__
    assert packages()[name][1] == list(public)
    for each in public:
        assert re.search(rf'<h2 id="[\w.]*\b{each}" class="doc doc-heading">', text), each
