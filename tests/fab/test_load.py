"""Files, bases and catalogues together: what counts, where a fault is placed, what is found."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lumitip_fab.config.load import Input, load
from lumitip_fab.config.parts import NAMED, OPTIONAL
from lumitip_fab.derive import derive
from lumitip_fab.docs.spec_circuit import channel_rows
from lumitip_fab.errors import InputError, Problem

DESIGN = Path(__file__).parents[2] / "design"
BASE = 'extends = "presets/published.toml"\n'
Write = Callable[[str], Path]


@pytest.fixture
def write(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Write:
    """`write(text)`: a file of that text in a copy of the design folder."""
    shutil.copytree(DESIGN, tmp_path / "design")
    monkeypatch.chdir(tmp_path)

    def saved(text: str) -> Path:
        path = Path("design/x.toml")
        path.write_text(text, encoding="utf-8")
        return path

    return saved


def _problems(path: Path) -> tuple[Problem, ...]:
    with pytest.raises(InputError) as caught:
        derive(load(path))
    return caught.value.problems


def test_what_a_file_says_wins_over_its_base_and_the_rest_is_the_bases(write: Write) -> None:
    config = load(write(BASE + "[grid]\npitch_mm = 5.0\n"))
    assert config.parameters.grid.pitch_mm == 5.0
    assert config.parameters.grid.columns == (5, 4, 5, 4, 5, 4, 5)
    assert [s.path.name for s in config.sources] == ["x.toml", "published.toml"]


def test_a_preset_that_extends_another_can_be_extended(write: Write) -> None:
    Path("design/mine.toml").write_text(
        'extends = "presets/dense.toml"\nmask.hole_mm = 1.4\nemitter.current_ma = 9.0\n'
    )
    config = load(write('extends = "mine.toml"\nemitter.current_ma = 8.0\n'))
    assert [s.path.name for s in config.sources] == [
        "x.toml",
        "mine.toml",
        "dense.toml",
        "published.toml",
    ]
    values = config.parameters
    assert (values.emitter.current_ma, values.mask.hole_mm) == (8.0, 1.4)
    assert values.grid.pitch_mm == 3.0  # of the preset
    assert values.stack.silicone_mm == 1.5  # of the preset's base


def test_a_fault_of_a_rule_is_placed_in_the_level_that_set_the_value(write: Write) -> None:
    Path("design/mine.toml").write_text('extends = "presets/dense.toml"\n\nmask.hole_mm = 2.9\n')
    (fault,) = _problems(write('extends = "mine.toml"\n'))
    assert (fault.file, fault.line, fault.field) == ("design/mine.toml", 3, "mask.hole_mm")
    assert fault.message.endswith("Override it in design/x.toml.")


def test_what_an_unreadable_base_would_have_said_is_not_called_missing(write: Write) -> None:
    Path("design/mine.toml").write_text('extends = "none.toml"\n[mask]\nhole_mm = ""\n')
    faults = _problems(write('extends = "mine.toml"\n[grid]\npich_mm = 5\n'))
    assert [(fault.file, fault.field) for fault in faults] == [
        ("design/mine.toml", "extends"),
        ("design/mine.toml", "mask.hole_mm"),
        ("design/x.toml", "grid.pich_mm"),
    ]


def test_a_long_circle_is_refused_in_one_short_line(write: Write) -> None:
    for level in range(40):
        Path(f"design/b{level}.toml").write_text(f'extends = "b{(level + 1) % 40}.toml"\n')
    (fault,) = _problems(write('extends = "b0.toml"\n'))
    assert (fault.file, fault.line) == ("design/b39.toml", 1)
    assert "circle: design/b0.toml → design/b1.toml → design/b2.toml → … → design/b0.toml" in (
        fault.message
    )


def test_lists_are_replaced_and_not_joined(write: Write) -> None:
    assert load(write(BASE + "[grid]\ncolumns = [2, 1]\n")).parameters.grid.columns == (2, 1)


def test_the_file_to_edit_is_the_published_sensor_with_pull_ups_and_current_sources() -> None:
    mine, published = load(DESIGN / "fingertip.toml"), load(DESIGN / "presets" / "published.toml")
    assert len(mine.sources) == len(published.sources) == 1
    own, other = mine.parameters.model_dump(), published.parameters.model_dump()
    differing = {
        ("receiver", "load"): ("each", "shared"),
        ("receiver", "pull_up_ohm"): (10000.0, 75000.0),
        ("receiver", "bulk_capacitor"): ("10uF 0603 10V", "none"),
        ("emitter", "drive"): ("source", "resistor"),
        ("emitter", "switch"): ("AO3400A", "none"),
        ("flange", "indicator"): ("APT2012LZGCK", "none"),
        ("breakout", "indicator"): ("KT-0805YG", "none"),
        ("wiring", "order"): ("apart", "published"),
        ("protection", "diode"): ("H5VUD5U", "none"),
        ("breakout", "feed_diode"): ("1N5819HW", "none"),
        ("breakout", "board_mm"): ((45.72, 38.1), (45.72, 33.02)),
    }
    for (section, field), values in differing.items():
        assert (own[section].pop(field), other[section].pop(field)) == values
    assert {**own, "name": other["name"]} == other


def test_a_file_outside_any_design_folder_uses_the_catalogue_of_the_package(
    tmp_path: Path,
) -> None:
    file = tmp_path / "alone.toml"
    shutil.copy(DESIGN / "fingertip.toml", file)
    assert load(file).parameters == load(DESIGN / "fingertip.toml").parameters


def test_a_part_of_ones_own_needs_no_python(write: Write) -> None:
    leds = Path("design/parts/leds.toml")
    text = leds.read_text(encoding="utf-8")
    entry = text[text.index("[") :].replace("15406085BA300", "my own LED")
    leds.write_text(text + "\n" + entry.split("\n\n")[0] + "\n", encoding="utf-8")
    config = load(write(BASE + '[emitter]\nled = "my own LED"\n'))
    assert config.parts_by_field()["emitter.led"].source
    assert set(config.parts_by_field()) - OPTIONAL == set(NAMED) - OPTIONAL


def test_a_fault_is_placed_in_the_file_that_set_the_value(write: Write) -> None:
    config = load(write(BASE + "grid.pitch_mm = 5.0\n"))
    assert config.problem("grid.pitch_mm", "m") == Problem("design/x.toml", 2, "grid.pitch_mm", "m")
    inherited = config.problem("mask.hole_mm", "m")
    assert inherited.file == "design/presets/published.toml"
    line = Path(inherited.file).read_text(encoding="utf-8").splitlines()[inherited.line - 1]
    assert line.startswith("hole_mm")


def test_a_bad_base_does_not_hide_the_files_own_faults(write: Write) -> None:
    problems = _problems(write('extends = "none.toml"\n[grid]\npich_mm = 5\n[mask]\nhole_mm = ""'))
    assert [p.field for p in problems] == ["extends", "grid.pich_mm", "mask.hole_mm"]


def test_faults_of_different_kinds_are_told_together(write: Write) -> None:
    text = BASE + "[grid]\ncolumns = [1, 1]\n[stack]\nfloor_mm = 0.5\n[mask]\nhole_mm = 5.9\n"
    assert [p.field for p in _problems(write(text))] == [
        "grid.columns",
        "stack.floor_mm",
        "mask.hole_mm",
    ]


def test_problems_are_sorted_told_once_and_read_as_file_line_field_message() -> None:
    late, early = Problem("b.toml", 3, "x", "late"), Problem("a.toml", 12, "", "early")
    error = InputError([late, early, late])
    assert error.problems == (early, late)
    assert str(error) == "a.toml:12: early\nb.toml:3: x: late"
    assert str(Problem("a.toml", 0, "", "cannot be read")) == "a.toml: cannot be read"


@pytest.mark.slow
def test_random_values_for_random_fields_are_derived_or_refused(write: Write) -> None:
    published = load(DESIGN / "presets" / "published.toml").parameters.model_dump()
    fields = [f"{s}.{k}" for s, t in published.items() if isinstance(t, dict) for k in t]
    value = st.one_of(
        st.floats().map(repr),
        st.integers(-(10**20), 10**20).map(str),
        st.floats(0.1, 100).map(repr),
        st.sampled_from(
            [
                "true",
                '""',
                '"x"',
                "[]",
                "[5, 4, 5]",
                "[[1]]",
                "{}",
                "{ a = 1 }",
                "2020-01-01",
                "12:00:00",
                "[100.0, nan]",
                '"\\u0000"',
                "0xffff",
                "1e400",
                "[1, 2, 3, 2, 1]",
            ]
        ),
    )
    lines = st.dictionaries(
        st.sampled_from([*fields, "name", "grid", "extra", "mask.x"]), value, min_size=1, max_size=4
    )

    @settings(
        max_examples=60,
        deadline=None,
        derandomize=True,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(lines)
    def attempt(told: dict[str, str]) -> None:
        path = write(BASE + "".join(f"{field} = {v}\n" for field, v in told.items()))
        try:
            derive(load(path))
        except InputError as error:
            for problem in error.problems:
                assert problem.file.startswith("design/")
                assert "\n" not in problem.message
                assert len(str(problem)) < 600

    attempt()


def test_an_input_knows_the_part_behind_every_name() -> None:
    given: Input = load(DESIGN / "presets" / "dense.toml")
    parts = given.parts_by_field()
    assert parts["receiver.multiplexer"] == given.catalogue.multiplexers["74HC4067PW"]
    assert parts["coupling.gripper"] == given.catalogue.grippers["robotiq_2f85"]


@pytest.mark.parametrize(
    ("preset", "share"), [("published", "7.3 times its range"), ("mux16", "97 % of its range")]
)
def test_the_spec_says_how_much_of_its_range_a_bare_cell_uses(preset: str, share: str) -> None:
    """300 µA at 20 mA, through 75 or 10 kΩ from 3.1 V, at 19.2 mA."""
    design = derive(load(DESIGN / "presets" / f"{preset}.toml"))
    (row,) = [row for row in channel_rows(design) if row.quantity == "light of a bare cell"]
    assert row.computed == share
    assert ("cut off" in row.reason) == (preset == "published")
