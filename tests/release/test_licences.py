"""Every file has a copyright and a licence, by the REUSE specification."""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from reuse.project import Project

ROOT = Path(__file__).parents[2]
NOTICE = re.compile(
    rb"""^\W*(?:Permission is hereby granted|@license|Redistribution and use in"""
    rb"""|SPDX-License-Identifier|Copyright (?:\(c\)|\xc2\xa9|\d{4}))""",
    re.IGNORECASE | re.MULTILINE,
)
"""How a file that came from elsewhere says so."""
ABOUT_LICENCES = {"LICENSE", "REUSE.toml"}


def _lint(folder: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "reuse", "--root", str(folder), "lint", "--lines"]
    environment = {**os.environ, "REUSE_ENCODING_MODULE": "charset_normalizer"}
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.slow
def test_every_file_has_a_licence() -> None:
    done = _lint(ROOT)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.slow
def test_a_missing_text_and_a_file_without_a_licence_are_found(
    copy_repository: Callable[[Path], Path], tmp_path: Path
) -> None:
    copy = copy_repository(tmp_path / "copy")
    (copy / "LICENSES/MIT.txt").unlink()
    done = _lint(copy)
    assert done.returncode == 1
    assert "MIT" in done.stdout
    shutil.copy(ROOT / "LICENSES/MIT.txt", copy / "LICENSES")
    file = copy / "REUSE.toml"
    text = file.read_text(encoding="utf-8").replace('path = "**"', 'path = "docs/**"')
    file.write_text(text, encoding="utf-8")
    done = _lint(copy)
    assert done.returncode == 1
    assert "pyproject.toml" in done.stdout


def test_a_file_from_elsewhere_has_an_entry_of_its_own(repository_files: list[str]) -> None:
    project = Project.from_directory(ROOT)
    own, found = set(), []
    for name in repository_files:
        about = name in ABOUT_LICENCES or name.startswith("LICENSES/") or name == _here()
        if about or not NOTICE.search((ROOT / name).read_bytes()):
            continue
        found.append(name)
        for info in project.reuse_info_of(ROOT / name):
            own |= {name for line in info.copyright_notices if "Lumitip" in str(line)}
    assert found == ["generators/lumitip_fab/site/three_licence.txt"]
    assert own == set(), "REUSE.toml has no entry for them"


def test_the_licence_is_the_same_in_both_places() -> None:
    assert (ROOT / "LICENSE").read_bytes() == (ROOT / "LICENSES/Apache-2.0.txt").read_bytes()


def _here() -> str:
    return str(Path(__file__).relative_to(ROOT))
