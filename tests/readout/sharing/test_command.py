"""`lumitip serve` as it is typed: one finger for view, recorder and controller at once."""

import json
import os
import re
import signal
import socket
import subprocess
import sys
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import numpy as np
import pytest

from lumitip import Fingertip
from lumitip.cli import main
from lumitip.recording import Reader

Start = Callable[..., "subprocess.Popen[str]"]


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    """`start("serve", …)`: a command in a process of its own."""
    with ExitStack() as stack:

        def run(*arguments: str) -> "subprocess.Popen[str]":
            process = stack.enter_context(
                subprocess.Popen(
                    [sys.executable, "-m", "lumitip.cli", *arguments],
                    cwd=tmp_path,
                    env=os.environ | {"XDG_DATA_HOME": str(tmp_path / "data")},
                    stdout=subprocess.PIPE,
                    stderr=subprocess.PIPE,
                    text=True,
                )
            )
            stack.callback(process.kill)
            return process

        yield run


def _address(process: "subprocess.Popen[str]") -> str:
    assert process.stdout
    line = process.stdout.readline()
    found = re.search(r"(tcp|http)://\S+", line)
    assert found, line
    return found[0]


@pytest.mark.slow
def test_view_recorder_and_controller_use_one_finger(start: Start, tmp_path: Path) -> None:
    server = start("serve", "twin://cable?rate=200", "--port", "0")
    address = _address(server)
    view = start("view", address, "--port", "0")
    record = start("record", address, "run.mcap", "--frames", "150")
    with Fingertip.open(address, timeout=60.0) as tip:
        seqs = [tip.wait_latest(60.0).seq for _ in range(50)]
        assert (np.diff(seqs) > 0).all()
        url = _address(view)
        (finger,) = json.load(urllib.request.urlopen(f"{url}api/fingers", timeout=60))
        assert len(finger["x_mm"]) == 32
        assert record.wait(timeout=60) == 0
        view.send_signal(signal.SIGINT)
        assert view.wait(timeout=60) == 130
        tip.wait_latest(60.0)
        server.send_signal(signal.SIGINT)
        output, errors = server.communicate(timeout=60)
    assert (server.returncode, output, errors) == (130, "", "")
    reader = Reader(tmp_path / "run.mcap")
    assert reader.metadata.device_id == "twin:cable"
    assert [frame.dropped_before for frame in reader][1:] == [0] * 149


@pytest.mark.slow
def test_a_taken_port_is_one_line_that_says_what_to_do(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert main(["serve", "twin://demo", "--port", str(port)]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"lumitip: 127.0.0.1:{port} is taken: another program listens there")
    assert error.count("\n") == 1


def test_a_fault_of_the_address_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["serve", "twin://pyramid", "--port", "0"]) == 2
    assert "there is no shape 'pyramid'" in capsys.readouterr().err
    assert main(["serve", "replay://run.mcap"]) == 2
    error = capsys.readouterr().err
    assert "each program can open it without a server. ble://, serial://, tcp:// and twin" in error


@pytest.mark.parametrize("command", ["serve", "tare"])
def test_the_help_lists_no_address_that_is_refused(
    command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        main([command, "--help"])
    arguments = capsys.readouterr().out.partition("positional arguments:")[2]
    assert "twin://SHAPE" in arguments and "replay://" not in arguments
    with pytest.raises(SystemExit):
        main(["record", "--help"])
    assert "replay://FILE" in capsys.readouterr().out
