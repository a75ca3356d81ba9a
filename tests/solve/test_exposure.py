"""Light of designs: relative to that of the base's own file, where the LED is its own."""

from pathlib import Path

import pytest
from rich.console import Console

from goals_file import PUBLISHED, write_goals
from lumitip_fab.cli.design import print_study
from lumitip_fab.derive import resolve
from lumitip_fab.errors import InputError
from lumitip_fab.solve.goals import Task, read_goals
from lumitip_fab.solve.judge import Job, Reference, judge
from lumitip_fab.solve.judged import Judged
from lumitip_fab.solve.search import Search
from lumitip_fab.solve.study import Options, Study, summary

GOALS = """\
[goals]
edge_mm = 0.2
cables_mm = []
[fixed]
{fixed}
[vary]
{vary}
"""
DIM = {"emitter.current_ma": 8.0, "receiver.pull_up_ohm": 18000.0}
SHARE = 8.0 * 18000.0 / (19.2 * 75000.0)
LED = 'emitter.led = "VSMY1850"'


def _task(folder: Path, fixed: str = "", vary: str = "mask.hole_mm = [2.5, 2.6]") -> Task:
    return read_goals(write_goals(folder, GOALS, fixed=fixed, vary=vary))


def _exposure(task: Task, changes: tuple[tuple[str, object], ...] = ()) -> float:
    return float(judge(Job.of(task, changes, Reference.of(task)))["figures"]["exposure"])


@pytest.mark.slow
def test_light_that_is_taken_away_in_fixed_counts_as_in_vary(tmp_path: Path) -> None:
    fixed = _task(tmp_path, "\n".join(f"{name} = {value}" for name, value in DIM.items()))
    exposure = _exposure(fixed)
    assert exposure == pytest.approx(SHARE, rel=0.02)
    vary = "\n".join(f"{name} = [{value}, {value * 1.1}]" for name, value in DIM.items())
    assert _exposure(_task(tmp_path, vary=vary), tuple(DIM.items())) == pytest.approx(exposure)


def test_fixed_values_that_give_too_much_light_are_refused(tmp_path: Path) -> None:
    task = _task(tmp_path, "receiver.pull_up_ohm = 150000.0")
    (text,) = judge(Job.of(task, (), Reference.of(task)))["refused"]
    assert "is 2.00 times that of the base, which saturates" in text


def test_a_base_that_is_refused_by_itself_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "base.toml").write_text(PUBLISHED.read_text().replace("= 2.5  ", "= 5.9  "))
    file = write_goals(
        tmp_path, GOALS, fixed="mask.hole_mm = 2.5", vary="mould.wall_mm = [2.0, 3.0]"
    )
    file.write_text(file.read_text().replace(PUBLISHED.as_posix(), "base.toml"))
    with pytest.raises(InputError, match=r"base\.toml:\d+: mask\.hole_mm is 5\.9"):
        Reference.of(read_goals(file))


@pytest.mark.slow
@pytest.mark.parametrize(("fixed", "other"), [(LED, True), ('emitter.led = "{}"', False)])
def test_another_led_has_its_own_reference_and_the_study_says_so(
    fixed: str, other: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own = resolve(_task(tmp_path).base).config.value("emitter.led")
    task = _task(tmp_path, fixed.format(own) + "\nemitter.current_ma = 16.0")
    reference = Reference.of(task)
    assert reference.with_fixed is other
    assert (_exposure(task) == 1.0) is other
    search = Search(Judged((), (), {}, (), 0.0), (), True, 0, reference)
    found = Study(task, Options(), search, ())
    assert summary(found)["well_exposed"] == "the base" + " with [fixed]" * other
    print_study(found, Console(width=200, markup=False))
    assert ("[fixed] names another LED or photodetector" in capsys.readouterr().out) is other
