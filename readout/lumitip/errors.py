"""The exceptions of the robot side, all under one root."""
# ruff: noqa: N818

from collections.abc import Sequence
from typing import Any


def how_to_install(extras: str) -> str:
    """The commands that install this package with some extras; it is not on PyPI."""
    return (
        f"pip install '.[{extras}]' in Lumitip's folder, or pip install 'FILE.whl[{extras}]' "
        "with its wheel"
    )


class LumitipError(Exception):
    """Root of every error that `lumitip` raises on purpose."""


class ArgumentError(LumitipError, ValueError):
    """An argument that cannot be used; the message says what is needed."""


class UnknownOption(ArgumentError, TypeError):
    """An option that a function does not have."""

    def __init__(self, name: str, allowed: Sequence[str]) -> None:
        super().__init__(f"there is no option {name!r}; allowed are {', '.join(allowed)}")
        self.name = name
        """The option."""
        self.allowed = tuple(allowed)
        """The options that exist."""


class LayoutError(LumitipError, ValueError):
    """A `layout.json` that cannot be used; the message names field, value and limit."""


class LinkError(LumitipError):
    """Root of the errors between a fingertip and this computer."""


class UrlError(LinkError, ValueError):
    """An address of no link, or with an option that the link does not have."""


class MissingExtra(LinkError, ImportError):
    """A library that this feature needs is not installed."""

    def __init__(self, extra: str, what: str) -> None:
        super().__init__(f"{what} needs more than numpy: {how_to_install(extra)}")
        self.extra = extra
        """The extra to install."""


class LinkTimeout(LinkError, TimeoutError):
    """Nothing arrived within the timeout."""

    block: Any = None
    """From `get_data`: a `Block` of the frames that arrived, `None` if there were none."""


class StaleFrame(LinkTimeout):
    """The newest frame is older than allowed."""


class NotConnected(LinkError, ConnectionError):
    """The fingertip was closed, or its link has failed."""


class DeviceFailed(NotConnected):
    """The device of a server has failed for good."""


class AccessRefused(LinkError):
    """A server refuses this client; the message says why."""


class FingertipClosed(NotConnected):
    """The fingertip was closed by this program."""


class EndOfRecording(NotConnected):
    """A replay is at its end."""

    block: Any = None
    """From `get_data`: a `Block` of the last frames, `None` if there were none."""


class DeviceNotFound(LinkError):
    """No device has this name, address or port."""


class AmbiguousDevice(LinkError):
    """Several devices have this name."""

    def __init__(self, name: str, addresses: Sequence[str], scheme: str) -> None:
        self.addresses = tuple(sorted(addresses))
        """The address of each."""
        choices = ", ".join(f"{scheme}://{address}" for address in self.addresses)
        found = f"{name!r} is the name of" if name else "the address has no name; found were"
        super().__init__(f"{found} {len(self.addresses)} devices. Open one of {choices}")


class WrongDesign(LinkError):
    """The device or recording has another design than the layout."""

    def __init__(
        self, found: str, expected: str, where: str, cells: tuple[int, int] | None = None
    ) -> None:
        has, wants = (f" with {n} cells" for n in cells) if cells else ("", "")
        super().__init__(
            f"{where} has design {found}{has}; the layout has design {expected}{wants}. Use the "
            "layout.json that its firmware was built from, or flash the firmware of this design"
        )
        self.found = found
        """First digits of the design hash received."""
        self.expected = expected
        """First digits of the layout's design hash."""


class MtuTooSmall(LinkError):
    """A frame does not fit into a Bluetooth notification, so none is sent."""

    def __init__(self, mtu: int, needed: int) -> None:
        super().__init__(
            f"the ATT MTU of the Bluetooth connection is {mtu}; a frame of this layout needs "
            f"{needed}. Use an adapter that negotiates a larger MTU, or the serial line"
        )
        self.mtu = mtu
        """ATT MTU of the connection."""
        self.needed = needed
        """Smallest ATT MTU for a frame."""


class CalibrationError(LumitipError, ValueError):
    """A calibration that cannot be measured, read or saved."""


class CalibrationMismatch(CalibrationError):
    """A calibration of another design or device."""


class SharingError(LumitipError):
    """A fingertip that cannot be shared as asked."""


class ViewError(LumitipError):
    """A request that the live view cannot do."""
