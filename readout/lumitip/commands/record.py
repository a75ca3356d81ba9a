"""`lumitip record`: write the frames of a fingertip to a file."""

import argparse
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING

from lumitip.commands.common import layout_path, open_fingertip
from lumitip.interrupt import INTERRUPTED, ending_signals

if TYPE_CHECKING:
    from lumitip.fingertip import Fingertip
    from lumitip.recording import Writer

_POLL_S = 0.2  # longest reaction time to Ctrl-C
_SILENT_S = 1.0
"""Without a frame for so long, a message is printed."""


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
        silence = _Silence(tip.device_id)
        try:
            with writer:
                layout = layout_path(options, options.url)
                of = f", its layout is {layout}" if layout else ""
                print(
                    f"{tip.device_id}: recording to {options.file}{of} (Ctrl-C ends it)", flush=True
                )
                _record(tip, writer, options, interrupted, silence)
        finally:
            if not writer.frames:
                options.file.unlink(missing_ok=True)  # so that the next try has its name
        dropped = tip.stats.dropped
    counts = dropped.items() if dropped else ()
    lost = "".join(f", {n} lost ({cause})" for cause, n in counts if n)
    print(f"{writer.frames} frames recorded{lost}{silence.summary()}")
    if interrupted.by == signal.SIGINT:
        return INTERRUPTED
    return 1 if silence.lasts or not writer.frames else 0


def _record(
    tip: "Fingertip",
    writer: "Writer",
    options: argparse.Namespace,
    interrupted: "_Interruption",
    silence: "_Silence",
) -> None:
    from lumitip.errors import EndOfRecording, LinkTimeout

    until = time.monotonic() + options.seconds
    while interrupted.by is None and writer.frames < options.frames:
        left = until - time.monotonic()
        if left <= 0.0:
            return
        try:
            frame = tip.read(timeout=min(left, _POLL_S))
        except LinkTimeout as error:
            gap = options.url.lower().startswith("replay:")
            silence.goes_on("the recording has a gap" if gap else str(error).partition(": ")[2])
        except EndOfRecording:
            return
        else:
            silence.ends()
            writer.write(frame)


class _Silence:
    """Tells the user when no frames come, and when they come again."""

    def __init__(self, device_id: str) -> None:
        self.lasts = False
        self._device_id = device_id
        self._since = time.monotonic()
        self._whole_s = 0.0

    def goes_on(self, why: str) -> None:
        """No frame came."""
        if not self.lasts and time.monotonic() - self._since > _SILENT_S:
            self.lasts = True
            self._say(f"no frame for {_SILENT_S:g} s: {why}")

    def ends(self) -> None:
        """A frame came."""
        now = time.monotonic()
        if self.lasts:
            self.lasts = False
            self._whole_s += now - self._since
            self._say(f"frames come again, after {now - self._since:.1f} s")
        self._since = now

    def summary(self) -> str:
        """For the last line: how long it was silent in all; empty if it was not."""
        whole_s = self._whole_s + (time.monotonic() - self._since if self.lasts else 0.0)
        return f", silent for {whole_s:.1f} s in all" if whole_s else ""

    def _say(self, words: str) -> None:
        print(f"{self._device_id}: {words}", file=sys.stderr, flush=True)


class _Interruption:
    """The first signal that ends the recording."""

    by: int | None = None

    def note(self, number: int, _: FrameType | None) -> None:
        """Handle a signal."""
        self.by = self.by or number


@contextmanager
def _interrupts() -> Iterator["_Interruption"]:
    """Notes `ending_signals`, so that none interrupts the writing of a frame."""
    interrupted = _Interruption()
    signals = ending_signals()
    before = [signal.signal(number, interrupted.note) for number in signals]
    try:
        yield interrupted
    finally:
        for number, handler in zip(signals, before, strict=True):
            signal.signal(number, handler)
