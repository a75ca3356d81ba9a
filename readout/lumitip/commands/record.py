"""`lumitip record`: write the frames of a fingertip to a file."""

import argparse
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING

from lumitip.commands.common import open_fingertip
from lumitip.interrupt import INTERRUPTED

if TYPE_CHECKING:
    from lumitip.fingertip import Fingertip
    from lumitip.recording import Writer

_POLL_S = 0.2  # longest reaction time to Ctrl-C


def run(options: argparse.Namespace) -> int:
    """Record until Ctrl-C or a limit."""
    from lumitip.recording import RecordingError, Writer

    if options.file.suffix != ".mcap":
        raise RecordingError(
            f"the file is {options.file}; its name must end in .mcap, or other programs will not "
            "open it"
        )
    with open_fingertip(options) as tip, _interrupts() as interrupted:
        writer = Writer(
            options.file, tip.layout, device_id=tip.device_id, calibration=tip.calibration
        )
        with writer:
            print(f"{tip.device_id}: recording to {options.file} (Ctrl-C ends it)", flush=True)
            _record(tip, writer, options, interrupted)
        dropped = tip.stats.dropped
    counts = dropped.items() if dropped else ()
    lost = "".join(f", {n} lost ({cause})" for cause, n in counts if n)
    print(f"{writer.frames} frames recorded{lost}")
    return INTERRUPTED if interrupted.by == signal.SIGINT else 0


def _record(
    tip: "Fingertip",
    writer: "Writer",
    options: argparse.Namespace,
    interrupted: "_Interruption",
) -> None:
    from lumitip.errors import EndOfRecording, LinkTimeout

    until = time.monotonic() + options.seconds
    while interrupted.by is None and writer.frames < options.frames:
        left = until - time.monotonic()
        if left <= 0.0:
            return
        try:
            writer.write(tip.read(timeout=min(left, _POLL_S)))
        except LinkTimeout:
            continue  # the link reconnects
        except EndOfRecording:
            return


class _Interruption:
    """The first signal that ends the recording."""

    by: int | None = None

    def note(self, number: int, _: FrameType | None) -> None:
        """Handle a signal."""
        self.by = self.by or number


@contextmanager
def _interrupts() -> Iterator["_Interruption"]:
    """Notes SIGINT and SIGTERM, so that neither interrupts the writing of a frame."""
    interrupted = _Interruption()
    signals = (signal.SIGINT, signal.SIGTERM)
    before = [signal.signal(number, interrupted.note) for number in signals]
    try:
        yield interrupted
    finally:
        for number, handler in zip(signals, before, strict=True):
            signal.signal(number, handler)
