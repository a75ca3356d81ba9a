"""`replay://run.mcap`: the frames of a recording.

    replay://FILE?speed=1&finger=NAME

`finger` chooses one of several fingertips, see `lumitip.recording.Reader`. Playing starts when the
first frame is asked for, so that none is missed. `speed` is a factor; 0 is as fast as the frames
are read: playing waits for all readers, except those that read nothing for 5 s. Frames keep their
numbers and times, so `Frame.t` is a time of the recording computer. Layout and calibration are
those of the recording. `~` is the home folder. Gaps are not shortened, unlike in `lumitip replay`
and the live view. Needs mcap: the extra `record`.
"""

import time

from lumitip.calibration import Calibration
from lumitip.errors import WrongDesign
from lumitip.layout import Layout
from lumitip.links.base import Arrival, Deliver, LinkEvent, Report
from lumitip.links.thread import ThreadedLink
from lumitip.links.url import Url
from lumitip.recording import Reader


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
        began = played_s = 0.0
        last: float | None = None
        for frame in self._reader:
            first = last is None
            if last is not None and self._speed:
                # The wall clock may have been set back during the recording.
                played_s += max(0.0, frame.t_wall - last)
                self._stopping.wait(max(0.0, began + played_s / self._speed - time.monotonic()))
            if self._stopping.is_set():
                return
            deliver(Arrival(time.monotonic(), frame, patient=first or not self._speed))
            if first:
                began = time.monotonic()
            last = frame.t_wall


def make(url: Url, layout: Layout | None, any_design: bool) -> ReplayLink:
    """The link of an address.

    Raises:
        UrlError: if an option is unknown.
        RecordingError: if the file cannot be read.
        WrongDesign: if its layout is another one, unless `any_design`.
    """
    url.allow("speed", "finger")
    reader = Reader(url.path, finger=url.options.get("finger"))
    if layout is not None and layout != reader.layout and not any_design:
        raise WrongDesign(reader.layout.design_hash[:16], layout.design_hash[:16], url.target)
    return ReplayLink(reader, url.number("speed", 1.0, 0.0, 1000.0))
