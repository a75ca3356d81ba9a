"""Every preset builds and passes every check; and every check is one that a damage fails."""

import json
from collections.abc import Callable
from fnmatch import fnmatch
from pathlib import Path

import pytest

from lumitip_fab.checks.result import Measurement
from lumitip_fab.checks.run import MODULES, as_json, modules_reading, run_checks

PRESETS = Path(__file__).parents[2] / "design" / "presets"
NAMES = sorted(file.stem for file in PRESETS.glob("*.toml"))


@pytest.mark.slow  # `make outputs` checks the design that it has built
@pytest.mark.parametrize("preset", NAMES)
def test_a_preset_passes_every_check(built: Callable[[str], Path], preset: str) -> None:
    outcome = run_checks(built(preset))
    assert [f"{m.check} {m.subject}: {m.measured} {m.limit}" for m in outcome.failed] == []
    without = {"panels", "insert"}  # no preset asks for them
    without |= {"holder"} if preset in {"integrated", "wsg50", "franka_hand"} else set()
    without |= {"gauge_card"} if preset in {"flex", "by_goals"} else set()
    without |= {"flange"} if preset in {"wsg50", "franka_hand"} else set()
    assert {name.partition(".")[0] for name in outcome.names} == set(MODULES) - without
    assert len(json.loads(json.dumps(as_json(outcome)))) == len(outcome.measurements)


def test_a_measurement_that_could_not_be_taken_fails() -> None:
    assert not Measurement("x", "y", float("nan"), 0, 1).passed
    assert Measurement("x", "y", 1.0, 0, 1).passed
    assert Measurement("x", "y", 1.25, 0, 1).margin == -0.25
    assert Measurement("x", "y", 0.25, 0, 1).margin == 0.75
    assert Measurement("x", "y", 2.25, 2, 4).margin == 0.25


UNREAD = (
    ".built",  # spares a build
)


def test_every_file_of_a_part_is_read_by_some_check(outputs: Path) -> None:
    files = [f.relative_to(outputs).as_posix() for f in outputs.rglob("*") if f.is_file()]
    unread = {f for f in files if set(modules_reading([f])) <= {"manifest"}}
    assert unread == {f for f in files if any(fnmatch(f, pattern) for pattern in UNREAD)}
    assert all(any(fnmatch(f, pattern) for f in files) for pattern in UNREAD)


def test_the_json_report_has_no_value_that_json_lacks(outputs: Path, tmp_path: Path) -> None:
    (tmp_path / "design.json").write_bytes((outputs / "design.json").read_bytes())
    told = as_json(run_checks(tmp_path))
    assert None in [row["measured"] for row in told]
    of_files = [row for row in told if not str(row["subject"]).startswith("design.json")]
    # No file there is a pipe or a device, and none is too many.
    of_nothing = {"manifest.kinds", "printing.files"}
    assert {row["check"] for row in of_files if row["passed"]} <= of_nothing
    assert json.loads(json.dumps(told, allow_nan=False)) == told
