"""Damage to a `layout.json` is refused with the name of what is wrong, and never more."""

import copy
import json
import math
import random
from pathlib import Path
from typing import Any

import pytest

from lumitip import Layout, LayoutError, LumitipError


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("schema_version", 2, "schema_version is 2; this lumitip reads 1"),
        ("schema_version", True, "schema_version is True;"),
        ("schema_version", None, "schema_version is None;"),
        ("x_mm", [], "x_mm: a list of numbers"),
        ("x_mm", [1.0], "y_mm: a list of 1 numbers"),
        ("y_mm", "0", "y_mm: a list of 32 numbers"),
        ("y_mm", [math.nan] * 32, "y_mm: a list of 32 numbers"),
        ("column", [0.0] * 32, "column: a list of 32 whole numbers"),
        ("row", [-1] * 32, "row: a list of 32 whole numbers"),
        ("mux", [2**40] * 32, "mux: a list of 32 whole numbers"),
        ("channel", [True] * 32, "channel: a list of 32 whole numbers"),
        ("adc_pin", ["A0"] * 31, "adc_pin: a list of 32 pin names"),
        ("adc_pin", [0] * 32, "adc_pin: a list of 32 pin names"),
        ("neighbours", [[0, 32]], "neighbours: a list of pairs of cell indices from 0 to 31"),
        ("neighbours", [[0, 1, 2]], "neighbours: a list of pairs"),
        ("neighbours", [[1, 0]], "neighbours: "),
        ("neighbours", [[0, 1], [0, 1]], "neighbours: "),
        ("neighbours", [[3, 3]], "neighbours: "),
        ("pitch_mm", -1, "pitch_mm is -1;"),
        ("pitch_mm", 10**400, "pitch_mm is "),
        ("pitch_mm", "6", "pitch_mm is '6';"),
        ("optics", [], "optics: an object is needed"),
        ("optics", {"hole_shape": []}, r"optics.hole_shape is \[\];"),
        ("optics", {"hole_shape": "circle"}, r"optics\.hole_mm is None;"),
        ("hole_mm", [2.5] * 31, "hole_mm: a list of 32 numbers"),
        ("hole_mm", [2.5] * 31 + [0], "hole_mm: sizes above 0"),
        ("hole_mm", 3.0, "hole_mm: a list of 32 numbers"),
        ("design_hash", "0" * 64, "design_hash is '0000000000000000';"),
        ("design_hash", None, "design_hash is 'None';"),
        ("x_mm", [0.5] * 32, ".*The file was changed by hand"),
    ],
)
def test_a_damaged_value_is_refused_with_its_name(
    layout: Layout, key: str, value: Any, said: str
) -> None:
    told = json.loads(layout.to_json())
    told[key] = value
    with pytest.raises(LayoutError, match=rf"^finger\.json: {said}"):
        Layout.from_json(json.dumps(told), source="finger.json")


@pytest.mark.parametrize(
    "key",
    [
        "schema_version",
        "x_mm",
        "y_mm",
        "column",
        "row",
        "neighbours",
        "mux",
        "channel",
        "adc_pin",
        "pitch_mm",
        "optics",
        "design_hash",
    ],
)
def test_a_missing_value_is_refused_with_its_name(layout: Layout, key: str) -> None:
    told = json.loads(layout.to_json())
    assert len(told) == 12
    del told[key]
    with pytest.raises(LayoutError, match=f"layout: {key}"):
        Layout.from_json(json.dumps(told))


@pytest.mark.parametrize("text", ["", "{", "null", "[]", '"layout"', "[" * 100_000, "9" * 5000])
def test_what_is_no_layout_is_refused(text: str) -> None:
    with pytest.raises(LayoutError):
        Layout.from_json(text)


def test_files_that_cannot_be_read_are_refused(tmp_path: Path) -> None:
    (tmp_path / "latin.json").write_bytes(b'{"x": "\xfc"}')
    for path in (tmp_path / "none.json", tmp_path, tmp_path / "latin.json", "a\0b"):
        with pytest.raises(LayoutError, match="cannot be read as a layout"):
            Layout.load(path)


def test_every_error_is_a_lumitip_error() -> None:
    with pytest.raises(LumitipError):
        Layout.from_json("")


def test_no_damage_escapes_as_anything_but_a_layout_error(layout: Layout) -> None:
    chance = random.Random(4)
    sound = json.loads(layout.to_json())
    odd = (None, True, -1, 0, 1e300, 10**400, math.nan, math.inf, "", "x", [], [[]], {}, [None])
    accepted = 0
    for _ in range(1500):
        told = copy.deepcopy(sound)
        place: Any = told
        key: Any = chance.choice(list(place))
        while isinstance(place[key], dict | list) and place[key] and chance.random() < 0.7:
            place = place[key]
            key = chance.choice(list(place) if isinstance(place, dict) else range(len(place)))
        if chance.random() < 0.2:
            del place[key]
        else:
            place[key] = chance.choice(odd)
        accepted += _accepted(json.dumps(told))
    text = layout.to_json()
    for _ in range(500):
        at = chance.randrange(len(text))
        accepted += _accepted(text[:at] + chance.choice('0,[{"-e.\0') + text[at + 1 :])
    assert accepted < 400  # what the hash leaves out may change to another sound value


def _accepted(text: str) -> bool:
    try:
        layout = Layout.from_json(text)
    except LayoutError:
        return False
    assert Layout.from_json(layout.to_json()) == layout
    return True
