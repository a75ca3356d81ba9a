"""`layout.json`: the published figures, its canonical form and its hash."""

import copy
import dataclasses
import json
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumitip import Cell, Layout, Optics

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


Make = Callable[..., Layout]


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
def test_the_canonical_text_reads_back_to_itself(
    make_layout: Make, columns: tuple[int, ...]
) -> None:
    text = make_layout(columns, 5.0).to_json()
    again = Layout.from_json(text)
    assert again.to_json() == text
    assert Layout.from_json(again.to_json()) == make_layout(columns, 5.0)
    assert again.optics == make_layout(columns, 5.0).optics
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


@pytest.mark.parametrize(
    "copied", [copy.copy, copy.deepcopy, lambda v: pickle.loads(pickle.dumps(v))]
)
def test_the_arrays_of_a_copy_cannot_be_written_either(
    copied: Callable[[Layout], Layout], layout: Layout
) -> None:
    mine = copied(layout)
    assert mine == layout
    assert mine.cells == layout.cells
    for name in ("x_mm", "neighbours", "adc_pin", "hole_share"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(mine, name)[0] = 0


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
        {"optics": Optics(1.0, "circle", 0.5, 0.5, 2.0, 1.0, 1.5, 0.2, 1e5, 5.0)},
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


def test_a_layout_equals_nothing_else(layout: Layout, make_layout: Make) -> None:
    assert layout != layout.to_json()
    assert len({layout, make_layout(), make_layout(pitch_mm=5.0)}) == 2
