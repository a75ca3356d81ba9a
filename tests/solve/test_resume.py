"""The same front on cores, on a Dask cluster, and after a search was killed and started again."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from goals_file import write_goals
from lumitip_fab.explore.evaluate import NAME
from lumitip_fab.solve.goals import read_goals
from lumitip_fab.solve.search import Search, search

pytestmark = pytest.mark.slow

GOALS = """\
[goals]
edge_mm = 0.12
gaps_mm = [3.0]
cables_mm = []
[vary]
mask.hole_mm = {{ from = 2.0, to = 5.0, step = 0.5 }}
emitter.current_ma = [12.8, 16.0, 19.2]
"""
DESIGNS = 12
"""Of 21: the genetic search chooses them, not the order of all combinations."""


@pytest.fixture(scope="module")
def goals(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_goals(tmp_path_factory.mktemp("goals"), GOALS)


def _searched(goals: Path, out: Path, scheduler: str | None = None) -> Search:
    return search(read_goals(goals), out, DESIGNS, 0, scheduler, lambda *_: None)


@pytest.fixture(scope="module")
def found(goals: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Search, int]:
    """A search without a stop, and how many records its journal has."""
    out = tmp_path_factory.mktemp("whole")
    search = _searched(goals, out)
    assert search.front and not search.complete
    return search, (out / NAME).read_bytes().count(b"\n")


@pytest.mark.filterwarnings("ignore")
def test_a_cluster_finds_the_same_front(
    goals: Path, found: tuple[Search, int], cluster: str, tmp_path: Path
) -> None:
    whole, records = found
    on_cluster = _searched(goals, tmp_path, cluster)
    assert on_cluster.evaluated == records
    assert on_cluster.designs == whole.designs
    assert on_cluster.front == whole.front


def test_a_killed_search_goes_on_to_the_same_front(
    goals: Path, found: tuple[Search, int], tmp_path: Path
) -> None:
    journal, deadline = tmp_path / "out" / NAME, time.monotonic() + 300.0
    command = [sys.executable, "-m", "lumitip_fab", "design", str(goals), "--quiet"]
    command += ["--designs", str(DESIGNS), "--out", str(tmp_path / "out")]
    with subprocess.Popen(command, start_new_session=True) as victim:
        while not (journal.exists() and journal.read_bytes().count(b"\n") > 2):
            assert time.monotonic() < deadline and victim.poll() is None
            time.sleep(0.02)
        os.killpg(victim.pid, signal.SIGKILL)
    known = journal.read_bytes().count(b"\n")
    assert not (tmp_path / "out/study.json").exists(), "killed before its end"
    whole, records = found
    resumed = _searched(goals, tmp_path / "out")
    assert resumed.evaluated == records - known
    assert resumed.designs == whole.designs
    assert resumed.front == whole.front
