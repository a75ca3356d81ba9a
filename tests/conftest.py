"""Built designs that many tests read; a test that changes files works on a copy."""

import fcntl
import os
import shutil
import signal
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from lumitip_fab.checks.run import modules_reading, run_checks
from lumitip_fab.cli.build import build
from panelled_boards import write_panelled
from turns import VARIABLE, waiting

TESTS = Path(__file__).parent
DESIGN = TESTS.parent / "design"
Once = Callable[[str, Callable[[Path], object]], Path]
LONGEST = (
    "acceptance/test_cases.py",
    "boards/test_kicad.py",
    "checks/test_grippers.py",
    "checks/test_finger_fem.py",
    "checks/test_unusual.py",
    "checks/test_patches.py",
    "checks/test_presets.py",
    "documents/test_tutorials.py",
    "fab/test_build.py",
    "fab/test_slice.py",
    "mutations/test_mutators.py",
    "mutations/test_trial.py",
    "solve/test_points.py",
    "solve/test_resume.py",
)
"""Test files that take longest, in this order before all others: a worker has a file to itself, and
none is to begin a long one when the rest is done."""


@pytest.fixture(scope="session")
def design_dir() -> Path:
    """The repository's design folder."""
    return DESIGN


@pytest.fixture(scope="session")
def once(tmp_path_factory: pytest.TempPathFactory) -> Once:
    """`once("dense", make)`: a folder that `make` fills once a run, by whichever worker needs it
    first. Do not change it."""
    own = tmp_path_factory.getbasetemp()
    root = own.parent if "PYTEST_XDIST_WORKER" in os.environ else own

    def get(name: str, make: Callable[[Path], object]) -> Path:
        folder, part = root / f"once-{name}", root / f"{name}.part"
        with (root / f"{name}.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not folder.is_dir():
                shutil.rmtree(part, ignore_errors=True)  # of a worker that failed
                part.mkdir()
                make(part)
                part.rename(folder)
        return folder

    return get


@pytest.fixture(scope="session")
def built(once: Once) -> Callable[[str], Path]:
    """`built("dense")`: the output folder of a preset, `built("fingertip")` that of the default
    design. Do not change it."""

    def get(design: str) -> Path:
        folder = DESIGN if design == "fingertip" else DESIGN / "presets"
        return once(design, lambda out: build(folder / f"{design}.toml", out))

    return get


@pytest.fixture(scope="session")
def outputs(built: Callable[[str], Path]) -> Path:
    """The published design, built. Do not change it: `damaged` is a copy."""
    return built("published")


@pytest.fixture(scope="session")
def panelled(once: Once) -> Path:
    """Receiver and flange of a small design, each with its panel. Do not change it."""
    return once("panelled", lambda out: write_panelled(DESIGN, out))


@pytest.fixture(scope="module")
def cluster() -> Iterator[str]:
    """A Dask scheduler with two worker processes; its address."""
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2,
        threads_per_worker=1,
        processes=True,
        dashboard_address=None,
        host="127.0.0.1",
        protocol="tcp",
    ) as running:
        yield str(running.scheduler_address)


@pytest.fixture
def damaged(outputs: Path, tmp_path: Path) -> Path:
    """A copy of the published design's files, to damage."""
    return Path(shutil.copytree(outputs, tmp_path / "damaged"))


@pytest.fixture(scope="session")
def failing(outputs: Path) -> Callable[[Path], set[str]]:
    """`failing(damaged)`: names of the checks that fail on a damaged copy of `outputs`.

    Only the modules that open a changed file are run: the others see what they passed before.
    The manifest, which lists the hash of every file, is left out unless it is what was damaged:
    a damage is to be found in the file itself.
    """

    def names(folder: Path) -> set[str]:
        paths = {str(f.relative_to(d)) for d in (outputs, folder) for f in d.rglob("*.*")}
        changed = [p for p in sorted(paths) if _bytes(outputs / p) != _bytes(folder / p)]
        assert changed, "nothing was damaged"
        modules = set(modules_reading(changed)) - ({"manifest"} - set(map(_stem, changed)))
        return {m.check for m in run_checks(folder, sorted(modules)).failed}

    return names


def _stem(path: str) -> str:
    return Path(path).stem


def _bytes(path: Path) -> bytes | None:
    return path.read_bytes() if path.is_file() else None


def pytest_configure(config: pytest.Config) -> None:
    """Shells start what runs in the background deaf to Ctrl-C, and so would be what tests start.

    Where PYTHONDONTWRITEBYTECODE is set, as in many containers, each process that tests start would
    compile all that it imports. xdist would begin with the files of most tests, which are quick.
    When a worker crashes, xdist 3.8 queues the finished files again and may then wait for ever: the
    run ends with the crash instead.
    """
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    config.option.loadscopereorder = False
    config.option.maxworkerrestart = "0"
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_addoption(parser: pytest.Parser) -> None:
    """`--slow` runs all tests and all their cases; so does `LUMITIP_REQUIRE=all`."""
    parser.addoption("--slow", action="store_true", help="run slow tests and slow cases too")


def _whole(config: pytest.Config) -> bool:
    return config.getoption("--slow") or os.environ.get("LUMITIP_REQUIRE") == "all"


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Without that, they are left out, and with it those that wait for their turn. The longest
    files come first."""
    rank = {TESTS / file: place for place, file in enumerate(LONGEST)}
    items.sort(key=lambda item: rank.get(item.path, len(rank)))
    slow = set(_left_out(items))
    out = waiting(slow) if _whole(config) else slow
    config.hook.pytest_deselected(items=[item for item in items if item in out])
    items[:] = [item for item in items if item not in out]


def _left_out(items: list[pytest.Item]) -> Iterator[pytest.Item]:
    begun = set()
    for item in items:
        test = item.nodeid.partition("[")[0]
        if item.get_closest_marker("slow") or (
            item.get_closest_marker("slow_cases") and test in begun
        ):
            yield item
        begun.add(test)


def pytest_terminal_summary(
    terminalreporter: pytest.TerminalReporter, config: pytest.Config
) -> None:
    """Say what was left out, and how to run it."""
    if not _whole(config):
        terminalreporter.write_line(
            "Left out: slow tests (other presets, damaged files, KiCad, browser, robot arm); "
            "`LUMITIP_REQUIRE=all make test` runs everything, and fails where a tool is absent."
        )
    elif os.environ.get(VARIABLE):
        terminalreporter.write_line(
            f"Left out: slow tests but those of {VARIABLE}={os.environ[VARIABLE]}; without that "
            "variable all of them run."
        )


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport() -> Iterator[None]:
    """With `LUMITIP_REQUIRE=all` a test that is skipped, for want of a tool, fails."""
    outcome = yield
    report = outcome.get_result()
    if report.skipped and os.environ.get("LUMITIP_REQUIRE") == "all":
        report.outcome = "failed"
        report.longrepr = f"skipped, but LUMITIP_REQUIRE=all: {report.longrepr}"
