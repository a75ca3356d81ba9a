"""Every program in `examples/` runs."""

import os
import pty
import subprocess
import sys
import threading
import tty
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from fake_bluez import FakeBluez
from fingertip_peers import add_fingertip, send
from lumitip import Layout
from lumitip.protocol import cobs

ROOT = Path(__file__).parents[3]
EXAMPLES = ROOT / "examples"
TWIN = {
    "asyncio_frames.py": (["twin://disc"], "of 255 on the mean", 20),
    "callbacks.py": (["twin://corner"], "cells covered", 20),
    "read_frames.py": (["twin://cable"], "is darkest with", 20),
    "two_fingers.py": (["twin://disc", "twin://edge?rate=60"], "ms apart", 20),
}
LAYOUT = "readout/lumitip/links/published_layout.json"


def _run(name: str, *arguments: str, env: dict[str, str] | None = None) -> str:
    done = subprocess.run(
        [sys.executable, "-W", "error", EXAMPLES / name, *arguments],
        capture_output=True,
        text=True,
        timeout=60,
        cwd=ROOT,
        env={**os.environ, **(env or {})},
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return done.stdout


@contextmanager
def _sending(send: Callable[[int], None]) -> Iterator[None]:
    """Call `send` with 0, 1, 2, … some 200 times a second meanwhile."""
    over = threading.Event()

    def run() -> None:
        number = 0
        while not over.wait(0.005):
            send(number)
            number += 1

    sender = threading.Thread(target=run)
    sender.start()
    try:
        yield
    finally:
        over.set()
        sender.join()


@pytest.mark.slow_cases
@pytest.mark.parametrize("name", TWIN)
def test_examples_on_the_twin(name: str) -> None:
    arguments, line, least = TWIN[name]
    assert _run(name, *arguments).count(line) >= least


def test_read_layout() -> None:
    assert "32 cells 6.0 mm apart" in _run("read_layout.py", LAYOUT)


@pytest.fixture
def layout_file(layout: Layout, tmp_path: Path) -> str:
    path = tmp_path / "layout.json"
    path.write_text(layout.to_json(), encoding="utf-8")
    return str(path)


@pytest.mark.slow
def test_read_bluetooth(bluez: FakeBluez, device, layout_file: str) -> None:
    peer = add_fingertip(bluez, device)
    with _sending(lambda n: send(bluez, peer, device.packet(n))):
        told = _run("read_bluetooth.py", "ble://Lumitip", layout_file)
    assert told.startswith("connected: ble:C0:FF:EE:00:00:01, protocol 2")
    assert told.count("cells covered") >= 10


def test_read_serial(device, layout_file: str) -> None:
    master, slave = pty.openpty()
    tty.setraw(slave)

    def write(number: int) -> None:
        os.write(master, cobs.encode(device.packet(number)) + b"\0")

    with _sending(write):
        told = _run("read_serial.py", f"serial://{os.ttyname(slave)}", layout_file)
    os.close(master)
    os.close(slave)
    assert told.startswith("55 frames of 32 cells, 0 lost between")


def test_no_example_is_left_out() -> None:
    """Those of other areas are run by the tests of these areas."""
    tests = "".join(p.read_text("utf-8") for p in (ROOT / "tests" / "readout").rglob("test_*.py"))
    examples = sorted(path.name for path in EXAMPLES.glob("*.py"))
    assert examples and [name for name in examples if name not in tests] == []
