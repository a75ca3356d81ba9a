"""The examples of processing and recording run as they say."""

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[3] / "examples"


def _run(name: str, *arguments: str) -> str:
    command = [sys.executable, "-W", "error", str(EXAMPLES / name), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_processing_tells_what_is_between_the_fingers() -> None:
    lines = _run("processing.py", "twin://cable?rate=400", "60").splitlines()
    assert len(lines) == 60
    assert any("cable at" in line and "mm wide" in line for line in lines)


@pytest.mark.slow
def test_a_recording_is_made_read_and_processed_as_a_whole(tmp_path: Path) -> None:
    path = str(tmp_path / "run.mcap")
    said = _run("record_and_read.py", "twin://edge?rate=100", path)
    assert "frames of twin:edge, 0 lost on the way" in said
    frames = int(said.split()[0])
    assert 150 < frames < 230
    said = _run("processing_batch.py", path)
    assert said.startswith(f"{frames} frames, ")
    assert "dark centre x" in said
