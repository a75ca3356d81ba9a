"""A copy of the repository's files, and what is built from it."""

import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from release.dist import build_dist

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def repository_files() -> list[str]:
    """Paths of all files that git tracks: what tests leave in the folder is not among them."""
    if not (ROOT / ".git").exists():
        pytest.skip("this folder is no clone: git clone the repository")
    command = ["git", "-c", "safe.directory=*", "ls-files"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return [name for name in listed.splitlines() if (ROOT / name).is_file()]


@pytest.fixture(scope="session")
def copy_repository(repository_files: list[str]) -> Callable[[Path], Path]:
    """Copies those files into a folder, with new times; returns the folder."""

    def copy(folder: Path) -> Path:
        for name in repository_files:
            target = folder / name
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / name, target)
            target.chmod(
                0o777 & ~_umask() if os.access(ROOT / name, os.X_OK) else 0o666 & ~_umask()
            )
        return folder

    return copy


@pytest.fixture(scope="session")
def dist(
    copy_repository: Callable[[Path], Path], tmp_path_factory: pytest.TempPathFactory
) -> tuple[Path, Path]:
    """Sdist and wheel. Do not change them."""
    folder = tmp_path_factory.mktemp("release")
    return build_dist(copy_repository(folder / "source"), folder / "dist")


def _umask() -> int:
    current = os.umask(0)
    os.umask(current)
    return current
