"""`Intake`: arrivals of a link to frames in order, with times, values and losses."""

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lumitip.calibration import Correction
from lumitip.errors import WrongDesign
from lumitip.frame import Codes, Frame, RecordedFrame, Values, complement, frozen
from lumitip.layout import Layout
from lumitip.links.base import Arrival, Fault, LinkEvent, Report
from lumitip.protocol.packet import ForeignPacketError, Packet, design_code
from lumitip.session.arrivals import ArrivalTime
from lumitip.session.stats import Counter
from lumitip.session.timing import DeviceClock, SteadyTime, Timeline

_SET_S = 0.05  # the least step of the computer's clock that is followed
_COMPARED_S = 0.005  # longest time to read both clocks: a longer one would look like a step
_TRIES, _FIRST_TRIES = 5, 100


@dataclass(frozen=True)
class Source:
    """The source of frames."""

    layout: Layout
    device_id: Callable[[], str]
    any_design: bool


class Intake:
    """Makes frames. Not thread-safe, except `correction`."""

    def __init__(self, source: Source, counter: Counter, report: Report) -> None:
        self.correction: Correction | None = None
        """Calibration of the next frames."""
        self.last_fault: Fault | None = None
        """The last packet that could not be decoded."""
        self.clock = DeviceClock()
        self._source = source
        self._counter = counter
        self._report = report
        self._timeline = Timeline()
        self._steady = SteadyTime()
        self._arrivals = ArrivalTime()
        self._fault_since: Fault | None = None
        self._legacy_frames = 0
        self._recorded_offset_s: float | None = None
        first_s = _wall_offset_s(_FIRST_TRIES)
        self._wall_s = time.time() - time.monotonic() if first_s is None else first_s

    def reconnected(self) -> None:
        """Note that the link has reconnected."""
        self._timeline.reconnected()
        self._arrivals.reconnected()

    def frames(self, arrival: Arrival) -> list[Frame]:
        """The new frames of an arrival, in order.

        Raises:
            WrongDesign: if the device has another design.
        """
        content = arrival.content
        if isinstance(content, Fault):
            self.last_fault = self._fault_since = content
            self._counter.unreadable(content.packets)
            if content.foreign:
                self._check_foreign(content.foreign)
            return []
        if isinstance(content, RecordedFrame):
            frames = [self._recorded(content)]
            self._counter.frames(frames)
            return frames
        self._follow_clock()
        if isinstance(content, Packet):
            frames = self._of_packet(content, arrival.t_host)
        else:
            frames = [self._legacy(content, arrival.t_host)]
        self._counter.frames(frames)
        return frames

    def _of_packet(self, packet: Packet, t_host: float) -> list[Frame]:
        self._check(packet)
        place = self._timeline.place(packet, t_host)
        self._counter.add("repeated", place.repeated)
        if place.restarted:
            self.clock = DeviceClock()
            self._steady.restarted()
            self._counter.add("restarts")
            self._report(LinkEvent("restarted", f"{self._source.device_id()} has restarted"))
        if place.repeated == packet.frames:
            return []
        if place.lost:
            # Frames of a damaged packet count as damaged, not as lost on the link.
            self._counter.lost(self._fault_since.cause if self._fault_since else "link", place.lost)
        self._fault_since = None
        raw = frozen(packet.values[place.repeated :])
        times_us = place.time_us + packet.period_us * np.arange(len(raw))
        t_device = times_us * 1e-6
        self.clock.add(float(t_device[-1]), t_host)
        t = [self._steady.next(min(self.clock.host(at), t_host), at) for at in t_device.tolist()]
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
        t = self._steady.next(self._arrivals.next(t_host), None)
        return Frame(
            seq,
            None,
            t_host,
            t,
            t + self._wall_s,
            raw,
            8,
            self._values(raw, 8),
            None,
            self._source.device_id(),
        )

    def _recorded(self, frame: RecordedFrame) -> Frame:
        self._counter.lost("link", frame.dropped_before or 0)
        return Frame(
            frame.seq,
            frame.t_device,
            frame.t_host,
            frame.t_wall - self._recorded_wall_s(frame),
            frame.t_wall,
            frozen(frame.raw),
            frame.bits,
            self._values(frame.raw, frame.bits),
            frame.dropped_before,
            self._source.device_id(),
        )

    def _recorded_wall_s(self, frame: RecordedFrame) -> float:
        # Offset between the wall clock and the monotonic clock of the recording computer.
        if self._recorded_offset_s is None:
            self._recorded_offset_s = frame.t_wall - frame.t_host
        return self._recorded_offset_s

    def _follow_clock(self) -> None:
        """Take over the computer's clock if it was set: small steps are left out, since times of
        frames would go back with them."""
        offset_s = _wall_offset_s(_TRIES)
        step_s = 0.0 if offset_s is None else offset_s - self._wall_s
        if abs(step_s) > _SET_S:
            self._wall_s += step_s
            detail = f"the computer's clock was set by {step_s:+.2f} s; t_wall follows it"
            self._report(LinkEvent("clock", detail))

    def _values(self, raw: Codes, bits: int) -> Values:
        values = complement(raw, bits)
        correction = self.correction
        if correction is not None:
            values = correction.apply(values)
        return frozen(values)

    def _check_foreign(self, packet: ForeignPacketError) -> None:
        layout = self._source.layout
        # With the same design hash the firmware is faulty, not the layout.
        if packet.design != design_code(layout.design_hash):
            cells = packet.cells, len(layout)
            raise _wrong(packet.design, layout, self._source.device_id(), cells)

    def _check(self, packet: Packet) -> None:
        layout = self._source.layout
        if packet.design != design_code(layout.design_hash) and not self._source.any_design:
            raise _wrong(packet.design, layout, self._source.device_id())


def _wall_offset_s(tries: int) -> float | None:
    """Seconds since 1970 at the zero of the monotonic clock; `None` where the computer is too busy
    to read both clocks at once."""
    for _ in range(tries):
        before_s, wall_s, after_s = time.monotonic(), time.time(), time.monotonic()
        if after_s - before_s < _COMPARED_S:
            return wall_s - before_s
    return None


def _wrong(
    design: int, layout: Layout, where: str, cells: tuple[int, int] | None = None
) -> WrongDesign:
    return WrongDesign(f"{design:04x}…", f"{layout.design_hash[:4]}…", where, cells)
