"""`replay://run.mcap`: the frames of a recording, as they came then.

    replay://FILE?speed=1

`speed` is how many times as fast as recorded; 0 is as fast as the frames are read: nothing begins
before somebody reads, and every reader is waited for, unless it takes nothing for 5 s. Frames keep
their numbers and times, so `Frame.t` is of the clock that recorded. The layout and the calibration
are those of the recording. `~` is the home folder. Gaps take as long as they took then, unlike in
`lumitip replay` and the live view, which cut them to a second. Needs mcap:
the extra `record`.
"""

import time

from lumitip.calibration import Calibration
from lumitip.errors import WrongDesign
from lumitip.layout import Layout
from lumitip.links.base import Arrival, Deliver, LinkEvent, Recorded, Report
from lumitip.links.thread import ThreadedLink
from lumitip.links.url import Url
from lumitip.recording import Reader, RecordedFrame


class ReplayLink(ThreadedLink):
    """The frames of a recording."""

    _name = "lumitip-replay"

    def __init__(self, reader: Reader, speed: float) -> None:
        super().__init__()
        self.layout = reader.layout
        self.device_id = reader.metadata.device_id
        self.calibration: Calibration | None = reader.metadata.calibration
        self._reader = reader
        self._speed = speed

    def _run(self, deliver: Deliver, report: Report) -> None:
        report(LinkEvent("connected", f"{self._reader.path} of {self.device_id}"))
        self._play(deliver)
        if not self._stopping.is_set():
            report(LinkEvent("ended", f"{self._reader.path} is over"))

    def _play(self, deliver: Deliver) -> None:
        began = time.monotonic()
        last: float | None = None
        played_s = 0.0
        for frame in self._reader:
            if self._speed:
                # A clock that was set back while it recorded must not make the replay wait.
                played_s += max(0.0, frame.t_wall - last) if last is not None else 0.0
                last = frame.t_wall
                self._stopping.wait(max(0.0, began + played_s / self._speed - time.monotonic()))
            if self._stopping.is_set():
                return
            deliver(Arrival(time.monotonic(), _recorded(frame), patient=not self._speed))


def make(url: Url, layout: Layout | None, any_design: bool) -> ReplayLink:
    """The link of an address.

    Raises:
        UrlError: if there is no such option.
        RecordingError: if the file cannot be read.
        WrongDesign: if it is not of the layout, unless `any_design`.
    """
    url.allow("speed")
    reader = Reader(url.path)
    if layout is not None and layout != reader.layout and not any_design:
        raise WrongDesign(reader.layout.design_hash[:16], layout.design_hash[:16], url.target)
    return ReplayLink(reader, url.number("speed", 1.0, 0.0, 1000.0))


def _recorded(frame: RecordedFrame) -> Recorded:
    return Recorded(
        frame.seq,
        frame.t_device,
        frame.t_host,
        frame.t_wall,
        frame.raw,
        frame.bits,
        frame.dropped_before,
    )
