"""`layout.json`: the published figures, its canonical form, its hash, and damage to it."""

import copy
import dataclasses
import json
import math
import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumitip import Cell, Layout, LayoutError, LumitipError, Optics
from lumitip.grid import hexagonal_grid, hexagonal_neighbours

OPTICS = Optics(
    hole_mm=2.5,
    hole_shape="hexagon",
    emitter_depth_mm=0.9,
    detector_depth_mm=0.9,
    emitter_exponent=1.0,
    detector_exponent=2.0,
    silicone_index=1.41,
    film_mm=0.1,
    pull_up_ohm=75e3,
    supply_v=3.3,
)

# Photodetectors of the published receiver board (arXiv 2306.05902, public board file), Q1 first: x
# from the board's centreline and y from its tip edge, mm. The sensor frame's y is 15.65 - y.
PUBLISHED_BOARD_MM = (
    (-15.5885, 3.65),  # Q1
    (-15.5885, 9.65),  # Q2
    (-15.5885, 15.65),  # Q3
    (-15.5885, 21.65),  # Q4
    (-15.5885, 27.65),  # Q5
    (-10.3923, 6.65),  # Q6
    (-10.3923, 12.65),  # Q7
    (-10.3923, 18.65),  # Q8
    (-10.3923, 24.65),  # Q9
    (-5.1962, 3.65),  # Q10
    (-5.1962, 9.65),  # Q11
    (-5.1962, 15.65),  # Q12
    (-5.1962, 21.65),  # Q13
    (-5.1962, 27.65),  # Q14
    (0.0, 6.65),  # Q15
    (0.0, 12.65),  # Q16
    (0.0, 18.65),  # Q17
    (0.0, 24.65),  # Q18
    (5.1962, 3.65),  # Q19
    (5.1962, 9.65),  # Q20
    (5.1962, 15.65),  # Q21
    (5.1962, 21.65),  # Q22
    (5.1962, 27.65),  # Q23
    (10.3923, 6.65),  # Q24
    (10.3923, 12.65),  # Q25
    (10.3923, 18.65),  # Q26
    (10.3923, 24.65),  # Q27
    (15.5885, 3.65),  # Q28
    (15.5885, 9.65),  # Q29
    (15.5885, 15.65),  # Q30
    (15.5885, 21.65),  # Q31
    (15.5885, 27.65),  # Q32
)


def _layout(columns: tuple[int, ...] = (5, 4, 5, 4, 5, 4, 5), pitch_mm: float = 6.0) -> Layout:
    grid = hexagonal_grid(columns, pitch_mm)
    index = np.arange(grid.x_mm.size)
    return Layout(
        x_mm=grid.x_mm,
        y_mm=grid.y_mm,
        column=grid.column,
        row=grid.row,
        neighbours=hexagonal_neighbours(columns),
        mux=index // 8,
        channel=index % 8,
        adc_pin=np.array([f"A{i}" for i in index // 8]),
        pitch_mm=pitch_mm,
        optics=OPTICS,
    )


@pytest.fixture
def layout() -> Layout:
    """The published grid, wired in order."""
    return _layout()


def _changed(layout: Layout, **values: Any) -> Layout:
    return dataclasses.replace(layout, **values)


# The published figures ---------------------------------------------------------------------------


def test_the_published_grid_has_32_cells_and_73_pairs_of_neighbours(layout: Layout) -> None:
    assert len(layout) == 32
    assert layout.neighbours.shape == (73, 2)
    seven = np.bincount(layout.neighbours.ravel(), minlength=32)
    assert seven.max() == 6
    assert seven.min() == 2


def test_cells_are_where_the_published_board_has_them_in_its_order(layout: Layout) -> None:
    published = np.array(PUBLISHED_BOARD_MM)
    assert layout.x_mm == pytest.approx(published[:, 0], abs=1e-4)
    assert layout.y_mm == pytest.approx(15.65 - published[:, 1], abs=1e-4)


def test_the_mirrored_cells_face_cells_of_the_same_grid_as_the_published_boards_do(
    layout: Layout,
) -> None:
    # Published pairs of emitter and receiver designators that face each other: D1-Q28, D5-Q32,
    # D20-Q11, D14-Q23; in these columns both boards are numbered alike. LED i of a `Layout` is the
    # one that faces photodetector i, at (-x, y) of its own frame.
    at = {(round(c.x_mm, 3), round(c.y_mm, 3)): c.index for c in layout.cells}
    faces = {c.index: at[round(-c.x_mm, 3) + 0.0, round(c.y_mm, 3)] for c in layout.cells}
    for led, detector in ((1, 28), (5, 32), (20, 11), (14, 23), (28, 1)):
        assert faces[led - 1] == detector - 1
    assert sorted(faces.values()) == list(range(32))


# Form --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("columns", [(5, 4, 5, 4, 5, 4, 5), (4, 5, 6, 5), (1, 2)])
def test_the_canonical_text_reads_back_to_itself(columns: tuple[int, ...]) -> None:
    text = _layout(columns, 5.0).to_json()
    again = Layout.from_json(text)
    assert again.to_json() == text
    assert Layout.from_json(again.to_json()) == _layout(columns, 5.0)
    assert again.optics == OPTICS
    assert text.endswith("}\n")
    assert list(json.loads(text)) == sorted(json.loads(text))


def test_a_saved_layout_loads(layout: Layout, tmp_path: Path) -> None:
    file = tmp_path / "layout.json"
    file.write_text(layout.to_json(), encoding="utf-8")
    assert Layout.load(file) == layout
    assert Layout.load(str(file)) == layout


def test_minus_zero_and_noise_below_a_nanometre_change_neither_text_nor_hash(
    layout: Layout,
) -> None:
    zero = layout.x_mm == 0
    assert zero.any()
    noisy = _changed(
        layout, x_mm=np.where(zero, -0.0, layout.x_mm) + 1e-10, y_mm=layout.y_mm - 1e-10
    )
    minus = _changed(layout, x_mm=np.where(zero, -0.0, layout.x_mm))
    for other in (noisy, minus):
        assert other.to_json() == layout.to_json()
        assert "-0.0" not in other.to_json().replace("-0.0000", "")
        assert other == layout
        assert hash(other) == hash(layout)


def test_arrays_are_copies_that_cannot_be_written(layout: Layout) -> None:
    given = np.array(layout.x_mm)
    mine = _changed(layout, x_mm=given)
    given[0] = 99.0
    assert mine.x_mm[0] == layout.x_mm[0]
    for name in ("x_mm", "y_mm", "column", "row", "neighbours", "mux", "channel", "adc_pin"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(mine, name)[0] = 0
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(mine, name, given)


def test_cells_are_the_arrays_as_records_of_plain_values(layout: Layout) -> None:
    cells = layout.cells
    assert len(cells) == 32
    assert cells[5] == Cell(5, layout.x_mm[5], layout.y_mm[5], 1, 0, 0, 5, "A0")
    assert [c.index for c in cells] == list(range(32))
    for name, kind in (("x_mm", float), ("column", int), ("adc_pin", str)):
        assert type(getattr(cells[0], name)) is kind
        assert [getattr(c, name) for c in cells] == getattr(layout, name).tolist()


def test_keys_of_later_versions_are_ignored(layout: Layout) -> None:
    told = json.loads(layout.to_json())
    told["made_of"] = {"cheese": [1, 2]}
    told["optics"]["colour"] = "pink"
    assert Layout.from_json(json.dumps(told)).to_json() == layout.to_json()


# Hash --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "change",
    [
        {"optics": dataclasses.replace(OPTICS, hole_mm=1.0, hole_shape="circle", film_mm=0.2)},
        {"pitch_mm": 6.1},
        {"neighbours": np.zeros((0, 2), dtype=np.int64)},
    ],
    ids=["optics", "pitch alone", "neighbours"],
)
def test_the_design_hash_leaves_out_all_but_cells_and_wiring(
    layout: Layout, change: dict[str, Any]
) -> None:
    assert _changed(layout, **change).design_hash == layout.design_hash
    assert _changed(layout, **change) == layout


@pytest.mark.parametrize("name", ["x_mm", "y_mm", "column", "row", "mux", "channel", "adc_pin"])
def test_the_design_hash_covers_every_value_of_every_cell(layout: Layout, name: str) -> None:
    told = np.array(getattr(layout, name))
    told[-1] = "A9" if name == "adc_pin" else told[-1] + 1
    other = _changed(layout, **{name: told})
    assert other.design_hash != layout.design_hash
    assert other != layout


def test_the_design_hash_covers_the_order_of_the_cells(layout: Layout) -> None:
    swapped = {
        name: np.array(getattr(layout, name))[::-1]
        for name in ("x_mm", "y_mm", "column", "row", "mux", "channel", "adc_pin")
    }
    assert _changed(layout, **swapped) != layout


def test_a_layout_equals_nothing_else(layout: Layout) -> None:
    assert layout != layout.to_json()
    assert len({layout, _layout(), _layout(pitch_mm=5.0)}) == 2


# Damage ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("schema_version", 2, "schema_version: 2 given, this version reads 1"),
        ("schema_version", True, "schema_version: True given"),
        ("schema_version", None, "schema_version: None given"),
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
        ("pitch_mm", -1, "pitch_mm: -1 given"),
        ("pitch_mm", 10**400, "pitch_mm: "),
        ("pitch_mm", "6", "pitch_mm: '6' given"),
        ("optics", [], "optics: an object is needed"),
        ("optics", {"hole_shape": []}, r"optics.hole_shape: \[\] given"),
        ("optics", {"hole_shape": "circle"}, r"optics\.hole_mm: None given"),
        ("design_hash", "0" * 64, "design_hash: '0000000000000000' given"),
        ("design_hash", None, "design_hash: 'None' given"),
        ("x_mm", [0.5] * 32, ".*the file was changed by hand"),
    ],
)
def test_a_damaged_value_is_refused_with_its_name(
    layout: Layout, key: str, value: Any, said: str
) -> None:
    told = json.loads(layout.to_json())
    told[key] = value
    with pytest.raises(LayoutError, match=rf"^finger\.json: {said}"):
        Layout.from_json(json.dumps(told), source="finger.json")


@pytest.mark.parametrize("key", sorted(json.loads(_layout().to_json())))
def test_a_missing_value_is_refused_with_its_name(layout: Layout, key: str) -> None:
    told = json.loads(layout.to_json())
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
