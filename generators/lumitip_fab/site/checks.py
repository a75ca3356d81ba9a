"""Every check with value, limit and margin, as data that the page sorts and filters."""

import math
from typing import Any

from lumitip_fab.checks.result import relative_margin
from lumitip_fab.site.folder import Checked, Folder
from lumitip_fab.site.targets import Targets


def check_rows(folder: Folder, targets: Targets) -> list[dict[str, Any]]:
    """The measurements, those that fail first, then by relative margin."""
    return [_row(each, targets) for each in sorted(folder.checked or (), key=_rank)]


def _rank(checked: Checked) -> tuple[bool, float, str, str]:
    m = checked.measurement
    share = relative_margin(m)
    return checked.passed, math.inf if share is None else share, m.check, m.subject


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
