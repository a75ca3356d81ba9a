"""`design.json`: the same design, the same text, and nothing but `OutputError` for damage."""

import copy
import dataclasses
import json
import math
import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumitip_fab.design import Box, Design, Nose
from lumitip_fab.design.encoding import canonical, design_text, encoded, read_design, round_trip
from lumitip_fab.errors import FabError, OutputError

PRESETS = ("asymmetric", "dense", "mux16", "published")


@pytest.fixture
def saved(designs: dict[str, Design], tmp_path: Path) -> Path:
    """The published design's file."""
    file = tmp_path / "design.json"
    file.write_text(design_text(designs["published"]), encoding="utf-8")
    return file


@pytest.mark.parametrize("name", PRESETS)
def test_a_design_reads_back_as_the_very_same_design(
    designs: dict[str, Design], name: str, tmp_path: Path
) -> None:
    file = tmp_path / "design.json"
    file.write_text(design_text(designs[name]), encoding="utf-8")
    again = read_design(file)
    assert again == designs[name]
    assert design_text(again) == design_text(designs[name])
    assert again.layout.optics == designs[name].layout.optics
    for field in ("neighbours", "mux", "channel", "x_mm"):
        assert np.array_equal(getattr(again.layout, field), getattr(designs[name].layout, field))


def test_what_is_built_is_what_is_read_back(designs: dict[str, Design]) -> None:
    design = designs["published"]
    assert round_trip(design) == design
    noisy = dataclasses.replace(
        design, stack=dataclasses.replace(design.stack, floor_mm=0.8 + 1e-13)
    )
    assert round_trip(noisy) == design


def test_the_text_is_sorted_json_of_one_line_a_slice(designs: dict[str, Design]) -> None:
    text = design_text(designs["published"])
    told = json.loads(text)
    assert list(told) == sorted(told)
    assert text.count("\n") == len(told) + 2
    assert set(told) == {field.name for field in dataclasses.fields(Design)}


def test_canonical_text_has_no_noise_and_no_minus_zero() -> None:
    assert canonical({"b": (1.0, -0.0), "a": 0.1 + 0.2}) == '{"a":0.3,"b":[1.0,0.0]}'
    assert canonical(Box(-1e-12, 1, 2.5, 3)) == canonical(Box(0.0, 1, 2.5, 3))
    assert encoded(None) is None
    assert canonical([True, "ü", None]) == '[true,"\\u00fc",null]'


def test_whether_there_is_a_nose_survives(designs: dict[str, Design], tmp_path: Path) -> None:
    design = designs["published"]
    for nose in (None, Nose(5.0, 2.0, 30.0, 3.0)):
        other = dataclasses.replace(design, mount=dataclasses.replace(design.mount, nose=nose))
        file = tmp_path / "design.json"
        file.write_text(design_text(other), encoding="utf-8")
        assert read_design(file).mount.nose == nose


def test_a_missing_file_says_what_to_do(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match=r"none\.json: no such file: build the design first"):
        read_design(tmp_path / "none.json")


@pytest.mark.parametrize("text", ["", "[]", "null", "{}", "[" * 100_000, "7" * 5000, '"design"'])
def test_what_is_no_design_is_refused(text: str, tmp_path: Path) -> None:
    file = tmp_path / "design.json"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(OutputError, match="is not a design of this version"):
        read_design(file)


@pytest.mark.slow
def test_no_damage_escapes_as_anything_but_an_output_error(saved: Path) -> None:
    chance = random.Random(7)
    sound = json.loads(saved.read_text(encoding="utf-8"))
    odd = (None, True, -1, 0.5, 10**400, math.nan, "", [], [[]], {}, [None], "x")
    refused = 0
    for _ in range(80):
        told = copy.deepcopy(sound)
        place: Any = told
        key: Any = chance.choice(list(place))
        while isinstance(place[key], dict | list) and place[key] and chance.random() < 0.8:
            place = place[key]
            key = chance.choice(list(place) if isinstance(place, dict) else range(len(place)))
        if chance.random() < 0.3:
            del place[key]
        else:
            place[key] = chance.choice(odd)
        saved.write_text(json.dumps(told), encoding="utf-8")
        try:
            read_design(saved)
        except FabError:
            refused += 1
    assert refused > 40
