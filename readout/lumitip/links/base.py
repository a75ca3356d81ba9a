"""What every link gives, and what is asked of one."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, Protocol, runtime_checkable

from lumitip.calibration import Calibration
from lumitip.errors import LinkError
from lumitip.frame import Codes
from lumitip.layout import Layout
from lumitip.protocol.packet import ForeignPacketError, Packet


@dataclass(frozen=True, eq=False)
class Recorded:
    """A frame that was given before, with all that was known of it then."""

    seq: int
    t_device: float | None
    t_host: float
    t_wall: float
    raw: Codes
    bits: int
    dropped_before: int | None


Cause = Literal["crc", "length"]


@dataclass(frozen=True, eq=False)
class Fault:
    """Packets that came and could not be read."""

    cause: Cause
    packets: int
    why: str
    """The last one's message, for people."""
    foreign: ForeignPacketError | None = None
    """If the last one was undamaged, but of another number of cells: what it is."""


@dataclass(frozen=True, eq=False)
class Arrival:
    """Something that came over a link."""

    t_host: float
    """When, by `time.monotonic` (s)."""
    what: Packet | Codes | Recorded | Fault
    """A packet; the codes of a legacy frame, shape `(cells,)`, 8 bits; a recorded frame; or the
    fault of what could not be read."""
    patient: bool = False
    """Whether `deliver` may wait until somebody reads and has room: a recording has time."""


EventKind = Literal["connected", "lost", "restarted", "warm", "ended", "failed"]


@dataclass(frozen=True)
class LinkEvent:
    """Something that happened to a link."""

    kind: EventKind
    """`"connected"`, also again; `"lost"`, it is being made again; `"restarted"`, the device
    started anew; `"warm"`, it has been on for five minutes; `"ended"`, a recording;
    `"failed"`, given up for the reason in `error`."""
    detail: str
    """The same for people."""
    error: LinkError | None = None


Deliver = Callable[[Arrival], None]
Report = Callable[[LinkEvent], None]


class Link(Protocol):
    """Where packets come from. `start` and `stop` are called once, from any thread."""

    @property
    def layout(self) -> Layout:
        """The cells that come."""

    @property
    def device_id(self) -> str:
        """What tells this device from others; final once the link is connected."""

    def start(self, deliver: Deliver, report: Report) -> None:
        """Begin, on a thread of the link's own, and return at once.

        Args:
            deliver: takes what comes; one thread at a time, never raises, and waits for nothing
                unless the arrival is patient.
            report: takes what happens, likewise.
        """

    def stop(self) -> None:
        """End, and return soon, when nothing will be delivered or reported any more. Never
        raises."""


@runtime_checkable
class Prepares(Protocol):
    """A link that needs time of its own before it is connected."""

    @property
    def why_late(self) -> str:
        """What takes the time, and what to do, for people."""


@runtime_checkable
class Calibrated(Protocol):
    """A link that brings a calibration along, which is used instead of what is kept here."""

    @property
    def calibration(self) -> Calibration | None:
        """As it was when recorded."""
