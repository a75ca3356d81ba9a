"""Which fingertips can be seen from here: over Bluetooth and on USB serial ports."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from lumitip.errors import LinkError


@dataclass(frozen=True)
class Found:
    """A device that `Fingertip.open` can be asked for."""

    url: str
    """Its address to open, which no other device has."""
    name: str
    """What it calls itself; several may be of one name."""
    detail: str
    """For people: signal strength, kind of port."""
    sure: bool
    """Whether it says that it is a fingertip; a serial port cannot."""


@dataclass(frozen=True)
class Scan:
    """What was found, and what could not be searched."""

    found: tuple[Found, ...]
    unsearched: tuple[str, ...]
    """For each kind of link that could not be searched, why."""


def scan(seconds: float = 5.0, only: Literal["ble", "serial"] | None = None) -> Scan:
    """Look around.

    Args:
        seconds: how long to listen for Bluetooth advertisements.
        only: one kind of link; both without.
    """
    found: list[Found] = []
    unsearched: list[str] = []
    kinds: dict[str, Callable[[], list[Found]]] = {
        "serial": _serial,
        "ble": lambda: _ble(seconds),
    }
    for kind, look in kinds.items():
        if only in (None, kind):
            try:
                found += look()
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
            told.local_name or device.name or "",
            f"{told.rssi} dBm",
            sure=True,
        )
        for device, told in sightings(seconds)
    ]
