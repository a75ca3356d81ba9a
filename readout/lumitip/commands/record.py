"""`lumitip record`: write what a fingertip sends to a file."""

import argparse
import math
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from lumitip.commands.common import Subparsers, add_fingertip, open_fingertip, some, some_seconds

if TYPE_CHECKING:
    from lumitip.fingertip import Fingertip
    from lumitip.recording import Writer

_LOOK_S = 0.2  # without a frame, how long Ctrl-C may wait


def add(subparsers: Subparsers) -> None:
    """Say what the command takes."""
    told = "Record a fingertip as MCAP, which Foxglove, ROS 2 and rosbags open; Ctrl-C ends it."
    parser = subparsers.add_parser("record", help=told, description=told)
    add_fingertip(parser)
    parser.add_argument("file", type=Path, metavar="FILE", help="to write, ending in .mcap")
    parser.add_argument(
        "--seconds", type=some_seconds, default=math.inf, metavar="S", help="end after S"
    )
    parser.add_argument("--frames", type=some, default=math.inf, metavar="N", help="end after N")


def run(options: argparse.Namespace) -> int:
    """Carry it out."""
    from lumitip.recording import RecordingError, Writer

    if options.file.suffix != ".mcap":
        raise RecordingError(
            f"{options.file} given: without .mcap at its end no other program opens it"
        )
    with open_fingertip(options) as tip, _interrupts() as interrupted:
        writer = Writer(
            options.file, tip.layout, device_id=tip.device_id, calibration=tip.calibration
        )
        with writer:
            print(f"{tip.device_id}: recording to {options.file} (Ctrl-C ends it)", flush=True)
            _record(tip, writer, options, interrupted)
        lost = {k: n for k, n in tip.stats.dropped.items() if n} if tip.stats.dropped else {}
    told = "".join(f", {n} lost ({k})" for k, n in lost.items())
    print(f"{writer.frames} frames recorded{told}")
    return 0


def _record(
    tip: "Fingertip",
    writer: "Writer",
    options: argparse.Namespace,
    interrupted: threading.Event,
) -> None:
    from lumitip.errors import EndOfRecording, LinkTimeout

    until = time.monotonic() + options.seconds
    while not interrupted.is_set() and writer.frames < options.frames:
        left = until - time.monotonic()
        if left <= 0.0:
            return
        try:
            writer.write(tip.read(timeout=min(left, _LOOK_S)))
        except LinkTimeout:
            continue  # a link that was cut is being made again
        except EndOfRecording:
            return


@contextmanager
def _interrupts() -> Iterator[threading.Event]:
    """An event that Ctrl-C and `kill` set, so that neither breaks into the writing of a frame."""
    event = threading.Event()
    signals = (signal.SIGINT, signal.SIGTERM)
    before = [signal.signal(number, lambda *_: event.set()) for number in signals]
    try:
        yield event
    finally:
        for number, handler in zip(signals, before, strict=True):
            signal.signal(number, handler)
