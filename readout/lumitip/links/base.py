"""The interface of links: arrivals, events and the `Link` protocol."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, Protocol, runtime_checkable

from lumitip.calibration import Calibration
from lumitip.errors import LinkError
from lumitip.frame import Codes, RecordedFrame
from lumitip.layout import Layout
from lumitip.links.url import Url
from lumitip.protocol.packet import ForeignPacketError, Packet

Cause = Literal["crc", "length"]


@dataclass(frozen=True, eq=False)
class Fault:
    """Packets that arrived and could not be decoded."""

    cause: Cause
    packets: int
    why: str
    """Message of the last error."""
    foreign: ForeignPacketError | None = None
    """The last error, if the packet was intact but of another number of cells."""


@dataclass(frozen=True, eq=False)
class Arrival:
    """Data received from a link."""

    t_host: float
    """`time.monotonic` (s)."""
    content: Packet | Codes | RecordedFrame | Fault
    """`Codes`: a legacy frame, shape `(cells,)`, 8 bits."""
    patient: bool = False
    """Whether `deliver` may block until there is a reader with room, as for the first frame of a
    recording."""


EventKind = Literal["connected", "lost", "restarted", "clock", "warm", "ended", "failed"]


@dataclass(frozen=True)
class LinkEvent:
    """A change of state of a link or device."""

    kind: EventKind
    """`"connected"`, first or again; `"lost"`, reconnecting; `"restarted"`, the device; `"clock"`,
    the computer's was set; `"warm"`, five minutes after power-on; `"ended"`, a recording;
    `"failed"`, for good, see `error`."""
    detail: str
    """Text for the user."""
    error: LinkError | None = None


Deliver = Callable[[Arrival], None]
Report = Callable[[LinkEvent], None]


class Link(Protocol):
    """A source of frames. `start` and `stop` are called once, from any thread."""

    @property
    def layout(self) -> Layout:
        """The cells of the frames."""

    @property
    def device_id(self) -> str:
        """Unique name of the device; final once the link is connected."""

    def start(self, deliver: Deliver, report: Report) -> None:
        """Start a thread that connects and delivers; returns at once.

        Args:
            deliver: called with each arrival, from one thread at a time; never raises, and blocks
                only if the arrival is patient.
            report: called with each event, likewise.
        """

    def stop(self) -> None:
        """End the thread; afterwards nothing is delivered or reported. Never raises."""


@dataclass(frozen=True)
class Identity:
    """What a device says of its design before frames are read."""

    device_id: str
    design: str
    """First digits of the design hash (hex): 16 over Bluetooth, 4 on a serial line."""
    cells: int
    url: Url
    """Address to open next: that of this very device."""


@runtime_checkable
class Prepares(Protocol):
    """A link with a slow start."""

    @property
    def why_late(self) -> str:
        """Reason for the delay, and remedy, for the user."""


@runtime_checkable
class Calibrated(Protocol):
    """A link with its own calibration, used instead of the saved one."""

    @property
    def calibration(self) -> Calibration | None:
        """The calibration at the time of recording."""


@runtime_checkable
class Placeable(Protocol):
    """A simulated fingertip, whose object a user can move."""

    def controls(self) -> dict[str, Any]:
        """Allowed objects, materials and numbers, for JSON."""

    def placement(self) -> dict[str, Any]:
        """The object now, for JSON."""

    def place(self, asked: Mapping[str, object]) -> None:
        """Change the object, such as `{"object": "edge", "offset_mm": 2.0, "angle_deg": 80.0}`;
        with `{"moving": True}` it moves by itself again.

        Raises:
            ArgumentError: if the request is not understood; nothing changes.
        """
