"""Every bad file is refused with exactly the message that an engineer was promised.

`tests/bad_inputs/NAME.toml` is put into a copy of `design/`, together with the files of the
folder `NAME/` where there is one; `NAME.expected` holds the message. `LUMITIP_GOLDEN=1` rewrites
the expectations: read the difference before committing it.
"""

import os
import re
import shutil
from pathlib import Path

import pytest
import tomlkit

from lumitip_fab.config.automatic import AUTO, automatic_fields
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.auto.judge import judge_with, rule_of
from lumitip_fab.derive.auto.resolve import RuleError
from lumitip_fab.errors import InputError

ROOT = Path(__file__).parents[2]
BAD = ROOT / "tests" / "bad_inputs"
NAMES = sorted(f.stem for f in BAD.glob("*.toml"))


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with a copy of the design folder, and a file outside it. The presets leave
    no value to the program, so that each rule is met."""
    shutil.copytree(ROOT / "design", tmp_path / "design")
    for file in (tmp_path / "design").rglob("*.toml"):
        if file.parent.name != "parts":
            _write_out(file)
    shutil.copy(ROOT / "design" / "presets" / "published.toml", tmp_path / "outside.toml")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _write_out(file: Path) -> None:
    """Replace every `"auto"` by the value that it begins with."""
    document = tomlkit.parse(file.read_text(encoding="utf-8"))
    for field, automatic in automatic_fields().items():
        section, key = field.split(".")
        if document.get(section, {}).get(key) == AUTO:
            document[section][key] = automatic.start
    file.write_text(tomlkit.dumps(document), encoding="utf-8")


def _refusal(name: str, project: Path) -> InputError:
    overlay = BAD / name
    if overlay.is_dir():
        shutil.copytree(overlay, project / "design", symlinks=True, dirs_exist_ok=True)
    file = Path("design") / f"{name}.toml"
    shutil.copy(BAD / f"{name}.toml", file)
    with pytest.raises(InputError) as caught:
        derive(load(file))
    return caught.value


LISTED = re.compile(r"((?:Names in parts/\w+\.toml|Available files): ).*")
"""Lists in a message, which grow with every entry and preset."""


def test_lists_hold_every_entry_and_every_preset(project: Path) -> None:
    names = tomlkit.parse((project / "design/parts/grippers.toml").read_text(encoding="utf-8"))
    assert str(_refusal("unknown_gripper", project)).endswith(f": {', '.join(sorted(names))}")
    files = [f"presets/{file.name}" for file in sorted((project / "design/presets").glob("*.toml"))]
    (problem, *_) = _refusal("extends_missing_file", project).problems
    listed = problem.message.partition("Available files: ")[2]
    assert [name for name in listed.split(", ") if name.startswith("presets/")] == files


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_a_bad_file_is_refused_with_exactly_the_expected_lines(name: str, project: Path) -> None:
    message = LISTED.sub(r"\1…", str(_refusal(name, project))) + "\n"
    expected = BAD / f"{name}.expected"
    if os.environ.get("LUMITIP_GOLDEN"):
        expected.write_text(message, encoding="utf-8")
    assert message == expected.read_text(encoding="utf-8")


@pytest.mark.parametrize("name", NAMES)
def test_expected_lines_name_a_file_and_a_field_once_each_and_in_order(name: str) -> None:
    lines = (BAD / f"{name}.expected").read_text(encoding="utf-8").splitlines()
    assert lines
    places = []
    for line in lines:
        place = re.match(r"(design/[\w./]+\.toml)(?::(\d+))?: (?:([\w.\" -]+): )?\S", line)
        assert place, line
        assert str(ROOT) not in line
        places.append((place[1], int(place[2] or 0)))
    assert places == sorted(places)
    assert len(set(lines)) == len(lines)


ADVICE = re.compile(r"at (?:least|most) (-?[\d.]+\d) is (?:needed|allowed)")
"""Figures that a message gives for its own field; those of other things have a unit."""


@pytest.mark.slow
@pytest.mark.parametrize("name", [n for n in NAMES if not (BAD / n).is_dir()])
def test_a_figure_that_a_message_names_for_its_field_mends_the_rule(
    name: str, project: Path
) -> None:
    error = _refusal(name, project)
    if not isinstance(error, RuleError):
        return  # schema faults: pydantic's own limits
    given = error.verdict.config
    for problem in error.problems:
        figures = ADVICE.findall(problem.message) if "." in problem.field else ()
        if len(figures) != 1 or not isinstance(given.value(problem.field), float):
            continue
        after = judge_with(given, {problem.field: float(figures[0])})
        assert after is None or rule_of(problem) not in after.rules, problem


def test_every_bad_file_has_its_expectation_and_no_expectation_is_left_over() -> None:
    assert {f.stem for f in BAD.glob("*.expected")} == set(NAMES)
    assert {f.name for f in BAD.iterdir() if f.is_dir()} <= set(NAMES)
    assert len(NAMES) >= 45


def test_line_numbers_point_at_the_text_that_is_at_fault(project: Path) -> None:
    problems = _refusal("several_faults_in_file_and_base", project).problems
    assert {Path(p.file).name for p in problems} == {
        "several_faults_in_file_and_base.toml",
        "broken_base.toml",
    }
    for problem in problems:
        line = Path(problem.file).read_text(encoding="utf-8").splitlines()[problem.line - 1]
        key = problem.field.partition(", value ")[0].rpartition(".")[2]
        missing = "is missing" in problem.message
        assert key in line or (missing and problem.field.split(".")[0] in line), problem


def test_the_pitch_that_the_published_detector_needs_is_accepted(project: Path) -> None:
    problems = _refusal("detector_too_long_for_pitch", project).problems
    (problem,) = (p for p in problems if p.field == "receiver.photodetector")
    assert "3.45 mm over its pads" in problem.message
    needed = re.search(r"a pitch of at least ([\d.]+) mm", problem.message)
    assert needed
    file = Path("design/wider.toml")
    text = (
        'extends = "presets/published.toml"\n[grid]\npitch_mm = {}\n[mask]\nhole_mm = 1.5\n'
        '[board]\ntip_margin_mm = 5.0\n[emitter]\nresistor_side = "front"\n'
        "current_ma = 9.0\n"
        "[finger]\nrated_force_n = 20.0\n[backing]\nflare_depth_mm = 6.0\n"
    )
    file.write_text(text.format(needed[1]), encoding="utf-8")
    assert derive(load(file)).grid.pitch_mm == float(needed[1])
    file.write_text(text.format(float(needed[1]) - 0.01), encoding="utf-8")
    with pytest.raises(InputError, match=r"receiver\.photodetector"):
        derive(load(file))
