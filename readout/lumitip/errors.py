"""The exceptions of the robot side, all under one root."""
# Named by what happened, as `TimeoutError` of the standard library would be without its suffix.
# ruff: noqa: N818

from collections.abc import Sequence
from typing import Any


def how_to_install(extras: str) -> str:
    """The commands that install this package with some extras; it is on no package index."""
    return (
        f"pip install '.[{extras}]' in Lumitip's folder, or pip install 'FILE.whl[{extras}]' "
        "with its wheel"
    )


class LumitipError(Exception):
    """Root of every error that `lumitip` raises on purpose."""


class ArgumentError(LumitipError, ValueError):
    """An argument that cannot be used: what was given and what is needed."""


class LayoutError(LumitipError, ValueError):
    """A `layout.json` that cannot be used: the message names the field, what was given and
    what is allowed."""


class LinkError(LumitipError):
    """Root of what goes wrong between a fingertip and this computer."""


class UrlError(LinkError, ValueError):
    """An address that names no link, or an option that the link does not have."""


class MissingExtra(LinkError, ImportError):
    """A library that this link needs is not installed."""

    def __init__(self, extra: str, what: str) -> None:
        super().__init__(f"{what} needs more than numpy: {how_to_install(extra)}")
        self.extra = extra
        """The extra to install."""


class LinkTimeout(LinkError, TimeoutError):
    """Nothing came in the time that was given."""

    block: Any = None
    """Of `get_data`: a `Block` of the frames that did come, `None` if there were none."""


class NotConnected(LinkError, ConnectionError):
    """The fingertip was closed, or its link is gone for good."""


class FingertipClosed(NotConnected):
    """The fingertip was closed by this program."""


class EndOfRecording(NotConnected):
    """A replay has given its last frame."""

    block: Any = None
    """Of `get_data`: a `Block` of the frames that were left, fewer than asked for, `None` if there
    were none."""


class DeviceNotFound(LinkError):
    """No device answers to the name, address or port."""


class AmbiguousDevice(LinkError):
    """Several devices answer to the name."""

    def __init__(self, name: str, addresses: Sequence[str], scheme: str) -> None:
        self.addresses = tuple(sorted(addresses))
        """Where they are: each can be opened by itself."""
        choices = ", ".join(f"{scheme}://{address}" for address in self.addresses)
        super().__init__(
            f"{name or 'no name'!r} given, {len(self.addresses)} devices answer to it: "
            f"open one of {choices}"
        )


class WrongDesign(LinkError):
    """The device, recording or file is of another design than the layout."""

    def __init__(
        self, found: str, expected: str, where: str, cells: tuple[int, int] | None = None
    ) -> None:
        has, wants = (f" with {n} cells" for n in cells) if cells else ("", "")
        super().__init__(
            f"{where} is of design {found}{has}, the layout of {expected}{wants}: give the "
            "layout.json that its firmware was built from, or flash the firmware of this design"
        )
        self.found = found
        """First digits of the design hash that came."""
        self.expected = expected
        """The same of the layout's."""


class MtuTooSmall(LinkError):
    """No frame fits into a Bluetooth notification, so none is sent."""

    def __init__(self, mtu: int, needed: int) -> None:
        super().__init__(
            f"the Bluetooth connection carries an ATT MTU of {mtu}, a frame of this layout needs "
            f"{needed}: use an adapter that negotiates a larger MTU, or the serial line"
        )
        self.mtu = mtu
        """ATT MTU in force."""
        self.needed = needed
        """The smallest at which a frame fits."""


class CalibrationError(LumitipError, ValueError):
    """A calibration that cannot be measured, read or kept."""


class CalibrationMismatch(CalibrationError):
    """A calibration of another design or device."""


class ViewError(LumitipError):
    """Something that the live view cannot do."""
