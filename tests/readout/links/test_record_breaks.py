"""`lumitip record` while a device is silent, comes back, or is another one."""

import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip.cli import main
from lumitip.recording import Reader
from serial_line import Line

Until = Callable[..., None]


@pytest.fixture
def layout_file(device, tmp_path: Path) -> Path:
    path = tmp_path / "layout.json"
    path.write_text(device.layout.to_json(), encoding="utf-8")
    return path


def _sending(line: Line, device, *pauses_s: float) -> threading.Thread:
    """Sends two frames after each pause."""

    def send() -> None:
        for number, pause_s in enumerate(pauses_s):
            time.sleep(pause_s)
            line.send(device.packet(2 * number, 2))

    thread = threading.Thread(target=send)
    thread.start()
    return thread


def _record(line: Line, layout_file: Path, path: Path, seconds: float) -> int:
    arguments = ["record", f"serial://{line.path}", str(path), "--layout", str(layout_file)]
    return main([*arguments, "--seconds", str(seconds)])


@pytest.mark.slow
def test_a_silence_is_said_and_its_end(
    line: Line, device, layout_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sender = _sending(line, device, 0.3, 1.7)
    assert _record(line, layout_file, tmp_path / "run.mcap", 2.5) == 0
    sender.join()
    said, warned = capsys.readouterr()
    assert "no frame for 1 s: " in warned and "is connected but sends nothing" in warned
    assert "frames come again, after 1." in warned
    assert f"its layout is {layout_file}" in said
    assert "4 frames recorded" in said and "silent for 1." in said


@pytest.mark.slow
def test_a_recording_that_ends_silent_is_no_success(
    line: Line, device, layout_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sender = _sending(line, device, 0.2)
    assert _record(line, layout_file, tmp_path / "run.mcap", 1.8) == 1
    sender.join()
    said, warned = capsys.readouterr()
    assert warned.count("no frame for 1 s") == 1 and "come again" not in warned
    assert "2 frames recorded, silent for 1." in said
    assert len(list(Reader(tmp_path / "run.mcap"))) == 2


@pytest.mark.slow
@pytest.mark.parametrize("seconds", [0.4, 1.5])
def test_a_device_that_never_sends_leaves_no_file_behind(
    line: Line, layout_file: Path, tmp_path: Path, seconds: float
) -> None:
    assert _record(line, layout_file, tmp_path / "run.mcap", seconds) == 1
    assert not (tmp_path / "run.mcap").exists()


def test_another_device_leaves_no_file_behind(
    line: Line, device, layout_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    device.design = "beef" * 16
    sender = _sending(line, device, 0.3)
    assert _record(line, layout_file, tmp_path / "run.mcap", 5.0) == 2
    sender.join()
    assert "design beef" in capsys.readouterr().err
    assert not (tmp_path / "run.mcap").exists()
