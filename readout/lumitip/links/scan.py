"""Search for fingertips: Bluetooth and USB serial ports."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from lumitip.errors import LinkError


@dataclass(frozen=True)
class Found:
    """A device for `Fingertip.open`."""

    url: str
    """Its unique address."""
    name: str
    """Its name; not unique."""
    detail: str
    """Signal strength or kind of port, for the user."""
    sure: bool
    """Whether it identifies itself as a fingertip; a serial port cannot."""


@dataclass(frozen=True)
class Scan:
    """The result of a search."""

    found: tuple[Found, ...]
    unsearched: tuple[str, ...]
    """Reason for each kind of link that could not be searched."""


def scan(seconds: float = 5.0, only: Literal["ble", "serial"] | None = None) -> Scan:
    """Search for devices.

    Args:
        seconds: duration of the Bluetooth scan.
        only: one kind of link; default: both.
    """
    found: list[Found] = []
    unsearched: list[str] = []
    searches: dict[str, Callable[[], list[Found]]] = {
        "serial": _serial,
        "ble": lambda: _ble(seconds),
    }
    for kind, search in searches.items():
        if only in (None, kind):
            try:
                found += search()
            except LinkError as error:
                unsearched.append(str(error))
    return Scan(tuple(found), tuple(unsearched))


def _serial() -> list[Found]:
    from lumitip.links.serial import usb_ports

    return [
        Found(
            f"serial://{port.device}",
            port.product or port.description,
            f"USB {port.vid:04x}:{port.pid:04x}, serial number {port.serial_number}",
            sure=False,
        )
        for port in sorted(usb_ports(), key=lambda port: str(port.device))
    ]


def _ble(seconds: float) -> list[Found]:
    from lumitip.links.ble import sightings

    return [
        Found(
            f"ble://{device.address}",
            advertisement.local_name or device.name or "",
            f"{advertisement.rssi} dBm",
            sure=True,
        )
        for device, advertisement in sightings(seconds)
    ]
