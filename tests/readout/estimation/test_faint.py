"""Objects that the cells hardly see are found, and an empty grasp that drifts is not one."""

import numpy as np
import pytest

from lumitip import Layout
from lumitip.estimation import PoseEstimator
from lumitip.estimation.estimate import FAINT_CONTRAST, contrast
from lumitip.processing.processor import MIN_CONTRAST
from lumitip.twin import Cable, Twin

EMPTY, COUNTS = 400, 255.0


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    ("diameter_mm", "offset_mm"), [(0.6, -0.25), (0.8, 1.5), (2.0, -0.5), (3.0, 0.0)]
)
@pytest.mark.parametrize("kind", ["cable", None])
def test_a_cable_between_two_rows_of_cells(
    cells: Layout, twin: Twin, diameter_mm: float, offset_mm: float, kind: str | None
) -> None:
    cable = Cable(offset_mm=offset_mm, angle_deg=30.0, diameter_mm=diameter_mm)
    values = twin.values(cable)
    assert FAINT_CONTRAST < contrast(values) < MIN_CONTRAST
    found = PoseEstimator(cells, diameter_mm=diameter_mm)(values, kind)
    assert found.kind == "cable"
    assert found.offset_mm == pytest.approx(offset_mm, abs=0.3)
    assert found.angle_deg == pytest.approx(30.0, abs=2.0)


def empty(drift: float) -> list[np.ndarray]:
    """Frames of an empty grasp, after each cell's gain has drifted by itself."""
    chance = np.random.default_rng(0)
    gains = 1.0 + drift * chance.standard_normal((EMPTY, 32))
    noisy = COUNTS * gains + 1.5 * chance.standard_normal((EMPTY, 32))
    return list(np.floor(np.clip(noisy, 0.0, COUNTS)))


@pytest.mark.parametrize(("drift", "most"), [(0.0, 0), (0.01, 0), (0.02, 2)])
def test_an_empty_grasp_that_drifts_shows_nothing(
    estimator: PoseEstimator, drift: float, most: int
) -> None:
    frames = [f for f in empty(drift) if contrast(f) < MIN_CONTRAST]
    faint = [f for f in frames if contrast(f) > FAINT_CONTRAST]
    assert len(frames) > 0.9 * EMPTY
    assert drift < 0.02 or len(faint) > 50, "the contrast alone would not decide"
    assert sum(estimator(f).kind != "none" for f in frames) <= most


@pytest.mark.parametrize("direction_deg", range(0, 360, 30))
@pytest.mark.parametrize("share", [0.045, 0.06, 0.075])
@pytest.mark.parametrize("kind", [None, "edge", "cable"])
def test_a_slope_of_the_light_is_no_object(
    estimator: PoseEstimator, cells: Layout, direction_deg: int, share: float, kind: str | None
) -> None:
    """One side has drifted, as after light from outside or a leaning finger."""
    turn = np.radians(direction_deg)
    along = cells.x_mm * np.cos(turn) + cells.y_mm * np.sin(turn)
    values = COUNTS * (1.0 - share * (along - along.min()) / np.ptp(along))
    values += np.random.default_rng(direction_deg).standard_normal(len(cells))
    if contrast(values) < MIN_CONTRAST:
        assert estimator(values, kind).kind == "none"


def test_a_covered_finger_stays_covered(estimator: PoseEstimator) -> None:
    faint = 20.0 + np.linspace(0.0, 15.0, 32)
    assert FAINT_CONTRAST < contrast(faint) < MIN_CONTRAST
    assert estimator(faint).kind == "covered"
