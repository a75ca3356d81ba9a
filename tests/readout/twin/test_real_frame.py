"""The published frame of a cloth edge, against the twin fitted to it."""

from collections.abc import Callable

import numpy as np
import pytest

from lumitip.links.twin import published_layout
from lumitip.twin.fit import NAMES, fit_edge, read

pytestmark = pytest.mark.slow

FOUND = (0.087, 182.36, -0.0014, 0.065, 2.5, 0.95, 0.850, 0.022, -0.114)
"""What `fit_edge` finds, in the order of `NAMES`."""


@pytest.fixture
def frame(published_values: Callable[[str], np.ndarray]) -> np.ndarray:
    return published_values("cloth_edge").astype(np.float64)


def rms(frame: np.ndarray, **changed: float) -> float:
    numbers = dict(zip(NAMES, FOUND, strict=True)) | changed
    read_by_twin = read(published_layout(), np.array([numbers[name] for name in NAMES]))
    return float(np.sqrt(np.mean((read_by_twin - frame) ** 2)))


def test_nine_numbers_come_within_ten_counts(frame: np.ndarray) -> None:
    assert len(NAMES) <= 10
    assert rms(frame) < 10.0


@pytest.mark.parametrize(
    "damage",
    [{"offset_mm": 1.0}, {"angle_deg": 190.0}, {"gap_mm": 5.0}, {"gain": 1.2}, {"clear": 0.3}],
)
def test_other_numbers_do_not(frame: np.ndarray, damage: dict[str, float]) -> None:
    assert rms(frame, **damage) > 12.0


def test_the_fit_finds_them_from_elsewhere(frame: np.ndarray) -> None:
    fitted = fit_edge(published_layout(), frame, 1.0, 177.0)
    assert fitted.rms < 9.8
    assert fitted.numbers["angle_deg"] == pytest.approx(182.4, abs=0.5)
    assert fitted.values - frame == pytest.approx(0.0, abs=30.0)


def test_the_fit_finds_the_truth_where_there_is_one() -> None:
    truth = np.array([0.5, 186.0, 0.003, 0.1, 2.6, 0.55, 0.88, 0.03, -0.05])
    fitted = fit_edge(published_layout(), read(published_layout(), truth), 0.3, 184.5)
    assert fitted.rms < 0.5
    assert fitted.numbers["offset_mm"] == pytest.approx(0.5, abs=0.05)
    assert fitted.numbers["angle_deg"] == pytest.approx(186.0, abs=0.3)
