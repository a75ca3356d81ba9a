"""Damage the manifest, or a file behind its back, and the right checks fail."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.checks.run import run_checks


def failing(folder: Path) -> set[str]:
    return {m.check for m in run_checks(folder, ["manifest"]).failed}


@pytest.mark.parametrize(
    "path", ["resolved.toml", "assembly/receiver_exploded.svg", "mask/emitter_wrapping.md"]
)
@pytest.mark.parametrize("damage", [Path.unlink, lambda f: f.write_text("edited")])
def test_a_file_lost_or_edited_behind_its_back(
    damaged: Path, path: str, damage: Callable[[Path], Any]
) -> None:
    damage(damaged / path)
    assert failing(damaged) == {"manifest.files"}


@pytest.mark.parametrize(
    ("path", "row", "column", "value"),
    [
        ("backing/emitter_backing.stl", 1, 3, 40.0),
        ("backing/receiver_backing.stl", 0, 0, -1.0),
        ("mould/receiver_mould.stl", 2, 3, 0.0),
        ("mould/emitter_mould.stl", 0, 3, 0.2),
    ],
)
def test_a_matrix_that_puts_a_part_elsewhere(
    damaged: Path, path: str, row: int, column: int, value: float
) -> None:
    file = damaged / "manifest.json"
    told = json.loads(file.read_text())
    told["files"][path]["to_sensor"][row][column] = value
    file.write_text(json.dumps(told))
    assert failing(damaged) == {"manifest.frames"}


def test_no_manifest(damaged: Path) -> None:
    (damaged / "manifest.json").unlink()
    assert failing(damaged) == {"manifest.files", "manifest.frames"}


def test_both_checks_pass_undamaged(outputs: Path) -> None:
    outcome = run_checks(outputs, ["manifest"])
    assert outcome.names == {"manifest.files", "manifest.frames"}
    assert outcome.failed == ()
