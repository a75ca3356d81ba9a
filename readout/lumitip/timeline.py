"""Where a packet belongs: its 16-bit number and 32-bit time unwrapped, what is lost before it."""

from dataclasses import dataclass

from lumitip.protocol.packet import Packet

_SEQUENCES = 1 << 16
_TIMES = 1 << 32  # 71.6 minutes of microseconds
_LATE_US = 1_000_000  # no link keeps a packet back longer than this while others overtake it
_AHEAD_US = 10_000_000  # what a stalled link may deliver at once, with room to spare


@dataclass(frozen=True)
class Place:
    """Where a packet belongs among those before it."""

    seq: int
    """Number of its first new frame, counted on over wraps and restarts."""
    time_us: int
    """Device time of that frame, unwrapped (us)."""
    repeated: int
    """Frames at its start that came before, or too late to be given in order."""
    lost: int | None
    """Frames missing just before it; `None` if the device started anew."""
    restarted: bool = False
    """Whether the device started anew, so that its clock has nothing to do with the last one."""


class Timeline:
    """Puts packets in order. Not thread-safe."""

    def __init__(self) -> None:
        self._seq = -1  # of the last frame given, counted on over restarts
        self._sequence = 0  # of the same, as the device counts, unwrapped
        self._time_us = 0
        self._t_host: float | None = None
        self._fresh = False

    def reconnected(self) -> None:
        """The link was cut: nothing sent before can come any more."""
        self._fresh = True

    def place(self, packet: Packet, t_host: float) -> Place:
        """Where this packet belongs; the next call takes it as the last one.

        A number that goes on while the time does not, or the other way round, is another run of
        the firmware.
        """
        if self._t_host is None:
            return self._keep(packet, t_host, Place(0, packet.time_us, 0, 0), packet.sequence)
        waited_us = (t_host - self._t_host) * 1e6
        time_us = _nearest(packet.time_us, _TIMES, self._time_us + waited_us)
        step_us = time_us - self._time_us
        steps = step_us / packet.period_us if packet.period_us else 1
        sequence = _nearest(packet.sequence, _SEQUENCES, self._sequence + steps)
        step = sequence - self._sequence
        oldest_us = 0 if self._fresh else -_LATE_US
        goes_on = step > 0 and 0 < step_us <= waited_us + _AHEAD_US
        if goes_on:
            place = Place(self._seq + step, time_us, 0, step - 1)
        elif step <= 0 and oldest_us <= step_us <= 0:
            repeated = min(1 - step, packet.frames)
            place = Place(self._seq + 1, time_us + repeated * packet.period_us, repeated, 0)
        else:
            place = Place(self._seq + 1, packet.time_us, 0, None, restarted=True)
            sequence = packet.sequence
        return self._keep(packet, t_host, place, sequence)

    def _keep(self, packet: Packet, t_host: float, place: Place, sequence: int) -> Place:
        new = packet.frames - place.repeated
        if new:
            self._seq = place.seq + new - 1
            self._sequence = sequence + packet.frames - 1
            self._time_us = place.time_us + (new - 1) * packet.period_us
            self._t_host = t_host
            self._fresh = False
        return place


def _nearest(value: int, modulus: int, expected: float) -> int:
    """The number nearest to `expected` that is `value` modulo `modulus`."""
    return value + modulus * round((expected - value) / modulus)
