"""Signals to commands that write files: the file is whole, or there is none."""

import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip.frame import Frame
from lumitip.recording import Reader

pytestmark = pytest.mark.usefixtures("hangups")


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 0), (signal.SIGHUP, 0)]
)
def test_record_ends_whole_when_it_is_interrupted(tmp_path: Path, number: int, status: int) -> None:
    path = tmp_path / "run.mcap"
    command = [sys.executable, "-m", "lumitip.cli", "record", "twin://demo?rate=300", str(path)]
    worker = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert worker.stdout is not None
    assert "recording to" in worker.stdout.readline()
    time.sleep(0.5)
    worker.send_signal(number)
    said, _ = worker.communicate(timeout=20)
    assert worker.returncode == status
    reader = Reader(path)
    frames = list(reader)
    assert said == f"{len(frames)} frames recorded\n" and len(frames) > 20


@pytest.mark.slow
def test_record_goes_on_without_its_terminal_where_nohup_has_asked_for_it(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    command = ["nohup", sys.executable, "-m", "lumitip.cli", "record"]
    with subprocess.Popen(
        [*command, "twin://demo?rate=300", str(path)], stdout=subprocess.PIPE, text=True
    ) as worker:
        assert worker.stdout is not None
        assert "recording to" in worker.stdout.readline()
        worker.send_signal(signal.SIGHUP)
        with pytest.raises(subprocess.TimeoutExpired):
            worker.wait(timeout=1.0)
        worker.send_signal(signal.SIGTERM)
        assert worker.wait(timeout=20) == 0
    assert len(list(Reader(path))) > 100


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, -15), (signal.SIGHUP, -1)]
)
def test_a_file_that_is_not_finished_is_removed(
    make_frames: Callable[..., list[Frame]],
    record: Callable[..., Path],
    tmp_path: Path,
    number: int,
    status: int,
) -> None:
    path, new = record(make_frames(5000)), tmp_path / "new.mcap"
    command = [sys.executable, "-m", "lumitip.cli", "foxglove", f"left={path}", "--out", str(new)]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as worker:
        while not new.exists():
            assert worker.poll() is None
            time.sleep(0.01)
        worker.send_signal(number)
        if number == signal.SIGHUP:  # a shell and the system both send it
            time.sleep(0.005)
            worker.send_signal(number)
        _, errors = worker.communicate(timeout=60)
    assert (worker.returncode, errors) == (status, "")
    assert not new.exists()
