"""Every check with value, limit and margin, as data that the page sorts and filters."""

import math
from typing import Any

from lumitip_fab.checks.result import NOISE, Measurement, relative_margin
from lumitip_fab.site.folder import Checked, Folder
from lumitip_fab.site.targets import Targets

_AT_LIMIT_MM = 0.001 + NOISE
_AT_LIMIT = 0.005  # of the limit


def check_rows(folder: Folder, targets: Targets) -> list[dict[str, Any]]:
    """The measurements, those that fail first, then by relative margin; those without one, and
    those that are drawn at their limit, are last."""
    return [_row(each, targets) for each in sorted(folder.checked or (), key=rank)]


def rank(checked: Checked) -> tuple[int, float, str, str]:
    """The place of a measurement in the table."""
    m = checked.measurement
    share = relative_margin(m)
    group = 0 if not checked.passed else 3 if share is None else 2 if at_limit(m) else 1
    return group, math.inf if share is None else share, m.check, m.subject


def at_limit(measurement: Measurement) -> bool:
    """Whether a length is drawn as small as it may be, such as the width of a track: its margin of
    0 says nothing of how well it was made."""
    m = measurement
    least = m.unit == "mm" and m.low > 0 and math.isinf(m.high)
    return least and m.margin + NOISE >= 0 and m.margin <= min(_AT_LIMIT_MM, m.low * _AT_LIMIT)


def _row(checked: Checked, targets: Targets) -> dict[str, Any]:
    m, passed = checked.measurement, checked.passed
    share = relative_margin(m)
    return {
        "check": m.check,
        "subject": m.subject,
        "value": figure(m.measured),
        "limit": m.limit,
        "unit": m.unit,
        "margin": figure(m.margin) if math.isfinite(m.margin) else "",
        "share": None if share is None else round(max(share, 0.0) if passed else share, 4),
        "passed": passed,
        "note": m.note,
        "show": targets.of_measurement(m.subject, m.note),
    }


def figure(value: float) -> str:
    """A figure with four digits."""
    if not math.isfinite(value):
        return "none"
    return f"{value:.4g}" if abs(value) >= 1e-9 else "0"
