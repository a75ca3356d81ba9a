"""Apertures of groups of cells as parameters of a search."""

from pathlib import Path

import numpy as np
import pytest

from goals_file import write_goals
from lumitip.grid import hexagonal_grid
from lumitip_fab.errors import InputError
from lumitip_fab.solve.goals import read_goals
from lumitip_fab.solve.holes import BY, axis_names, groups, joined
from lumitip_fab.solve.judge import Job, Reference, judge

COLUMNS = (5, 4, 5, 4, 5, 4, 5)
GOALS = """\
[goals]
edge_mm = 0.1
[vary]
mask.cell_holes_mm = {{ from = 2.0, to = 3.0, step = 0.5, by = "ring" }}
"""


@pytest.fixture
def goals(tmp_path: Path) -> Path:
    return write_goals(tmp_path, GOALS)


def test_groups_of_a_grid() -> None:
    grid = hexagonal_grid(COLUMNS, 6.0)
    assert groups(COLUMNS, "cell").tolist() == list(range(32))
    assert groups(COLUMNS, "column").tolist() == grid.column.tolist()
    assert groups(COLUMNS, "row").tolist() == grid.row.tolist()
    ring = groups(COLUMNS, "ring")
    inside = (np.abs(grid.x_mm) < 15.0) & (np.abs(grid.y_mm) < 9.0)
    assert set(ring[~inside]) == {0} and set(ring[inside]) == {1, 2}
    assert np.abs(grid.y_mm[ring == 2]).max() < 1e-9, "two cells, beside the middle column"
    assert np.count_nonzero(ring == 2) == 2


@pytest.mark.parametrize("columns", [(1, 3), (2, 2), (2, 1, 2)])
def test_a_grid_without_inside_is_one_ring(columns: tuple[int, ...]) -> None:
    assert set(groups(columns, "ring")) == {0}


def test_sizes_of_groups_become_one_size_for_each_cell(goals: Path) -> None:
    task = read_goals(goals)
    names = [axis.field for axis in task.axes]
    assert names == [f"mask.cell_holes_mm.ring {n}" for n in range(3)]
    assert {axis.values for axis in task.axes} == {(2.0, 2.5, 3.0)}
    changes = tuple(zip(names, (3.0, 2.5, 2.0), strict=True))
    design = task.design(changes).parameters
    assert design.mask.cell_holes_mm == tuple(3.0 - 0.5 * groups(COLUMNS, "ring"))
    assert joined((("mask.layers", 2),), COLUMNS) == (("mask.layers", 2),)
    assert joined((("mask.layers", 2), *changes), COLUMNS)[0] == ("mask.layers", 2)


@pytest.mark.slow
def test_a_design_with_sizes_is_judged_by_them(goals: Path) -> None:
    task = read_goals(goals)
    names, reference = axis_names(COLUMNS, "ring"), Reference.of(task)
    errors = []
    for sizes in ((2.5, 2.5, 2.5), (3.0, 2.0, 2.0)):
        record = judge(Job.of(task, tuple(zip(names, sizes, strict=True)), reference))
        errors.append(record.get("figures", record).get("edge_mm"))
    assert None not in errors
    assert errors[0] != pytest.approx(errors[1], rel=0.03)


FAULTS = {
    'by = "ring"': ('by = "rings"', ", ".join(map(repr, BY))),
    "from = 2.0": ("from = 0.1", "is 0.1; at least 0.3"),
    "to = 3.0": ("to = 1.0", "from must be below to"),
    "[vary]\n": ("[vary]\nmask.hole_mm = [2.0, 3.0]\n", "mask.hole_mm cannot vary too"),
    ', by = "ring"': ("", "has by = ''"),
    "[vary]": ("[vary]\ngrid.columns = [[5, 4, 5]]", "grid.columns cannot vary too"),
}


@pytest.mark.parametrize(("old", "new", "text"), [(k, *v) for k, v in FAULTS.items()])
def test_faults_of_groups_name_their_line(goals: Path, old: str, new: str, text: str) -> None:
    goals.write_text(goals.read_text().replace(old, new, 1))
    with pytest.raises(InputError) as refusal:
        read_goals(goals)
    (line,) = [n for n, t in enumerate(goals.read_text().split("\n"), 1) if "cell_holes" in t]
    assert any(p.line == line and text in p.text for p in refusal.value.problems), refusal.value


def test_a_size_for_all_has_no_effect_beside_a_size_for_each(goals: Path) -> None:
    sizes = f"[fixed]\nmask.cell_holes_mm = {[2.5] * 32}\n[vary]"
    goals.write_text(goals.read_text().replace("[vary]", sizes))
    with pytest.raises(InputError, match="is in \\[fixed\\] too"):
        read_goals(goals)
    own = 'mask.cell_holes_mm = { from = 2.0, to = 3.0, step = 0.5, by = "ring" }'
    goals.write_text(goals.read_text().replace(own, "mask.hole_mm = [2.0, 3.0]"))
    with pytest.raises(InputError, match="has no effect here"):
        read_goals(goals)


def test_groups_belong_to_the_grid_that_is_fixed(goals: Path) -> None:
    goals.write_text(
        goals.read_text().replace("[vary]", "[fixed]\ngrid.columns = [3, 4, 3]\n[vary]")
    )
    task = read_goals(goals)
    sizes = task.design(tuple((axis.field, 2.0) for axis in task.axes)).parameters.mask
    assert len(sizes.cell_holes_mm) == 10
