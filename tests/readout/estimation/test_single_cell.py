"""One dark cell is no object: it may be dead or dirty, and an arm would follow it."""

import numpy as np
import pytest

from lumitip.estimation import PoseEstimator
from lumitip.links.twin import published_layout
from lumitip.twin import Cable, Twin

LAYOUT = published_layout()
EMPTY = np.full(len(LAYOUT), 255.0)


@pytest.fixture(scope="module")
def estimator() -> PoseEstimator:
    """An estimator for cables."""
    return PoseEstimator(LAYOUT).prepare("cable")


@pytest.mark.parametrize("value", [0.0, 130.0, 200.0])
def test_an_empty_grasp_with_one_dark_cell_has_no_line(
    estimator: PoseEstimator, value: float
) -> None:
    for cell in range(len(LAYOUT)):
        values = EMPTY.copy()
        values[cell] = value
        assert estimator(values, "cable").kind == "none", cell


@pytest.mark.slow
def test_a_thin_cable_is_still_seen(estimator: PoseEstimator) -> None:
    """Its shadow is on several cells, wherever it lies."""
    for offset_mm in np.linspace(-6.0, 6.0, 13):
        values = Twin(LAYOUT).values(Cable(offset_mm=float(offset_mm), diameter_mm=2.0))
        assert estimator(values, "cable").kind == "cable", offset_mm
