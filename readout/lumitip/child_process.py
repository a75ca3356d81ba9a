"""Processes of this package beside a program: `python -m MODULE`, with a pipe in each direction."""

import os
import subprocess
import sys


def start(module: str) -> "subprocess.Popen[str]":
    """Start a module that reads lines on its stdin and writes lines to its stdout.

    No `multiprocessing`: that would run the user's script a second time.

    Raises:
        OSError: if Python cannot be started.
    """
    ours = {"PYTHONPATH": os.pathsep.join(filter(None, sys.path)), "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.Popen(
        # Without -P a file of the current folder could stand in for a module.
        (sys.executable, "-P", "-m", module),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        encoding="utf-8",
        env=os.environ | ours,
        start_new_session=True,  # Ctrl-C is for the program, which ends the process
    )
