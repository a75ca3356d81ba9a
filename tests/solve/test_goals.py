"""Goals files: what they give, and every fault with its line."""

from pathlib import Path

import pytest

from lumitip_fab.errors import InputError
from lumitip_fab.solve.goals import read_goals

GOOD = """\
base = "{base}"
[goals]
edge_mm = 0.1
[limits]
cost = 60.0
[fixed]
stack.silicone_mm = 2.0
[vary]
mask.hole_mm = {{ from = 2.0, to = 3.0, step = 0.25 }}
mask.hole_shape = ["hexagon", "circle"]
grid.pitch_mm = [5, 6.0]
grid.columns = "keep_size"
"""


@pytest.fixture
def goals(tmp_path: Path, design_dir: Path) -> Path:
    file = tmp_path / "goals.toml"
    file.write_text(GOOD.format(base=(design_dir / "presets/published.toml").as_posix()))
    return file


def test_values_and_base_of_a_goals_file(goals: Path) -> None:
    task = read_goals(goals)
    values = {axis.field: axis.values for axis in task.axes}
    assert values == {
        "mask.hole_mm": (2.0, 2.25, 2.5, 2.75, 3.0),
        "mask.hole_shape": ("hexagon", "circle"),
        "grid.pitch_mm": (5.0, 6.0),
    }
    assert (task.designs, task.keep_size) == (20, True)
    assert task.base.parameters.stack.silicone_mm == 2.0
    smaller = task.design((("grid.pitch_mm", 5.0),)).parameters
    assert smaller.grid.columns == (6, 5, 6, 5, 6, 5, 6, 5)
    assert smaller.stack.silicone_mm == 2.0


@pytest.mark.parametrize(
    ("name", "base"),
    [
        ("goals", "Lumitip published"),
        ("goals_by_ring", "Lumitip by goals"),
        ("goals_wsg50", "Lumitip published"),
    ],
)
def test_the_examples_are_valid(name: str, base: str) -> None:
    example = Path(__file__).parents[2] / f"examples/{name}.toml"
    assert read_goals(example).base.parameters.name == base


def test_fixed_and_varied_values_may_be_automatic(goals: Path) -> None:
    text = goals.read_text().replace(
        "silicone_mm = 2.0", 'silicone_mm = 2.0\nreceiver.load = "auto"'
    )
    text = text.replace(
        '["hexagon", "circle"]', '["hexagon", "circle"]\nboard.track_mm = ["auto", 0.15]'
    )
    goals.write_text(text)
    task = read_goals(goals)
    assert "receiver.load" in task.base.automatic - task.written.automatic
    left, fine = (task.design((("board.track_mm", value),)) for value in ("auto", 0.15))
    assert "board.track_mm" in left.automatic - fine.automatic
    assert (left.parameters.board.track_mm, fine.parameters.board.track_mm) == (0.2, 0.15)


FAULTS = {
    ("edge_mm = 0.1", "edge_mm = 1.5"): (3, "less than 1 is allowed"),
    ("edge_mm = 0.1", "gaps_mm = [2.0]"): (2, "goals is without an error"),
    ("edge_mm = 0.1", "cable_mm = 0.1\ngaps_mm = [2.0]"): (2, "fits no gap"),
    ("edge_mm = 0.1", "edge_mm = 0.1\ngaps_mm = [2, 2.0]"): (2, "goals: gaps_mm has 2 mm twice"),
    ("edge_mm = 0.1", "edge_mm = 0.1\ncables_mm = [3, 3.0]"): (2, "cables_mm has 3 mm twice"),
    ("edge_mm = 0.1", "cable_mm = 0.1\ncables_mm = []"): (2, "cable_mm is set, but cables_mm is"),
    ("edge_mm = 0.1", "edge_mm = nan"): (3, "goals.edge_mm is nan; a finite number is needed"),
    ("cost = 60.0", "cost = nan"): (5, "limits.cost is nan; more than 0 is needed"),
    ("[5, 6.0]", "[6, 6.0]"): (11, "vary.grid.pitch_mm has one value, 6.0; add another"),
    ("[5, 6.0]", "[true, 6.0]"): (11, "vary.grid.pitch_mm"),
    ("[5, 6.0]", f"[1{'0' * 400}, 6.0]"): (11, "vary.grid.pitch_mm"),
    ("from = 2.0", "from = true"): (9, "vary.mask.hole_mm"),
    ("edge_mm = 0.1", "edge_mm = -1"): (3, "goals.edge_mm is -1; more than 0 is needed"),
    ("edge_mm = 0.1", "edges = 0.1"): (3, "goals.edges"),
    ("silicone_mm = 2.0", "silicone_mm = -2"): (7, "fixed.stack.silicone_mm is -2"),
    ("silicone_mm = 2.0", "silicon_mm = 2"): (7, "Did you mean 'stack.silicone_mm'?"),
    ("step = 0.25", "step = 0"): (9, "vary.mask.hole_mm is"),
    ("from = 2.0", "from = 4"): (9, "from must be below to"),
    ("to = 3.0, ", ""): (9, "{ from = A, to = B, step = C } is needed"),
    ('"circle"]', '"square"]'): (10, "vary.mask.hole_shape"),
    ('["hexagon", "circle"]', "[]"): (10, "vary.mask.hole_shape is an empty list"),
    ('["hexagon", "circle"]', "[{ a = 1 }]"): (10, "vary.mask.hole_shape"),
    ("grid.pitch_mm = [5, 6.0]", ""): (12, "grid.pitch_mm does not vary"),
    ("mask.hole_shape = [", "stack.silicone_mm = [2.0, "): (10, "is in [fixed] too"),
    ("mask.hole_shape = [", "emitter.led = ["): (10, "vary.emitter.led is not allowed to vary"),
}


@pytest.mark.slow_cases
@pytest.mark.parametrize("change", FAULTS, ids=lambda c: c[1] or c[0])
def test_a_fault_has_its_line_and_what_is_allowed(change: tuple[str, str], goals: Path) -> None:
    goals.write_text(goals.read_text().replace(*change))
    line, text = FAULTS[change]
    with pytest.raises(InputError) as caught:
        read_goals(goals)
    problems = [p for p in caught.value.problems if text in str(p)]
    assert [p.line for p in problems] == [line], caught.value


def test_all_faults_are_reported_at_once(goals: Path) -> None:
    text = goals.read_text().replace("step = 0.25", "step = 0").replace('"circle"', '"square"')
    goals.write_text(text.replace("silicone_mm = 2.0", "silicone_mm = -2"))
    with pytest.raises(InputError) as caught:
        read_goals(goals)
    assert sorted(p.line for p in caught.value.problems) == [7, 9, 10]


def test_a_missing_base_is_named(goals: Path) -> None:
    goals.write_text(goals.read_text().replace("published.toml", "absent.toml"))
    with pytest.raises(InputError, match=r"absent\.toml"):
        read_goals(goals)
