"""`lumitip view` as it is typed."""

import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from websockets.sync.client import connect

from lumitip.cli import main
from lumitip.links.twin import published_layout
from lumitip.recording import Reader
from lumitip.sharing import FingertipServer
from lumitip.view.registry import FingerRegistry
from lumitip.view.server import ViewServer


@contextmanager
def running(
    folder: Path, *arguments: str, stderr: int | None = None
) -> Iterator[tuple["subprocess.Popen[str]", str]]:
    """The command in a process of its own, and the address that it prints."""
    command = [sys.executable, "-m", "lumitip.cli", "view", "--port", "0", *arguments]
    environment = os.environ | {"XDG_DATA_HOME": str(folder / "data")}
    with subprocess.Popen(
        command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=stderr, text=True
    ) as process:
        assert process.stdout
        try:
            found = re.search(r"http://\S+", process.stdout.readline())
            assert found
            yield process, found[0]
        finally:
            process.kill()


def test_two_words_show_a_demonstration_and_ctrl_c_ends_it(tmp_path: Path) -> None:
    with running(tmp_path, "twin://demo") as (process, url):
        assert url.startswith("http://127.0.0.1:")
        (finger,) = json.load(urllib.request.urlopen(f"{url}api/fingers", timeout=10))
        assert len(finger["x_mm"]) == 32
        assert b"<title>Lumitip</title>" in urllib.request.urlopen(url, timeout=10).read()
        told = urllib.request.Request(
            f"{url}api/fingers/1/record", b'{"on": true}', {"Origin": url.rstrip("/")}
        )
        name = json.load(urllib.request.urlopen(told, timeout=10))["file"]
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=20) == 130
    reader = Reader(tmp_path / "recordings" / name)
    assert reader.layout == published_layout()
    assert reader.metadata.device_id == "twin:demo"


@pytest.mark.parametrize("apart_s", [0.01, 0.1])
def test_ctrl_c_twice_with_a_page_open_ends_it_in_silence(tmp_path: Path, apart_s: float) -> None:
    with running(tmp_path, "twin://demo", stderr=subprocess.PIPE) as (process, url):
        here = url.rstrip("/")
        with connect(f"{here.replace('http', 'ws')}/stream", origin=here) as page:
            page.recv(timeout=30)
            process.send_signal(signal.SIGINT)
            time.sleep(apart_s)
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=30)
    assert (process.returncode, errors) == (130, "")


@pytest.mark.slow
@pytest.mark.usefixtures("hangups")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_a_recording_of_the_view_whole(tmp_path: Path, number: int) -> None:
    with running(tmp_path, "twin://demo?rate=300") as (process, url):
        begin = urllib.request.Request(
            f"{url}api/fingers/1/record", b'{"on": true}', {"Origin": url.rstrip("/")}
        )
        name = json.load(urllib.request.urlopen(begin, timeout=10))["file"]
        time.sleep(0.5)
        process.send_signal(number)
        assert process.wait(timeout=20) == -number
    assert list(Reader(tmp_path / "recordings" / name)), "it is whole, or this raises"


def test_ctrl_c_before_the_server_listens_to_signals_ends_it_in_silence(tmp_path: Path) -> None:
    program = """
import os, signal, uvicorn
from lumitip import cli

find = uvicorn.Config.get_loop_factory

def find_and_interrupt(config):
    os.kill(os.getpid(), signal.SIGINT)
    return find(config)

uvicorn.Config.get_loop_factory = find_and_interrupt
cli.run()
"""
    done = subprocess.run(
        [sys.executable, "-c", program, "view", "twin://demo", "--port", "0"],
        cwd=tmp_path,
        env=os.environ | {"XDG_DATA_HOME": str(tmp_path / "data")},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stderr) == (130, "")


def taken(port: int, capsys: pytest.CaptureFixture[str]) -> str:
    """The message of the command that this port is taken, without its beginning."""
    assert main(["view", "twin://demo", "--port", str(port)]) == 2
    error = capsys.readouterr().err
    before = f"lumitip: 127.0.0.1:{port} is taken: "
    assert error.startswith(before)
    assert error.endswith("choose another --port; port 0 is any free one\n")
    return error.removeprefix(before)


@pytest.mark.slow
def test_a_port_of_a_mute_program_says_what_to_do_within_seconds(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        began = time.monotonic()
        error = taken(other.getsockname()[1], capsys)
    assert time.monotonic() < began + 4.5  # of a busy computer
    assert error.startswith("another program listens there. End it, or")


def test_a_port_of_a_shared_fingertip_says_its_name(capsys: pytest.CaptureFixture[str]) -> None:
    with FingertipServer("twin://disc", port=0) as server:
        address = server.address
        error = taken(int(address.rpartition(":")[2]), capsys)
    assert error.startswith(f"`lumitip serve` shares twin:disc there. Open {address} instead, or")


@pytest.mark.slow
@pytest.mark.parametrize("token", [None, "secret"])
def test_a_port_of_another_live_view_says_so(
    token: str | None, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    with ViewServer(FingerRegistry((), tmp_path), port=0, token=token) as server:
        error = taken(server.port, capsys)
    assert error.startswith("`lumitip view` listens there. Open the page that it has printed, or")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["twin://nothing"], "allowed are demo"),
        (["twin://demo", "nonsense"], "one like"),
        (["replay://none.mcap"], "cannot be read"),
        (["replay://"], "has no file; one like replay://run.mcap is needed"),
        (["twin://demo", "--host", "203.0.113.1", "--port", "0"], "cannot be used"),
        (["twin://demo", "--port", "70000"], "allowed are 0 to 65535"),
        (["twin://demo", "--rerun", "no/run.rrd"], "there is no folder no. Create it first"),
        (["twin://demo", "--rerun", "/proc/run.rrd"], "cannot be written"),
        (["twin://demo", "--rerun", "run.mcap"], "must end in .rrd"),
        (["--rerun", "twin://demo", "twin://demo"], "write --rerun after the addresses"),
        (["twin://demo", "--gap", "50"], "gap is 50.0; a number from 0.5 to 20 is needed"),
        (["twin://demo", "--diameter", "0"], "diameter is 0.0; a number from 0.3 to 200"),
    ],
)
def test_what_cannot_be_shown_is_told(
    arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["view", *arguments]) == 2
    assert told in capsys.readouterr().err


def test_a_file_for_rerun_is_never_overwritten(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    file = tmp_path / "run.rrd"
    file.write_text("mine", encoding="utf-8")
    assert main(["view", "twin://demo", "--rerun", str(file)]) == 2
    assert "the file exists. Choose another name" in capsys.readouterr().err
    assert file.read_text(encoding="utf-8") == "mine"


def test_a_folder_in_which_nothing_can_be_recorded_is_refused_at_the_start(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "notes").write_text("a file")
    for folder in (tmp_path / "notes", tmp_path / "notes" / "deeper"):
        assert main(["view", "twin://demo", "--folder", str(folder)]) == 2
        printed = capsys.readouterr()
        assert f"--folder {folder}: {tmp_path / 'notes'} is not a folder" in printed.err
        assert printed.out == ""
