"""Diagnostics of a fingertip for `/diagnostics`."""

import time

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from lumitip import Fingertip
from lumitip.errors import LinkError, StaleFrame
from lumitip_ros.pace import Published


def status(
    name: str,
    tip: Fingertip | None,
    failed: str,
    refused: str,
    stale_s: float,
    published: Published,
    recorded: bool,
) -> DiagnosticStatus:
    """Level, text and figures of a fingertip.

    Args:
        name: of the node, with its namespace.
        tip: the open fingertip, if there is one.
        failed: why its link has failed for good; empty while it has not.
        refused: why the last attempt to configure the node failed; empty without.
        stale_s: age from which a frame is too old, received or published.
        published: the published frames.
        recorded: whether they come from a recording, which begins once the node is active.
    """
    level, text = _level(tip, failed, refused, stale_s, published, recorded)
    message = DiagnosticStatus(level=level, name=f"{name}: fingertip", message=text)
    if tip is not None:
        message.hardware_id = tip.device_id
        figures = _figures(tip) | _published_figures(published)
        message.values = [KeyValue(key=key, value=text) for key, text in figures.items()]
    return message


def array(status: DiagnosticStatus, stamp: Time) -> DiagnosticArray:
    """The message of one status."""
    message = DiagnosticArray(status=[status])
    message.header.stamp = stamp
    return message


def _level(
    tip: Fingertip | None,
    failed: str,
    refused: str,
    stale_s: float,
    published: Published,
    recorded: bool,
) -> tuple[bytes, str]:
    if tip is None:
        if refused:
            return DiagnosticStatus.ERROR, refused
        return DiagnosticStatus.STALE, "not configured"
    if failed:
        return DiagnosticStatus.ERROR, failed
    if not tip.connected:
        return DiagnosticStatus.WARN, "the link is cut, reconnecting"
    if recorded and not published.number:
        return DiagnosticStatus.OK, "the recording begins once the node is active"
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
