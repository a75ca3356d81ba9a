"""Built designs that many tests read; a test that changes files works on a copy."""

import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from lumitip_fab.build import build
from lumitip_fab.checks.run import modules_reading, run_checks

DESIGN = Path(__file__).parents[1] / "design"


@pytest.fixture(scope="session")
def design_dir() -> Path:
    """The repository's design folder."""
    return DESIGN


@pytest.fixture(scope="session")
def built(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """`built("dense")`: the output folder of a preset, built once a session. Do not change it."""
    folders: dict[str, Path] = {}

    def get(preset: str) -> Path:
        if preset not in folders:
            out = tmp_path_factory.mktemp(preset)
            build(DESIGN / "presets" / f"{preset}.toml", out)
            folders[preset] = out
        return folders[preset]

    return get


@pytest.fixture(scope="session")
def outputs(built: Callable[[str], Path]) -> Path:
    """The published design, built. Do not change it: `damaged` is a copy."""
    return built("published")


@pytest.fixture
def damaged(outputs: Path, tmp_path: Path) -> Path:
    """A copy of the published design's files, to damage."""
    return Path(shutil.copytree(outputs, tmp_path / "damaged"))


@pytest.fixture(scope="session")
def failing(outputs: Path) -> Callable[[Path], set[str]]:
    """`failing(damaged)`: names of the checks that fail on a damaged copy of `outputs`.

    Only the modules that open a changed file are run: the others see what they passed before.
    """

    def names(folder: Path) -> set[str]:
        paths = {str(f.relative_to(d)) for d in (outputs, folder) for f in d.rglob("*.*")}
        changed = [p for p in sorted(paths) if _bytes(outputs / p) != _bytes(folder / p)]
        assert changed, "nothing was damaged"
        return {m.check for m in run_checks(folder, modules_reading(changed)).failed}

    return names


def _bytes(path: Path) -> bytes | None:
    return path.read_bytes() if path.is_file() else None


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport() -> Iterator[None]:
    """With `LUMITIP_REQUIRE=all` a test that is skipped, for want of a tool, fails."""
    outcome = yield
    report = outcome.get_result()
    if report.skipped and os.environ.get("LUMITIP_REQUIRE") == "all":
        report.outcome = "failed"
        report.longrepr = f"skipped, but LUMITIP_REQUIRE=all: {report.longrepr}"
