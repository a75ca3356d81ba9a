"""`serial:///dev/ttyACM0`: packets over a serial line or USB, COBS between zero bytes.

    serial://PORT?baud=115200

The default is the only USB serial port. A device with a USB serial number is found again on any
port after a disconnect. Needs pyserial: the extra `serial`.
"""

import dataclasses
import errno
import importlib.util
import math
import re
import time
from collections.abc import Callable, Sequence
from typing import Any

from lumitip import errors
from lumitip.known_layouts import remember
from lumitip.layout import Layout
from lumitip.links.base import Arrival, Cause, Deliver, Fault, Identity, Report
from lumitip.links.thread import ThreadedLink, keep_connected
from lumitip.links.url import Url
from lumitip.protocol.cobs import DELIMITER, CobsError, StreamDecoder, decode
from lumitip.protocol.packet import ForeignPacketError, PacketError, design_code
from lumitip.protocol.packet import decode as decode_packet

try:
    import serial
    from serial.tools import list_ports
except ModuleNotFoundError as missing:
    raise errors.MissingExtra("serial", "serial://") from missing

GONE: tuple[type[Exception], ...] = (OSError, TypeError)
"""Exceptions of pyserial when the port disappears."""
if importlib.util.find_spec("termios"):  # not on Windows
    GONE += (importlib.import_module("termios").error,)
_WAIT_S = 0.2  # timeout of a read, so that `stop` is noticed
_MOST_BYTES = 1 << 17  # more than the longest packet
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
        self._usb_serial = _usb_serial(port)
        self._deliver: Deliver

    @property
    def device_id(self) -> str:
        """`serial:` and the USB serial number, or the port where there is none."""
        return _device_id(self._usb_serial, self._port)

    def _run(self, deliver: Deliver, report: Report) -> None:
        self._deliver = deliver
        keep_connected(self._session, report, self._stopping)

    def _session(self, connected: Callable[[str], None]) -> None:
        port = self._port_now()
        try:
            with opened(port, self._baud) as line:
                connected(f"{self.device_id} on {port}")
                self._read(line)
        except GONE as error:
            raise port_error(port, error) from error

    def _read(self, line: Any) -> None:
        decoder = StreamDecoder(len(self.layout), mid_stream=True)
        reported, code = dict.fromkeys(CAUSES, 0), design_code(self.layout.design_hash)
        confirmed = False
        while not self._stopping.is_set():
            chunk = line.read(max(1, line.in_waiting))
            if not chunk:
                continue
            t_host = time.monotonic()
            # Piece by piece, so that a damaged packet is reported between its neighbours.
            for piece in _PIECES.findall(chunk):
                for packet in decoder.feed(piece):
                    self._deliver(Arrival(t_host, packet))
                    if packet.design == code and not confirmed:
                        confirmed = True
                        remember(self.device_id, self.layout)
                for cause in CAUSES:
                    if decoder.dropped[cause] > reported[cause]:
                        reported[cause] += 1
                        self._deliver(Arrival(t_host, _fault(cause, decoder.last_error)))

    def _port_now(self) -> str:
        if self._usb_serial:
            for port in usb_ports():
                if port.serial_number == self._usb_serial:
                    return str(port.device)
        return self._port


def _fault(cause: Cause, error: Exception | None) -> Fault:
    return Fault(cause, 1, str(error), error if isinstance(error, ForeignPacketError) else None)


def _usb_serial(port: str) -> str | None:
    return next((p.serial_number for p in usb_ports() if p.device == port), None)


def _device_id(usb_serial: str | None, port: str) -> str:
    return f"serial:{usb_serial or port}"


def usb_ports() -> Sequence[Any]:
    """Serial ports of USB devices, as pyserial describes them."""
    return [port for port in list_ports.comports() if port.vid is not None]


def make(url: Url, layout: Layout, any_design: bool) -> SerialLink:  # noqa: ARG001
    """The link of an address.

    Raises:
        UrlError: if an option is unknown.
        DeviceNotFound: if the address has no port and there is none.
        AmbiguousDevice: if the address has no port and there are several.
    """
    return SerialLink(layout, *line_of(url))


def identify(url: Url, timeout_s: float | None) -> Identity:
    """The design that the packets of a device name.

    Raises:
        UrlError: as `make`.
        LinkError: if the port cannot be opened, or no packet comes in time.
    """
    port, baud = line_of(url)
    until = time.monotonic() + (math.inf if timeout_s is None else timeout_s)
    waiting = b""
    try:
        with opened(port, baud) as line:
            while time.monotonic() < until:
                waiting += line.read(max(1, line.in_waiting))
                *pieces, waiting = waiting[-_MOST_BYTES:].split(DELIMITER)
                for piece in pieces:
                    if named := _named(piece):
                        own = dataclasses.replace(url, target=port)
                        return Identity(_device_id(_usb_serial(port), port), *named, own)
    except GONE as error:
        raise port_error(port, error) from error
    raise errors.LinkTimeout(f"{port}: no packet in {timeout_s:g} s. Is the firmware running?")


def _named(piece: bytes) -> tuple[str, int] | None:
    """Design and number of cells of a packet between two zeros; nothing if it is damaged."""
    try:
        packet = decode_packet(decode(piece), 1)
    except ForeignPacketError as foreign:
        return f"{foreign.design:04x}", foreign.cells
    except (CobsError, PacketError):
        return None
    return f"{packet.design:04x}", 1


def opened(port: str, baud: int, wait_s: float = _WAIT_S) -> Any:
    """A port of this program alone; `wait_s` is the longest time of a read. Raises `GONE`."""
    return serial.Serial(port, baud, timeout=wait_s, exclusive=True)


def line_of(url: Url) -> tuple[str, int]:
    """Port and baud rate of an address; errors as of `make`."""
    url.allow("baud")
    port = url.target
    if not port:
        found = [str(p.device) for p in usb_ports()]
        if not found:
            raise errors.DeviceNotFound(
                f"{url.text}: there is no USB serial port. Plug the device in"
            )
        if len(found) > 1:
            raise errors.AmbiguousDevice("", found, "serial")
        port = found[0]
    return port, int(url.number("baud", 115200, 1, 10_000_000))


def port_error(port: str, error: Exception) -> errors.LinkError:
    """What to do about a port that cannot be opened, or is gone."""
    code = getattr(error, "errno", None)
    there = ", ".join(str(p.device) for p in list_ports.comports()) or "none"
    if isinstance(error, FileNotFoundError) or code == errno.ENOENT:
        return errors.DeviceNotFound(f"{port}: there is no such port; the ports are: {there}")
    # pyserial raises an error of its own, without the number, for a file of another kind.
    if code == errno.EISDIR or getattr(error.__context__, "args", ())[:1] == (errno.ENOTTY,):
        return errors.DeviceNotFound(f"{port}: this is no serial port; the ports are: {there}")
    if code == 13:
        return errors.DeviceNotFound(
            f"{port}: no permission. On Linux add this user to the group of the port, mostly "
            "dialout, and log in again"
        )
    if code == errno.EAGAIN:
        return errors.NotConnected(
            f"{port}: another program has it open. End that program, or share the device: "
            f"`lumitip serve serial://{port}`, and open the address that it prints in each"
        )
    return errors.NotConnected(f"{port}: {error}")
