"""Every check with value, limit and margin, as data that the page sorts and filters."""

import math
from typing import Any

from lumitip_fab.checks.result import Measurement, relative_margin
from lumitip_fab.site.folder import Folder
from lumitip_fab.site.targets import Targets


def check_rows(folder: Folder, targets: Targets) -> list[dict[str, Any]]:
    """The measurements, those that fail first, then by relative margin."""
    return [_row(m, targets) for m in sorted(folder.measurements, key=_rank)]


def _rank(m: Measurement) -> tuple[bool, float, str, str]:
    share = relative_margin(m)
    return m.passed, math.inf if share is None else share, m.check, m.subject


def _row(m: Measurement, targets: Targets) -> dict[str, Any]:
    share = relative_margin(m)
    return {
        "check": m.check,
        "subject": m.subject,
        "value": figure(m.measured),
        "limit": m.limit,
        "unit": m.unit,
        "margin": figure(m.margin) if math.isfinite(m.margin) else "",
        "share": None if share is None else round(max(share, 0.0) if m.passed else share, 4),
        "passed": m.passed,
        "note": m.note,
        "show": targets.of_measurement(m.subject, m.note),
    }


def figure(value: float) -> str:
    """A figure with four digits."""
    if not math.isfinite(value):
        return "none"
    return f"{value:.4g}" if abs(value) >= 1e-9 else "0"
