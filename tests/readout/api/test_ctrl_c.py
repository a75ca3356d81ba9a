"""Ctrl-C at any moment of every command: exit status 130 and no traceback."""

import os
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import ExitStack
from pathlib import Path

import pytest

from lumitip import Fingertip
from lumitip.links.twin import published_layout
from lumitip.recording import Writer

PROGRAM = """
from lumitip import cli

main = cli.main

def begun():
    print("begun", flush=True)
    return main()

cli.main = begun
cli.run()
"""
"""The whole command; it says when it has begun, before its slow imports."""
COMMANDS = {
    "scan": ["scan", "--seconds", "100"],
    "tare": ["tare", "twin://disc?rate=1", "--timeout", "100"],
    "doctor": ["doctor", "twin://disc", "--seconds", "100"],
    "view": ["view", "twin://demo", "--port", "0"],
    "record": ["record", "twin://demo", "new.mcap"],
    "info": ["info", "long.mcap"],
    "replay": ["replay", "long.mcap"],
    "export": ["export", "long.mcap", "new.csv"],
    "recover": ["recover", "long.mcap"],
    "serve": ["serve", "twin://demo", "--port", "0"],
    "twin": ["twin", "twin://demo", "--serve-serial"],
    "bench-tasks": ["bench-tasks", "--trials", "50", "--cores", "2", "--out", "results"],
}
ENDLESS = {"tare", "doctor", "view", "record", "replay", "serve", "twin", "bench-tasks"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a recording that takes a while to read."""
    folder = tmp_path_factory.mktemp("ctrl_c")
    with (
        Fingertip.open("twin://disc?rate=1000", calibrated=False) as tip,
        Writer(folder / "long.mcap", published_layout(), device_id="twin:disc") as writer,
    ):
        frames = [tip.read(10.0) for _ in range(100)]
        for _ in range(100):
            for frame in frames:
                writer.write(frame)
    return folder


def _interrupted(
    folder: Path,
    arguments: list[str],
    moment: float | threading.Event,
    number: int = signal.SIGINT,
) -> tuple[int, str]:
    """Exit status and errors of a command; its whole process group gets SIGINT, as on Ctrl-C, or
    another signal, some seconds after it has begun or on an event."""
    environment = os.environ | {"XDG_DATA_HOME": str(folder / "data")}
    with subprocess.Popen(
        [sys.executable, "-c", PROGRAM, *arguments],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        try:
            assert process.stdout and process.stdout.readline() == "begun\n"
            if isinstance(moment, threading.Event):
                assert moment.wait(60.0)
            else:
                time.sleep(moment)
            os.killpg(process.pid, number)
            _, errors = process.communicate(timeout=120)
        finally:
            process.kill()
    for name in ("new.mcap", "new.csv", "long.recovered.mcap"):
        (folder / name).unlink(missing_ok=True)
    return process.returncode, errors


@pytest.mark.slow_cases
@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("delay_s", [0.02, 0.2, 0.6, 2.0])
def test_ctrl_c_ends_a_command_in_silence(folder: Path, name: str, delay_s: float) -> None:
    status, errors = _interrupted(folder, COMMANDS[name], delay_s)
    assert "Traceback" not in errors
    assert "KeyboardInterrupt" not in errors
    if name in ENDLESS or delay_s < 0.1:
        assert status == 130, errors
    else:
        # It may have ended before; a signal while Python itself ends is 130 for a shell too.
        assert status in (0, 1, 130, -signal.SIGINT), errors


@pytest.mark.slow_cases
@pytest.mark.usefixtures("hangups")
@pytest.mark.parametrize("name", ["serve", "view", "tare", "twin"])
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("delay_s", [0.02, 2.0])
def test_other_signals_do_the_same(folder: Path, name: str, number: int, delay_s: float) -> None:
    assert _interrupted(folder, COMMANDS[name], delay_s, number) == (-number, "")


@pytest.mark.slow_cases
@pytest.mark.parametrize("command", ["doctor", "record", "view", "serve"])
@pytest.mark.parametrize("knows_layout", [True, False])
def test_ctrl_c_ends_a_command_that_connects(
    folder: Path, command: str, knows_layout: bool
) -> None:
    layout = folder / "layout.json"
    layout.write_text(published_layout().to_json(), encoding="utf-8")
    # The peer accepts, and never answers.
    with socket.create_server(("127.0.0.1", 0)) as silent, ExitStack() as stack:
        arguments = [command, f"tcp://127.0.0.1:{silent.getsockname()[1]}", "--timeout", "100"]
        arguments += ["new.mcap"] if command == "record" else []
        arguments += ["--layout", str(layout)] if knows_layout else []
        arguments += ["--port", "0"] if command in ("view", "serve") else []
        connected = threading.Event()

        def accept() -> None:
            stack.enter_context(silent.accept()[0])
            connected.set()

        threading.Thread(target=accept, daemon=True).start()
        status, errors = _interrupted(folder, arguments, connected)
    assert (status, errors) == (130, "")


def test_an_interrupt_within_a_destructor_ends_the_command_too() -> None:
    program = """
import os, signal, sys, time
from lumitip import cli

class Trap:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0.2)

def run(_):
    Trap()
    while True:
        time.sleep(0.01)

cli._run_command = run
print("ready", flush=True)
cli.run()
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, "ready\n", "")


@pytest.mark.parametrize("then", ["time.sleep(100)", "threading.Event().wait()"])
def test_an_import_that_drops_an_interrupt_does_not_keep_the_command(
    tmp_path: Path, then: str
) -> None:
    (tmp_path / "drops.py").write_text(
        """
import os, signal
try:
    os.kill(os.getpid(), signal.SIGINT)
    for _ in range(1000):
        pass
except BaseException:
    print("dropped", flush=True)
""",
        encoding="utf-8",
    )
    program = f"""
import threading, time
from lumitip import cli

def run(_):
    import drops
    {then}

cli._run_command = run
cli.run()
"""
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")


def test_an_interrupt_while_a_worker_starts_waits_until_it_has_started(tmp_path: Path) -> None:
    program = tmp_path / "start.py"
    program.write_text(
        """
import multiprocessing.util as util, os, signal, threading, time
from lumitip.tasks.bench import workers

spawn = util.spawnv_passfds

def spawn_and_interrupt(*arguments):
    ident = spawn(*arguments)
    os.kill(os.getpid(), signal.SIGINT)  # The worker has not yet been sent what it is to do.
    time.sleep(0.2)
    return ident

if __name__ == "__main__":
    # As a thread of numpy's library does: it takes a signal that the main thread blocks.
    threading.Thread(target=time.sleep, args=(3.0,), daemon=True).start()
    with workers(1) as pool:
        util.spawnv_passfds = spawn_and_interrupt
        try:
            pool.submit(abs, -1)
        except KeyboardInterrupt:
            print("interrupted", flush=True)
        util.spawnv_passfds = spawn
        print(pool.submit(abs, -2).result())
""",
        encoding="utf-8",
    )
    done = subprocess.run(
        [sys.executable, str(program)], capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "interrupted\n2\n", "")
