"""`serial:///dev/ttyACM0`: packets over a serial line or USB, COBS between zero bytes.

    serial://PORT?baud=115200

Without a port the only USB device that can be one is taken. A device with a USB serial number is
found again under whatever port it comes back as. Needs pyserial: the extra `serial`.
"""

import importlib.util
import re
import time
from collections.abc import Callable, Sequence
from typing import Any

from lumitip.errors import AmbiguousDevice, DeviceNotFound, LinkError, MissingExtra, NotConnected
from lumitip.layout import Layout
from lumitip.links.base import Arrival, Cause, Deliver, Fault, Report
from lumitip.links.retry import keep_connected
from lumitip.links.thread import ThreadedLink
from lumitip.links.url import Url
from lumitip.protocol.packet import ForeignPacketError
from lumitip.protocol.stream import StreamDecoder

try:
    import serial
    from serial.tools import list_ports
except ModuleNotFoundError as missing:
    raise MissingExtra("serial", "serial://") from missing

# What pyserial lets through where the system takes the port away under it.
_GONE: tuple[type[Exception], ...] = (OSError, TypeError)
if importlib.util.find_spec("termios"):  # not on Windows
    _GONE += (importlib.import_module("termios").error,)
_WAIT_S = 0.2  # how long a read waits, so that stopping is noticed
_PIECES = re.compile(rb"[^\0]*\0|[^\0]+")
CAUSES: tuple[Cause, ...] = ("crc", "length")


class SerialLink(ThreadedLink):
    """Packets over a serial port."""

    _name = "lumitip-serial"

    def __init__(self, layout: Layout, port: str, baud: int) -> None:
        super().__init__()
        self.layout = layout
        self._port = port
        self._baud = baud
        self._usb_serial = next((p.serial_number for p in usb_ports() if p.device == port), None)
        self._deliver: Deliver

    @property
    def device_id(self) -> str:
        """`serial:` and the USB serial number, or the port where there is none."""
        return f"serial:{self._usb_serial or self._port}"

    def _run(self, deliver: Deliver, report: Report) -> None:
        self._deliver = deliver
        keep_connected(self._session, report, self._stopping)

    def _session(self, connected: Callable[[str], None]) -> None:
        port = self._port_now()
        try:
            with serial.Serial(port, self._baud, timeout=_WAIT_S, exclusive=True) as line:
                connected(f"{self.device_id} on {port}")
                self._read(line)
        except _GONE as error:
            raise _told(port, error) from error

    def _read(self, line: Any) -> None:
        decoder = StreamDecoder(len(self.layout), mid_stream=True)
        told = dict.fromkeys(CAUSES, 0)
        while not self._stopping.is_set():
            chunk = line.read(max(1, line.in_waiting))
            if not chunk:
                continue
            t_host = time.monotonic()
            # Piece by piece, so that a damaged packet is told between its neighbours.
            for piece in _PIECES.findall(chunk):
                for packet in decoder.feed(piece):
                    self._deliver(Arrival(t_host, packet))
                for cause in CAUSES:
                    if decoder.dropped[cause] > told[cause]:
                        told[cause] += 1
                        self._deliver(Arrival(t_host, _fault(cause, decoder.last_error)))

    def _port_now(self) -> str:
        if self._usb_serial:
            for port in usb_ports():
                if port.serial_number == self._usb_serial:
                    return str(port.device)
        return self._port


def _fault(cause: Cause, error: Exception | None) -> Fault:
    return Fault(cause, 1, str(error), error if isinstance(error, ForeignPacketError) else None)


def usb_ports() -> Sequence[Any]:
    """Serial ports of USB devices, as pyserial describes them."""
    return [port for port in list_ports.comports() if port.vid is not None]


def make(url: Url, layout: Layout, any_design: bool) -> SerialLink:  # noqa: ARG001
    """The link of an address.

    Raises:
        UrlError: if there is no such option.
        DeviceNotFound: if no port is given and there is none.
        AmbiguousDevice: if no port is given and there are several.
    """
    url.allow("baud")
    port = url.target
    if not port:
        found = [str(p.device) for p in usb_ports()]
        if not found:
            raise DeviceNotFound(f"{url.text}: no USB serial port is there: plug the device in")
        if len(found) > 1:
            raise AmbiguousDevice("", found, "serial")
        port = found[0]
    return SerialLink(layout, port, int(url.number("baud", 115200, 1, 10_000_000)))


def _told(port: str, error: Exception) -> LinkError:
    code = getattr(error, "errno", None)
    if isinstance(error, FileNotFoundError) or code == 2:
        there = ", ".join(str(p.device) for p in list_ports.comports()) or "none"
        return DeviceNotFound(f"{port}: there is no such port; ports there are: {there}")
    if code == 13:
        return DeviceNotFound(
            f"{port}: this user may not open it: on Linux join the group that owns it, mostly "
            "dialout, and log in again"
        )
    return NotConnected(f"{port}: {error}")
