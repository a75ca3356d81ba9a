"""Diagnostics of a fingertip for `/diagnostics`."""

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from lumitip import Fingertip
from lumitip.errors import LinkError, StaleFrame


def status(
    name: str, tip: Fingertip | None, failed: str, refused: str, stale_s: float
) -> DiagnosticStatus:
    """Level, text and figures of a fingertip.

    Args:
        name: of the node, with its namespace.
        tip: the open fingertip, if there is one.
        failed: why its link has failed for good; empty while it has not.
        refused: why the last attempt to configure the node failed; empty without.
        stale_s: age from which a frame is too old.
    """
    level, text = _level(tip, failed, refused, stale_s)
    message = DiagnosticStatus(level=level, name=f"{name}: fingertip", message=text)
    if tip is not None:
        message.hardware_id = tip.device_id
        message.values = [KeyValue(key=key, value=text) for key, text in _figures(tip).items()]
    return message


def array(status: DiagnosticStatus, stamp: Time) -> DiagnosticArray:
    """The message of one status."""
    message = DiagnosticArray(status=[status])
    message.header.stamp = stamp
    return message


def _level(tip: Fingertip | None, failed: str, refused: str, stale_s: float) -> tuple[bytes, str]:
    if tip is None:
        if refused:
            return DiagnosticStatus.ERROR, refused
        return DiagnosticStatus.STALE, "not configured"
    if failed:
        return DiagnosticStatus.ERROR, failed
    if not tip.connected:
        return DiagnosticStatus.WARN, "the link is cut, reconnecting"
    try:
        tip.latest(stale_s)
    except StaleFrame as error:
        return DiagnosticStatus.WARN, str(error)
    except LinkError as error:
        return DiagnosticStatus.ERROR, str(error)
    return DiagnosticStatus.OK, "frames arrive"


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
