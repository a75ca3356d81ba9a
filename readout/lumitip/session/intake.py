"""From what arrives on a link to frames: in order, with times, values and what is missing."""

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lumitip.calibration import Correction
from lumitip.errors import WrongDesign
from lumitip.frame import Codes, Frame, Values, complement, frozen
from lumitip.layout import Layout
from lumitip.links.base import Arrival, Fault, LinkEvent, Recorded, Report
from lumitip.protocol.packet import ForeignPacketError, Packet, design_code
from lumitip.session.stats import Counter
from lumitip.session.timing import DeviceClock, Timeline


@dataclass(frozen=True)
class Source:
    """What frames come from."""

    layout: Layout
    device_id: Callable[[], str]
    any_design: bool


class Intake:
    """Makes frames. Not thread-safe, but for `correction`, which any thread may set."""

    def __init__(self, source: Source, counter: Counter, report: Report) -> None:
        self.correction: Correction | None = None
        """What calibrates the values of the frames to come."""
        self.last_fault: Fault | None = None
        """What the last packet that could not be read suffered from."""
        self.clock = DeviceClock()
        self._source = source
        self._counter = counter
        self._report = report
        self._timeline = Timeline()
        self._fault_since: Fault | None = None
        self._legacy_frames = 0
        self._last_t = -np.inf
        # Taken once, so that a computer whose clock is set meanwhile does not tear a recording.
        self._wall_s = time.time() - time.monotonic()

    def reconnected(self) -> None:
        """The link was cut and made again."""
        self._timeline.reconnected()

    def frames(self, arrival: Arrival) -> list[Frame]:
        """The new frames that an arrival holds, in order.

        Raises:
            WrongDesign: if the device is of another design.
        """
        what = arrival.what
        if isinstance(what, Fault):
            self.last_fault = self._fault_since = what
            self._counter.unreadable(what.packets)
            if what.foreign:
                self._check_foreign(what.foreign)
            return []
        if isinstance(what, Recorded):
            frames = [self._recorded(what)]
        elif isinstance(what, Packet):
            frames = self._of_packet(what, arrival.t_host)
        else:
            frames = [self._legacy(what, arrival.t_host)]
        self._counter.frames(frames)
        return frames

    def _of_packet(self, packet: Packet, t_host: float) -> list[Frame]:
        self._check(packet)
        place = self._timeline.place(packet, t_host)
        self._counter.add("repeated", place.repeated)
        if place.restarted:
            self.clock = DeviceClock()
            self._counter.add("restarts")
            self._report(LinkEvent("restarted", f"{self._source.device_id()} started anew"))
        if place.repeated == packet.frames:
            return []
        if place.lost:
            # A damaged packet is what is missing, not lost on the way.
            self._counter.lost(self._fault_since.cause if self._fault_since else "link", place.lost)
        self._fault_since = None
        raw = frozen(packet.values[place.repeated :])
        times_us = place.time_us + packet.period_us * np.arange(len(raw))
        t_device = times_us * 1e-6
        self.clock.add(float(t_device[-1]), t_host)
        t = self._ascending([min(self.clock.host(float(at)), t_host) for at in t_device])
        values = self._values(raw, packet.bits)
        device_id = self._source.device_id()
        return [
            Frame(
                place.seq + i,
                float(t_device[i]),
                t_host,
                t[i],
                t[i] + self._wall_s,
                raw[i],
                packet.bits,
                values[i],
                0 if i else place.lost,
                device_id,
            )
            for i in range(len(raw))
        ]

    def _legacy(self, raw: Codes, t_host: float) -> Frame:
        seq = self._legacy_frames
        self._legacy_frames += 1
        raw = frozen(raw)
        return Frame(
            seq,
            None,
            t_host,
            t_host,
            t_host + self._wall_s,
            raw,
            8,
            self._values(raw, 8),
            None,
            self._source.device_id(),
        )

    def _recorded(self, was: Recorded) -> Frame:
        self._counter.lost("link", was.dropped_before or 0)
        return Frame(
            was.seq,
            was.t_device,
            was.t_host,
            was.t_wall - self._recorded_wall_s(was),
            was.t_wall,
            frozen(was.raw),
            was.bits,
            self._values(was.raw, was.bits),
            was.dropped_before,
            self._source.device_id(),
        )

    def _recorded_wall_s(self, was: Recorded) -> float:
        # The computer that recorded had another wall time to its monotonic clock.
        if self._last_t == -np.inf:
            self._wall_s, self._last_t = was.t_wall - was.t_host, was.t_host
        return self._wall_s

    def _values(self, raw: Codes, bits: int) -> Values:
        values = complement(raw, bits)
        correction = self.correction
        if correction is not None:
            values = correction.apply(values)
        return frozen(values)

    def _ascending(self, times: list[float]) -> list[float]:
        for i, t in enumerate(times):
            self._last_t = times[i] = max(t, float(self._last_t))
        return times

    def _check_foreign(self, packet: ForeignPacketError) -> None:
        layout = self._source.layout
        # Of the very same design it is no other fingertip, but one whose firmware is at fault.
        if packet.design != design_code(layout.design_hash):
            cells = packet.cells, len(layout)
            raise _wrong(packet.design, layout, self._source.device_id(), cells)

    def _check(self, packet: Packet) -> None:
        layout = self._source.layout
        if packet.design != design_code(layout.design_hash) and not self._source.any_design:
            raise _wrong(packet.design, layout, self._source.device_id())


def _wrong(
    design: int, layout: Layout, where: str, cells: tuple[int, int] | None = None
) -> WrongDesign:
    return WrongDesign(f"{design:04x}…", f"{layout.design_hash[:4]}…", where, cells)
