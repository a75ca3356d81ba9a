"""Which cells must be named on the silkscreen, where they are wide and where they are narrow."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from lumitip_fab.checks.board_finger import measure_cell_prints
from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.readers.kicad_board import read_board
from lumitip_fab.design.encoding import read_design

pytestmark = pytest.mark.slow

EMITTER = "boards/emitter/emitter.kicad_pcb"
NARROW_MM = 4.9
COLUMN_ENDS = {1, 3, 4, 5, 6, 8, 9, 10, 11, 13}


@pytest.mark.parametrize(
    ("pitch_mm", "named", "unnamed"),
    [
        (NARROW_MM, COLUMN_ENDS, 0),
        (NARROW_MM, {1, 3, 4, 5, 6}, 0),
        (NARROW_MM, {1, 3, 4, 5}, 6),
        (NARROW_MM, set(), 10),
        (NARROW_MM, set(range(1, 13)), 1),
        (5.0, COLUMN_ENDS, 3),
    ],
)
def test_narrow_cells_are_named_at_half_of_the_columns_ends_or_all(
    pitch_mm: float, named: set[int], unnamed: int, boards: Callable[[str], Path]
) -> None:
    folder = boards("small")
    design = read_design(folder / "design.json")
    design = replace(design, grid=replace(design.grid, pitch_mm=pitch_mm))
    read = ReadBoard("board", EMITTER, read_board(folder / EMITTER), design, design.fingers[0])
    printed = read.board.silk
    words = tuple(w for w in printed.words if w.ref[:1] != "D" or int(w.ref[1:]) in named)
    read = replace(read, board=replace(read.board, silk=replace(printed, words=words)))
    (found,) = (m for m in measure_cell_prints(read) if m.check == "board.silk_cell_names")
    assert found.measured == unnamed
