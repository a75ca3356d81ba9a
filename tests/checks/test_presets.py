"""Every preset builds and passes every check; and every check is one that a damage fails."""

from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip_fab.checks.result import Measurement
from lumitip_fab.checks.run import MODULES, as_json, modules_reading, run_checks


@pytest.mark.parametrize("preset", ["published", "asymmetric", "dense"])
def test_a_preset_passes_every_check(built: Callable[[str], Path], preset: str) -> None:
    outcome = run_checks(built(preset))
    assert [f"{m.check} {m.subject}: {m.measured} {m.limit}" for m in outcome.failed] == []
    assert {name.partition(".")[0] for name in outcome.names} == set(MODULES)


def test_a_measurement_that_could_not_be_taken_fails() -> None:
    assert not Measurement("x", "y", float("nan"), 0, 1).passed
    assert Measurement("x", "y", 1.0, 0, 1).passed
    assert Measurement("x", "y", 1.25, 0, 1).margin == -0.25
    assert Measurement("x", "y", 0.25, 0, 1).margin == 0.75
    assert Measurement("x", "y", 2.25, 2, 4).margin == 0.25


def test_every_file_of_a_part_is_read_by_some_check(outputs: Path) -> None:
    unread = [
        str(f.relative_to(outputs))
        for f in outputs.rglob("*.*")
        if not list(modules_reading([str(f.relative_to(outputs))]))
    ]
    assert sorted(unread) == [
        "assembly/emitter_exploded.svg",
        "assembly/receiver_exploded.svg",
        "mask/emitter_wrapping.md",
        "mask/receiver_wrapping.md",
        "resolved.toml",
    ]


def test_the_json_report_has_no_value_that_json_lacks(outputs: Path, tmp_path: Path) -> None:
    (tmp_path / "design.json").write_bytes((outputs / "design.json").read_bytes())
    told = as_json(run_checks(tmp_path))
    assert told
    assert all(row["measured"] is None and row["passed"] is False for row in told)
