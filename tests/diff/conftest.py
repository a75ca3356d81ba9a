"""A second design, built once, and copies of the published one to change."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.cli import main
from lumitip_fab.cli.build import build

NAME = "<i>Other</i> & co"
OTHER = f"""\
extends = "published.toml"
name = "{NAME}"
[grid]
pitch_mm = 5.5
"""
Diff = Callable[..., dict[str, Any]]


@pytest.fixture(scope="session")
def other_file(once: Callable[..., Path], design_dir: Path) -> Path:
    """The published design with another pitch and name, as a parameter file."""

    def fill(folder: Path) -> None:
        shutil.copytree(design_dir, folder / "design")
        (folder / "design" / "presets" / "other.toml").write_text(OTHER, encoding="utf-8")

    return once("diff-design", fill) / "design" / "presets" / "other.toml"


@pytest.fixture(scope="session")
def other(once: Callable[..., Path], other_file: Path) -> Path:
    """Its output folder. Do not change it."""
    return once("diff-other", lambda out: build(other_file, out))


@pytest.fixture
def edited(outputs: Path, tmp_path: Path) -> Path:
    """A copy of the published design's output folder, to change."""
    return Path(shutil.copytree(outputs, tmp_path / "edited"))


@pytest.fixture
def diff(tmp_path: Path) -> Diff:
    """`diff(a, b, "--no-checks")`: what the command writes to `diff.json`."""

    def run(a: Path, b: Path, *options: str) -> dict[str, Any]:
        out = tmp_path / "diff"
        assert main(["diff", str(a), str(b), "--out", str(out), *options]) == 0
        return dict(json.loads((out / "diff.json").read_text(encoding="utf-8")))

    return run
