"""A fingertip whose link is the test: it sends what it is told, when it is told."""

import time
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from lumitip import Fingertip, Layout, LinkEvent
from lumitip.links.base import Arrival, Deliver, Fault, Report
from lumitip.protocol.packet import Packet, design_code
from lumitip.session.hub import Hub

PERIOD_US = 10_000


class Feed:
    """A link in the hands of a test; device time runs with the host's unless told otherwise."""

    def __init__(self, layout: Layout, device_id: str = "feed") -> None:
        self.layout = layout
        self.device_id = device_id
        self.stopped = False
        self.began = time.monotonic()

    def start(self, deliver: Deliver, report: Report) -> None:
        self.deliver, self.report = deliver, report
        report(LinkEvent("connected", "connected"))

    def stop(self) -> None:
        self.stopped = True

    def packet(
        self,
        sequence: int,
        frames: int = 1,
        *,
        time_us: int | None = None,
        t_host: float | None = None,
        bits: int = 8,
        design: int | None = None,
        value: int | None = None,
    ) -> None:
        """Deliver a packet; its values are the number of each frame unless told otherwise."""
        at_us = sequence * PERIOD_US if time_us is None else time_us
        numbers = (sequence + np.arange(frames)) % 251 if value is None else np.full(frames, value)
        kind = np.uint8 if bits == 8 else np.uint16
        values = np.repeat(numbers[:, None], len(self.layout), axis=1).astype(kind)
        code = design_code(self.layout.design_hash) if design is None else design
        made = Packet(code, sequence % 2**16, bits, at_us % 2**32, PERIOD_US, values)
        if t_host is None:
            t_host = self.began + (at_us + (frames - 1) * PERIOD_US) / 1e6
        self.deliver(Arrival(t_host, made))

    def legacy(self, value: int) -> None:
        """Deliver a frame of version 1."""
        codes = np.full(len(self.layout), value, np.uint8)
        self.deliver(Arrival(time.monotonic(), codes))

    def fault(self, cause: str) -> None:
        """Deliver what cannot be read."""
        self.deliver(Arrival(time.monotonic(), Fault(cause, 1, f"a {cause} fault")))


OpenFeed = Callable[..., tuple[Fingertip, Feed]]


@pytest.fixture
def open_feed(layout: Layout) -> Iterator[OpenFeed]:
    """`tip, feed = open_feed(buffer=10)`: an open fingertip and its link."""
    opened: list[Fingertip] = []

    def opener(
        buffer: int = 100,
        any_design: bool = False,
        calibrated: bool = True,
        on_event: Callable[[LinkEvent], None] | None = None,
        device_id: str = "feed",
    ) -> tuple[Fingertip, Feed]:
        feed = Feed(layout, device_id)
        hub = Hub(feed, any_design, on_event)
        opened.append(Fingertip(hub, buffer, calibrated, timeout_s=1.0))
        return opened[-1], feed

    yield opener
    for tip in opened:
        tip.close()
