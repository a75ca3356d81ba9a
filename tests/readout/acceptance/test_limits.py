"""A deviation stays within its limit by half of its standard deviation."""

from dataclasses import replace

import numpy as np
import pytest

from lumitip.acceptance.fingers import faults_of_fingers
from lumitip.acceptance.fit import Fitted
from lumitip.acceptance.response import NAMES

SD = {"receiver_x": 0.1, "receiver_turn": 0.4, "gap": 0.08, "scatter": 0.1, "hole": 0.1}
GOOD = Fitted(np.zeros(len(NAMES)), np.array([SD.get(n, 0.05) for n in NAMES]), np.zeros((2, 9)))


def found(name: str, value: float, sd: float | None = None) -> list[str]:
    """Kinds of the findings of fingers with one deviation."""
    deviations, sds = GOOD.deviations.copy(), GOOD.sd.copy()
    deviations[NAMES.index(name)] = value
    sds[NAMES.index(name)] = SD[name] if sd is None else sd
    every = faults_of_fingers(replace(GOOD, deviations=deviations, sd=sds), {"scatter": 0.0})
    assert all(finding.times_limit > 1 for finding in every)
    return [finding.kind for finding in every]


@pytest.mark.parametrize(
    ("name", "most", "kind"),
    [
        ("receiver_x", 0.95, "receiver mask"),
        ("receiver_turn", 2.3, "receiver mask"),
        ("gap", 0.56, "gap"),
        ("scatter", 0.25, "silicone"),
        ("scatter", -0.35, "silicone"),
        ("hole", 0.45, "holes"),
    ],
)
def test_half_a_standard_deviation_is_left_to_the_limit(name: str, most: float, kind: str) -> None:
    assert found(name, 0.98 * most) == []
    assert found(name, 1.02 * most) == [kind]


def test_what_is_hardly_known_is_accepted_up_to_half_of_the_limit() -> None:
    assert found("gap", 0.29, sd=5.0) == [] and found("gap", 0.31, sd=5.0) == ["gap"]


def test_the_accepted_figure_is_said() -> None:
    fitted = replace(GOOD, deviations=np.where(np.array(NAMES) == "gap", 0.58, 0.0))
    [finding] = faults_of_fingers(fitted, None)
    assert "gap: +0.58 mm beyond the gauge's; at most 0.56 mm" in finding.text
