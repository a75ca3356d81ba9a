"""A command ends in order: while a daemon thread is within C++ code, as numpy's is, when something
drops the exception of Ctrl-C, and while it cleans up."""

import subprocess
import sys
from pathlib import Path

import pytest

from programs import program

SOURCE = 'extern "C" void call_for_ever(void (*callback)()) noexcept { for (;;) callback(); }\n'
"""A thread that Python stops in the callback unwinds this frame, which aborts the process."""
ENDS = """
import atexit, ctypes, sys, threading, time
from lumitip import cli

class SlowToEnd:
    def __del__(self, sleep=time.sleep):
        sleep(0.3)  # the thread comes to the interpreter while that ends

library = ctypes.CDLL("./caller.so")
callback = ctypes.CFUNCTYPE(None)(lambda: None)

def main():
    atexit.register(lambda: print("exit function", flush=True))
    sys.slow_to_end = SlowToEnd()
    threading.Thread(target=library.call_for_ever, args=(callback,), daemon=True).start()
    time.sleep(0.1)
    print("last line")
    return 7
"""


def test_a_daemon_thread_within_cpp_code_does_not_abort_a_command(tmp_path: Path) -> None:
    ended = _run(tmp_path, "cli.main = main\ncli.run()\n")
    assert (ended.returncode, ended.stderr) == (7, "")
    assert ended.stdout == "last line\nexit function\n"


def test_without_the_last_exit_function_python_aborts_it(tmp_path: Path) -> None:
    ended = _run(tmp_path, "sys.exit(main())\n")
    assert ended.returncode < 0
    assert "terminate called" in ended.stderr


def _run(folder: Path, end: str) -> "subprocess.CompletedProcess[str]":
    (folder / "caller.cpp").write_text(SOURCE, encoding="utf-8")
    compile_it = [program("g++"), "-shared", "-fPIC", "-o", "caller.so", "caller.cpp"]
    subprocess.run(compile_it, cwd=folder, check=True)
    return subprocess.run(
        [sys.executable, "-c", ENDS + end],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


DROPS = """
import os, signal, threading
from lumitip import cli

def run(_):
    try:
        os.kill(os.getpid(), signal.SIGINT)
        threading.Event().wait()
    except BaseException:
        print("dropped", flush=True)
    threading.Event().wait()

cli._run_command = run
cli.run()
"""
CLEANS = """
import os, signal, threading, time
from lumitip import cli

def run(_):
    try:
        os.kill(os.getpid(), signal.SIGINT)
        threading.Event().wait()
    finally:
        for _ in range(5):
            time.sleep(0.1)
        print("clean", flush=True)

cli._run_command = run
cli.run()
"""


@pytest.mark.parametrize(("code", "printed"), [(DROPS, "dropped\n"), (CLEANS, "clean\n")])
def test_an_interrupt_is_neither_lost_nor_raised_twice(code: str, printed: str) -> None:
    ended = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False
    )
    assert (ended.returncode, ended.stdout, ended.stderr) == (130, printed, "")
