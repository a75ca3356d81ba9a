"""Diagnostics of a fingertip for `/diagnostics`."""

import time
from dataclasses import dataclass

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from lumitip import Fingertip
from lumitip.errors import LinkError, StaleFrame
from lumitip_ros.pace import Published


@dataclass(frozen=True)
class Condition:
    """A node and its fingertip now."""

    tip: Fingertip | None
    """The open fingertip, if there is one."""
    failed: str
    """Why its link has failed for good; empty while it has not."""
    refused: str
    """Why the last attempt to configure the node failed; empty without."""
    stale_s: float
    """Age from which a frame is too old, received or published."""
    published: Published
    recorded: bool
    """Whether the frames come from a recording, which begins once the node is active."""


def status(name: str, now: Condition) -> DiagnosticStatus:
    """Level, text and figures of a fingertip.

    Args:
        name: of the node, with its namespace.
        now: of this node.
    """
    level, text = _level(now)
    message = DiagnosticStatus(level=level, name=f"{name}: fingertip", message=text)
    if now.tip is not None:
        message.hardware_id = now.tip.device_id
        figures = _figures(now.tip) | _published_figures(now.published)
        message.values = [KeyValue(key=key, value=text) for key, text in figures.items()]
    return message


def array(status: DiagnosticStatus, stamp: Time) -> DiagnosticArray:
    """The message of one status."""
    message = DiagnosticArray(status=[status])
    message.header.stamp = stamp
    return message


def _level(now: Condition) -> tuple[bytes, str]:
    tip, published, stale_s = now.tip, now.published, now.stale_s
    if tip is None:
        if now.refused:
            return DiagnosticStatus.ERROR, now.refused
        return DiagnosticStatus.STALE, "not configured"
    if now.failed:
        return DiagnosticStatus.ERROR, now.failed
    if not tip.connected:
        return DiagnosticStatus.WARN, "the link is cut, reconnecting"
    if now.recorded and not published.number:
        return DiagnosticStatus.OK, "the recording begins once the node is active"
    if now.recorded and published.newest_s is None:
        # Asking for the newest frame would take one from a recording that waits for its reader.
        return DiagnosticStatus.OK, "the node is not active"
    try:
        tip.latest(stale_s)
    except StaleFrame as error:
        return DiagnosticStatus.WARN, str(error)
    except LinkError as error:
        return DiagnosticStatus.ERROR, str(error)
    age_s = _age_s(published)
    if age_s is not None and age_s > stale_s:
        found = (
            f"the last published frame is {age_s:.3f} s old"
            if published.number
            else f"no frame was published in {age_s:.3f} s"
        )
        return DiagnosticStatus.WARN, (
            f"{found}, stale_s is {stale_s:g}: this computer is too slow. The parameter "
            "estimate: false needs less"
        )
    if tip.calibration.empty is None:
        return DiagnosticStatus.WARN, (
            "not tared: call ~/tare with nothing between the fingers (of a recording: before it "
            "is made)"
        )
    return DiagnosticStatus.OK, "frames arrive"


def _age_s(published: Published) -> float | None:
    newest_s = published.newest_s
    return None if newest_s is None else time.monotonic() - newest_s


def _published_figures(published: Published) -> dict[str, str]:
    age_s = _age_s(published)
    return {
        "published": str(published.number),
        "not published": str(published.skipped),
        "age of the last published (s)": "not active" if age_s is None else f"{age_s:.3f}",
    }


def _figures(tip: Fingertip) -> dict[str, str]:
    stats = tip.stats
    lost = "unknown" if stats.dropped is None else str(sum(stats.dropped.values()))
    return {
        "received": str(stats.received),
        "lost": lost,
        "not read in time": str(stats.overflowed),
        "unreadable packets": str(stats.unreadable),
        "reconnections": str(stats.reconnects),
        "restarts of the device": str(stats.restarts),
        "rate (Hz)": "unknown" if stats.rate_hz is None else f"{stats.rate_hz:.1f}",
    }
