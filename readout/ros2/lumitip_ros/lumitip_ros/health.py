"""Diagnostics of a fingertip for `/diagnostics`."""

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from lumitip import Fingertip


def status(
    name: str, tip: Fingertip | None, failure: str, age_s: float | None, stale_s: float
) -> DiagnosticStatus:
    """How a fingertip is.

    Args:
        name: of the node.
        tip: the open fingertip, if there is one.
        failure: why the link was given up; empty while it was not.
        age_s: age of the newest frame; `None` before the first.
        stale_s: age from which a frame is too old.
    """
    level, text = _judged(tip, failure, age_s, stale_s)
    found = DiagnosticStatus(level=level, name=f"{name}: fingertip", message=text)
    if tip is not None:
        stats = tip.stats
        found.hardware_id = tip.device_id
        dropped = sum(stats.dropped.values()) if stats.dropped else None
        figures = {
            "received": stats.received,
            "lost": "unknown" if dropped is None else dropped,
            "not read in time": stats.overflowed,
            "unreadable packets": stats.unreadable,
            "reconnections": stats.reconnects,
            "restarts of the device": stats.restarts,
            "rate (Hz)": "unknown" if stats.rate_hz is None else f"{stats.rate_hz:.1f}",
        }
        found.values = [KeyValue(key=key, value=str(value)) for key, value in figures.items()]
    return found


def _judged(
    tip: Fingertip | None, failure: str, age_s: float | None, stale_s: float
) -> tuple[bytes, str]:
    if failure:
        return DiagnosticStatus.ERROR, failure
    if tip is None:
        return DiagnosticStatus.STALE, "not configured"
    if not tip.connected:
        return DiagnosticStatus.WARN, "the link is cut, reconnecting"
    if age_s is None:
        return DiagnosticStatus.WARN, "connected, no frame yet"
    if age_s > stale_s:
        return DiagnosticStatus.WARN, f"the newest frame is {age_s:.1f} s old"
    return DiagnosticStatus.OK, "frames arrive"


def array(found: DiagnosticStatus, stamp: object) -> DiagnosticArray:
    """The message of one status."""
    message = DiagnosticArray(status=[found])
    message.header.stamp = stamp
    return message
