"""The device's end of a serial line, over a pseudo-terminal."""

import os
import pty
import termios
from pathlib import Path

from lumitip.protocol import cobs


class Line:
    """At a path that stays when it is unplugged."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.plug()

    def plug(self) -> None:
        self._master, slave = pty.openpty()
        settings = termios.tcgetattr(slave)
        settings[3] &= ~termios.ECHO
        termios.tcsetattr(slave, termios.TCSANOW, settings)
        self.path.unlink(missing_ok=True)
        self.path.symlink_to(os.ttyname(slave))
        os.close(slave)

    def unplug(self) -> None:
        os.close(self._master)
        self.path.unlink()

    def send(self, *packets: bytes) -> None:
        self.send_bytes(b"".join(cobs.encode(packet) + b"\0" for packet in packets))

    def send_bytes(self, data: bytes) -> None:
        os.write(self._master, data)
