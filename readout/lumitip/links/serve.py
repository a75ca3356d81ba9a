"""`SerialDevice`: a simulated USB device on a pseudo-terminal."""

import contextlib
import os
import threading
from pathlib import Path
from types import TracebackType

from lumitip.errors import LinkError
from lumitip.links.base import Arrival, Link
from lumitip.protocol import cobs
from lumitip.protocol.packet import Packet, encode

try:
    import pty
    import termios
    import tty
except ModuleNotFoundError as missing:
    raise LinkError("this system has no pseudo-terminals. Open twin://SHAPE directly") from missing


class SerialDevice:
    """The device's end of a serial line, a context manager.

    Like a device it never waits for a reader: when the buffer is full the oldest data are lost.
    """

    def __init__(self, link: Path | None = None) -> None:
        """Open a pseudo-terminal.

        Args:
            link: path of a symbolic link to it, removed by `close`.

        Raises:
            LinkError: if the symbolic link cannot be created.
        """
        self._mine, self._theirs = pty.openpty()
        tty.setraw(self._theirs)
        os.set_blocking(self._mine, False)
        self._rest = b""
        self._link = link
        if link:
            try:
                link.symlink_to(os.ttyname(self._theirs))
            except OSError as error:
                self._link = None
                self.close()
                raise LinkError(
                    f"{link}: cannot be created: {error}. Choose another path"
                ) from error

    @property
    def port(self) -> str:
        """Name of the serial port that a reader opens."""
        return str(self._link or os.ttyname(self._theirs))

    def send(self, packet: Packet) -> None:
        """Send a packet, between zero bytes."""
        packet_bytes = cobs.encode(encode(packet)) + cobs.DELIMITER
        data = self._rest + packet_bytes
        try:
            self._rest = data[os.write(self._mine, data) :]
        except BlockingIOError:
            termios.tcflush(self._theirs, termios.TCIFLUSH)
            # The delimiter ends a packet that the reader has in part.
            data, self._rest = cobs.DELIMITER + packet_bytes, b""
            with contextlib.suppress(BlockingIOError):
                self._rest = data[os.write(self._mine, data) :]

    def serve(self, link: Link, seconds: float | None = None) -> None:
        """Send the packets of a link, for some seconds or until interrupted."""

        def deliver(arrival: Arrival) -> None:
            if isinstance(arrival.content, Packet):
                self.send(arrival.content)

        link.start(deliver, lambda _: None)
        try:
            threading.Event().wait(seconds)
        finally:
            link.stop()

    def close(self) -> None:
        """Close the line; for the reader it is unplugged."""
        if self._link:
            with contextlib.suppress(OSError):
                self._link.unlink()
        os.close(self._theirs)
        os.close(self._mine)

    def __enter__(self) -> "SerialDevice":
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        self.close()
