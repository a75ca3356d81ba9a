"""The twin as a serial device, read by the serial link as a real one is."""

import subprocess
import sys
import time
from pathlib import Path

import pytest

from lumitip import Fingertip
from lumitip.cli import main
from lumitip.errors import LinkError
from lumitip.links.serve import SerialDevice
from lumitip.links.twin import Scene, packet_at, published_layout


def test_the_serial_link_reads_the_twin(tmp_path: Path) -> None:
    port = tmp_path / "tty"
    command = [
        sys.executable,
        "-m",
        "lumitip.cli",
        "twin",
        "twin://cable?rate=400&bits=10&speed=0",
        "--serve-serial",
        "--link",
        str(port),
    ]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=tmp_path) as device:
        try:
            assert device.stdout
            assert device.stdout.readline() == f"twin:cable: 32 cells on serial://{port}\n"
            with Fingertip.open(f"serial://{port}", published_layout(), timeout=20.0) as tip:
                block = tip.get_data(60, timeout=20.0)
        finally:
            device.terminate()
    assert block.dropped == 0
    assert block.raw.shape == (60, 32)
    assert block.values.min() < 60.0
    assert block.values.max() > 200.0


def test_what_nobody_reads_is_lost_and_stops_nothing(tmp_path: Path) -> None:
    layout, scene = published_layout(), Scene("empty", 0.0, 0.0, 100.0, 8, 0)
    port = tmp_path / "tty"
    with SerialDevice(port) as device:
        for number in range(0, 4000, 10):
            device.send(packet_at(layout, scene, number, 10))
        with Fingertip.open(f"serial://{port}", layout) as tip:
            frames = []
            tip.subscribe(frames.append)
            number = 4000
            while len(frames) < 100:
                device.send(packet_at(layout, scene, number, 10))
                number += 10
                time.sleep(0.01)
                assert number < 20000, "nothing comes"
        assert frames[0].t_device > 30.0, "the oldest is lost first"
        assert tip.stats.unreadable <= 1
    assert not port.is_symlink()


def test_a_path_that_is_taken_and_other_links_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "taken").write_text("mine", encoding="utf-8")
    with pytest.raises(LinkError, match="Choose another path"):
        SerialDevice(tmp_path / "taken")
    assert (tmp_path / "taken").read_text(encoding="utf-8") == "mine"
    assert main(["twin", "serial:///dev/null", "--serve-serial"]) == 2
    assert "like twin://demo is needed" in capsys.readouterr().err
    link = tmp_path / "tty"
    assert (
        main(["twin", "Twin://edge", "--serve-serial", "--link", str(link), "--seconds", "0.05"])
        == 0
    )
    assert not link.is_symlink()
