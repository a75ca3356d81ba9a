"""Why nothing comes from a link: texts for the user."""

from lumitip.errors import LinkTimeout
from lumitip.links.base import Fault, Link, Prepares


def no_connection(link: Link, timeout_s: float) -> LinkTimeout:
    """The error when a link did not connect in time."""
    why = "is the device switched on and in reach? `lumitip scan` lists devices"
    if isinstance(link, Prepares):
        why = link.why_late
    return LinkTimeout(f"no connection after {timeout_s:g} s: {why}")


def why_silent(device_id: str, connected: bool, unreadable: int, fault: Fault | None) -> str:
    """Why no frame comes.

    Args:
        device_id: name of the device.
        connected: whether the link is connected now.
        unreadable: packets that could not be decoded.
        fault: the last of them.
    """
    if not connected:
        return f"the connection to {device_id} is lost; reconnecting"
    if fault:
        return f"{unreadable} packets could not be decoded, the last: {fault.why}"
    return f"{device_id} is connected but sends nothing; is its firmware running?"
