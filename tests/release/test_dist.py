"""Wheel and sdist: the same bytes from the same source, and everything that they need."""

import os
import tarfile
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from release.changes import ReleaseError, newest_release, release_time_s
from release.dist import build_dist

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]


@pytest.fixture
def strict_umask() -> Iterator[None]:
    """New files are readable by their owner alone."""
    before = os.umask(0o077)
    yield
    os.umask(before)


@pytest.mark.usefixtures("strict_umask")
def test_another_folder_another_time_and_another_umask_make_the_same_bytes(
    dist: tuple[Path, Path],
    copy_repository: Callable[[Path], Path],
    tmp_path: Path,
) -> None:
    source = copy_repository(tmp_path / "elsewhere" / "with another name")
    (source / "outputs" / "bom.csv").touch()
    for file in source.rglob("*.py"):
        os.utime(file, (1_000_000_000, 1_000_000_000))
    again = build_dist(source, tmp_path / "dist")
    for first, second in zip(dist, again, strict=True):
        assert first.name == second.name
        assert first.read_bytes() == second.read_bytes(), first.name


def test_a_changed_source_makes_another_wheel(
    dist: tuple[Path, Path], copy_repository: Callable[[Path], Path], tmp_path: Path
) -> None:
    source = copy_repository(tmp_path / "source")
    (source / "readout/lumitip/py.typed").write_text("changed\n", encoding="utf-8")
    again = build_dist(source, tmp_path / "dist")
    assert dist[1].read_bytes() != again[1].read_bytes()


def test_the_sdist_has_the_whole_repository_and_the_date_of_the_release(
    dist: tuple[Path, Path], repository_files: list[str]
) -> None:
    version, _ = newest_release(ROOT)
    with tarfile.open(dist[0]) as sdist:
        files = [member for member in sdist.getmembers() if member.isfile()]
    names = {member.name.removeprefix(f"lumitip-{version}/") for member in files}
    assert names == {*repository_files, "PKG-INFO"}
    assert {member.mtime for member in files} == {release_time_s(ROOT)}
    assert {member.mode for member in files} <= {0o644, 0o755}


def test_the_wheel_has_every_file_of_both_packages_and_of_the_design(
    dist: tuple[Path, Path], repository_files: list[str]
) -> None:
    moved = {
        "generators/lumitip_fab/": "lumitip_fab/",
        "readout/lumitip/": "lumitip/",
        "design/": "lumitip_fab/_design/",
        "readout/firmware/": "lumitip_fab/_firmware/",
    }
    expected = {
        name.replace(folder, inside, 1)
        for name in repository_files
        for folder, inside in moved.items()
        if name.startswith(folder)
    }
    with zipfile.ZipFile(dist[1]) as wheel:
        names = {name for name in wheel.namelist() if ".dist-info/" not in name}
    assert names == expected


def test_a_version_that_the_changelog_does_not_have_is_rejected(
    copy_repository: Callable[[Path], Path], tmp_path: Path
) -> None:
    source = copy_repository(tmp_path / "source")
    file = source / "CHANGELOG.md"
    text = file.read_text(encoding="utf-8")
    version, day = newest_release(ROOT)
    file.write_text(text.replace(f"[{version}] - {day}", f"[99.0.0] - {day}"), encoding="utf-8")
    with pytest.raises(ReleaseError, match=r"99\.0\.0"):
        build_dist(source, tmp_path / "dist")
    file.write_text("# Changelog\n", encoding="utf-8")
    with pytest.raises(ReleaseError, match="no heading"):
        build_dist(source, tmp_path / "dist")
