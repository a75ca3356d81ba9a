"""`Printer`: a 3D printer as a positioning stage, by G-code over its serial port.

    with Printer("serial:///dev/ttyUSB1?baud=115200") as printer:
        printer.move("Z", -1.0)  # relative; returns when the head stands

It sends only what Marlin, the firmwares derived from it and Klipper have in common (G21, G90, G91,
G1, M114, M115, M400), and no command that homes or heats. Needs pyserial: the extra `serial`.
"""

import re
import time
from types import TracebackType

from lumitip import errors
from lumitip.links.serial import GONE, line_of, opened, port_error
from lumitip.links.url import Url

SPEED_MM_S = 5.0
"""The vertical axis of most printers allows no more."""
_ANSWER_S = 30.0  # after the command, or after the printer said that it is busy
_BOOT_S = 20.0  # boards with an Arduino's bootloader start anew when the port is opened
_ASK_AGAIN_S = 2.0
_QUIET_S = 0.5  # after which no answer to an earlier question comes
_TICK_S = 0.1
_NEAR_MM = 0.02  # M114 has two decimals
_NAME = re.compile(r"FIRMWARE_NAME:\s*(.*?)\s*(?=[A-Z_]{4,}:|$)", re.MULTILINE)


class PrinterError(errors.LinkError):
    """The printer refused a command, or is not where it was sent."""


class Printer:
    """A printer with its port open.

    Args:
        address: `serial://PORT?baud=115200`.

    Raises:
        UrlError: if the address is of another kind.
        LinkError: if the port cannot be opened, or no answer of a printer comes.
    """

    def __init__(self, address: str) -> None:
        url = Url.parse(address)
        if url.scheme != "serial":
            raise errors.UrlError(
                f"the printer's address is {url.text!r}; one like serial:///dev/ttyUSB1 is needed"
            )
        self._port, baud = line_of(url)
        try:
            self._line = opened(self._port, baud, _TICK_S)
        except GONE as error:
            raise port_error(self._port, error) from error
        try:
            self.firmware = self._greeted()
            """Its name, as the printer gives it."""
            self._ask("G21")  # mm
            self._ask("G91")  # relative
        except BaseException:
            self._line.close()
            raise

    def __enter__(self) -> "Printer":
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        try:
            self._line.write(b"G90\n")  # absolute, as printers are after a start
            self._line.flush()
        except GONE:
            pass  # a printer that was unplugged starts anew
        finally:
            self._line.close()

    def move(self, axis: str, by_mm: float) -> None:
        """Move the head along an axis, and wait until it stands.

        Args:
            axis: `"X"`, `"Y"` or `"Z"`.
            by_mm: from where it is.

        Raises:
            PrinterError: if the printer refuses, or says that it is elsewhere.
            LinkError: if it does not answer.
        """
        needed_mm = self.place_mm(axis) + by_mm
        self._ask(f"G1 {axis}{by_mm:.3f} F{60.0 * SPEED_MM_S:.0f}")
        self._ask("M400")
        place_mm = self.place_mm(axis)
        if abs(place_mm - needed_mm) > _NEAR_MM:
            raise PrinterError(
                f"the printer's head is at {axis} {place_mm:.2f} mm; it was sent to "
                f"{needed_mm:.2f} mm. Is that beyond its range? Home it, and begin further from "
                "the end of the axis"
            )

    def place_mm(self, axis: str) -> float:
        """Where the head is on an axis, in the printer's coordinates.

        Raises:
            PrinterError: if its answer has no such axis.
            LinkError: if it does not answer.
        """
        answer = self._ask("M114")
        found = re.search(rf"\b{axis}:\s*(-?\d+(?:\.\d+)?)", answer)
        if not found:
            raise PrinterError(
                f"the printer answered M114 with {answer[:80]!r}; no place in {axis}"
            )
        return float(found[1])

    def _greeted(self) -> str:
        """The name of the firmware, as soon as it answers."""
        until = time.monotonic() + _BOOT_S
        while True:
            try:
                answer = self._ask("M115", _ASK_AGAIN_S)
                break
            except errors.LinkTimeout:
                if time.monotonic() > until:
                    raise errors.LinkTimeout(
                        f"{self._port}: no printer answered in {_BOOT_S:g} s. Is this its port, "
                        "and the baud rate its own, such as ?baud=250000?"
                    ) from None
        while self._answered(_QUIET_S):
            pass
        found = _NAME.search(answer)
        return found[1] if found else "unknown firmware"

    def _ask(self, command: str, patience_s: float | None = None) -> str:
        """The answer to a command, until its "ok"; by default with the patience of `_ANSWER_S`."""
        patience_s = _ANSWER_S if patience_s is None else patience_s
        try:
            self._line.write(f"{command}\n".encode())
        except GONE as error:
            raise port_error(self._port, error) from error
        answer, until = "", time.monotonic() + patience_s
        while True:
            line = self._answered(until - time.monotonic())
            if line is None:
                raise errors.LinkTimeout(
                    f"{self._port}: the printer has not answered {command} in {patience_s:g} s"
                )
            if "busy" in line:  # others, such as "wait" and temperatures, come without end
                until = time.monotonic() + patience_s
            # Marlin says "Error:", Klipper "!!".
            if line.startswith("!!") or line.lower().startswith("error"):
                raise PrinterError(f"the printer refused {command}: {line[:120]}")
            answer += f"{line}\n"
            if line.startswith("ok"):
                return answer

    def _answered(self, patience_s: float) -> str | None:
        """The next line of the printer; `None` if it is silent."""
        until = time.monotonic() + patience_s
        waiting = b""
        while time.monotonic() < until:
            try:
                waiting += bytes(self._line.readline())
            except GONE as error:
                raise port_error(self._port, error) from error
            if waiting.endswith(b"\n"):
                return waiting.decode("utf-8", "replace").strip()
        return None
