"""Lock files name the versions of constraints.txt, with hashes."""

import re
import shutil
from pathlib import Path

import pytest

from release.changes import ReleaseError
from release.lock import LOCKS, lock_faults, pins

ROOT = Path(__file__).parents[2]


@pytest.fixture
def copied(tmp_path: Path) -> Path:
    """A folder with the files that belong together."""
    for name in (*LOCKS, "constraints.txt", "pyproject.toml"):
        shutil.copy(ROOT / name, tmp_path)
    return tmp_path


def test_lock_files_agree_with_constraints_and_pyproject() -> None:
    assert list(lock_faults(ROOT)) == []


@pytest.mark.parametrize("name", LOCKS)
def test_another_version_in_a_lock_file_is_found(copied: Path, name: str) -> None:
    _replace(copied / name, r"^numpy==[\d.]+", "numpy==1.99.0")
    assert [fault for fault in lock_faults(copied) if "numpy is 1.99.0" in fault]


@pytest.mark.parametrize("name", LOCKS)
def test_a_missing_hash_is_found(copied: Path, name: str) -> None:
    _replace(copied / name, r"^(numpy==[\d.]+) \\\n(?:    --hash.*\n)+", r"\1\n")
    (fault,) = lock_faults(copied)
    assert re.search(r"numpy==[\d.]+ has no hash", fault)


def test_a_new_dependency_without_a_lock_is_found(copied: Path) -> None:
    _replace(copied / "pyproject.toml", r'"pyserial>=3.5"', '"pyserial>=99", "new-one>=1"')
    faults = "\n".join(lock_faults(copied))
    assert "requirements-readout.lock: pyserial>=99 is asked for, 3" in faults
    assert "requirements.lock: new-one>=1 is asked for, nothing is locked" in faults
    assert "requirements-fab.lock" not in faults


def test_a_package_that_only_constraints_has_is_found(copied: Path) -> None:
    with (copied / "constraints.txt").open("a", encoding="utf-8") as file:
        file.write("one-more==1.0\n")
    assert list(lock_faults(copied)) == ["requirements.lock: one-more is missing"]


def test_an_empty_lock_file_says_what_to_do() -> None:
    with pytest.raises(ReleaseError, match="make lock"):
        pins("# nothing\n")


def _replace(file: Path, pattern: str, new: str) -> None:
    text, count = re.subn(pattern, new, file.read_text(encoding="utf-8"), count=1, flags=re.M)
    assert count == 1
    file.write_text(text, encoding="utf-8")
