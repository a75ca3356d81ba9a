"""The order of the page's table of checks."""

import math
from pathlib import Path

import pytest

from lumitip_fab.checks.result import Measurement, relative_margin
from lumitip_fab.site.checks import at_limit, rank
from lumitip_fab.site.folder import Folder
from site_page import Opened

pytestmark = pytest.mark.slow


def test_real_margins_come_first(opened: Opened, site: Path) -> None:
    """Tracks are as narrow as they may be, faults are none, counts are exact: all that is last."""
    folder = Folder.of(site)
    ranked = sorted(folder.checked or (), key=rank)
    margins = [relative_margin(each.measurement) for each in ranked]
    drawn = [at_limit(each.measurement) for each in ranked]
    first, last = drawn.index(True), margins.index(None)
    assert 0 < first < last == first + sum(drawn)
    assert all(margin is None for margin in margins[last:])
    real = [margin for margin in margins[:first] if margin is not None]
    assert real == sorted(real) and len(real) == first
    assert sum(margin < 0.005 for margin in real) < 5
    tab = opened()
    rows = tab.locator("#check-table tbody td:first-child").all_text_contents()
    assert rows[:20] == [each.measurement.check for each in ranked[:20]]
    assert "board.track_width" not in rows


@pytest.mark.parametrize(
    ("measured", "low", "high", "unit", "drawn"),
    [
        (0.2, 0.1994, math.inf, "mm", True),
        (1.5, 1.5, math.inf, "mm", True),
        (0.203, 0.2, math.inf, "mm", False),
        (0.19, 0.2, math.inf, "mm", False),
        (60.5, 60.5, math.inf, "mA", False),
        (0.05, 0.0, 0.05, "mm", False),
        (0.05, -0.05, 0.05, "mm", False),
    ],
)
def test_a_tolerance_that_is_used_up_is_a_real_margin(
    measured: float, low: float, high: float, unit: str, drawn: bool
) -> None:
    assert at_limit(Measurement("a.b", "file", measured, low, high, unit)) == drawn
