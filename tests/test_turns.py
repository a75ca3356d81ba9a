"""Each part of the slow tests is another one; the parts together are all of them."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from turns import turn

TESTS = Path(__file__).parent
LEFT_OUT = """\
from turns import waiting

def pytest_collection_modifyitems(items):
    out = waiting([item for item in items if item.get_closest_marker("slow")])
    items[:] = [item for item in items if item not in out]
"""
DESIGNS = """\
import pytest

@pytest.mark.slow
@pytest.mark.parametrize("preset", ["fingertip", "flex", "dense", "mux16", "wsg50"])
@pytest.mark.parametrize("board", [1, 2])
def test_board(preset, board): pass

@pytest.mark.slow
@pytest.mark.parametrize("columns", [3, 8])
def test_patch(columns): pass

@pytest.mark.slow
def test_random(): pass

def test_quick(): pass
"""
PARTS = 3


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "conftest.py").write_text(LEFT_OUT)
    (tmp_path / "test_designs.py").write_text(DESIGNS)
    (tmp_path / "pytest.ini").write_text("[pytest]\nmarkers = slow\n")
    return tmp_path


def collected(folder: Path, part: int, parts: int) -> set[str]:
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "--collect-only", "-p", "no:xdist"],
        cwd=folder,
        env=os.environ | {"LUMITIP_TURN": f"{part}/{parts}", "PYTHONPATH": str(TESTS)},
        capture_output=True,
        text=True,
        check=True,
    )
    return {line.partition("::")[2] for line in done.stdout.splitlines() if "::" in line}


@pytest.mark.slow
def test_every_slow_test_has_its_turn_once(folder: Path) -> None:
    every = collected(folder, 0, 1)
    parts = [collected(folder, part, PARTS) for part in range(PARTS)]
    always = {"test_quick", "test_board[1-fingertip]", "test_board[2-fingertip]"}
    assert len(every) == 14
    assert set.intersection(*parts) == always
    assert sorted(name for part in parts for name in part - always) == sorted(every - always)
    assert all(len(part) > len(always) for part in parts)


@pytest.mark.slow
def test_the_boards_of_a_preset_have_their_turn_together(folder: Path) -> None:
    for part in range(PARTS):
        names = collected(folder, part, PARTS)
        for preset in ("flex", "dense", "mux16", "wsg50"):
            assert len(names & {f"test_board[{board}-{preset}]" for board in (1, 2)}) in {0, 2}


@pytest.mark.parametrize("text", ["3/3", "one", "0/0", "-1/3", ""])
def test_a_turn_that_is_none_is_refused(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LUMITIP_TURN", text)
    with pytest.raises(pytest.UsageError, match="0/3, 1/3 or 2/3 is needed"):
        turn()
