"""Cables that bend: a tracker finds the bend, and so is not led astray by a straight line."""

import math

import numpy as np
import pytest

from lumitip import Layout
from lumitip.estimation import Estimate, PoseEstimator
from lumitip.tasks import Settings, Task, Tuning
from lumitip.tasks.trial import Bench
from lumitip.twin import Cable, Twin

pytestmark = pytest.mark.slow


def _missed(told: Estimate, truth: Cable) -> tuple[float, float]:
    """How far the line told is from the truth (mm, degrees)."""
    turns = round((told.angle_deg - truth.angle_deg) / 180.0)
    offset_mm = truth.offset_mm * (-1.0) ** turns
    return (
        abs(told.offset_mm - offset_mm),
        abs(told.angle_deg - truth.angle_deg - 180.0 * turns),
    )


@pytest.mark.parametrize("radius_mm", [60.0, -90.0])
@pytest.mark.parametrize("angle_deg", [10.0, -50.0, 172.0])
def test_a_cable_that_begins_to_bend_is_followed(
    twin: Twin, radius_mm: float, angle_deg: float
) -> None:
    tracker = PoseEstimator(twin.layout, tracking=True)
    told = tracker(twin.values(Cable(1.0, angle_deg)), "cable")
    assert told.curvature_per_mm == 0.0
    for radius in (300.0, 150.0, 100.0, 1.0):
        bend = math.copysign(1.0 / max(radius, abs(radius_mm)), radius_mm)
        truth = Cable(1.5, angle_deg + 3.0, bend)
        told = tracker(np.floor(twin.values(truth)), "cable")
    offset_mm, angle = _missed(told, truth)
    assert told.kind == "cable" and offset_mm < 0.1 and angle < 0.6
    turned = abs(told.angle_deg - truth.angle_deg) > 90.0
    assert told.curvature_per_mm == pytest.approx(-bend if turned else bend, rel=0.1)
    assert "curvature_per_mm" in told.parameters and told.rms_counts < 4.0
    assert told.covariance.shape == (len(told.parameters),) * 2


def test_a_straight_cable_elsewhere_is_found_after_a_bend(twin: Twin) -> None:
    tracker = PoseEstimator(twin.layout, tracking=True)
    cables = [Cable(1.0, 5.0), Cable(1.5, 8.0, 1.0 / 60.0), Cable(-5.0, -30.0), Cable(5.0, 30.0)]
    for truth in cables:
        told = tracker(np.floor(twin.values(truth)), "cable")
    assert _missed(told, cables[-1]) == pytest.approx((0.0, 0.0), abs=0.5)


@pytest.mark.parametrize("seed", [0, 2])
def test_errors_that_stay_with_their_cells_are_no_bend(twin: Twin, seed: int) -> None:
    """40 of these frames would be told to bend if any smaller loss were enough."""
    chance = np.random.default_rng(seed)
    stays = chance.normal(0.0, 12.0, len(twin.layout))
    tracker = PoseEstimator(twin.layout, tracking=True)
    bends = []
    for k in range(100):
        truth = Cable(4.0 * math.sin(k / 17.0), 25.0 * math.sin(k / 23.0))
        noise = chance.normal(0.0, 1.5, len(twin.layout))
        values = np.clip(np.floor(twin.values(truth) + stays + noise), 0.0, 255.0)
        bends.append(tracker(values, "cable").curvature_per_mm)
    assert np.count_nonzero(bends) <= 10


def test_no_frame_at_the_limit_of_speed_is_told_elsewhere(cells: Layout) -> None:
    """On these curves straight fits jumped to a line across a corner of the fingertip, 3 mm and
    20 degrees off, where the cable bent most."""
    task = Task(cells, Settings("cable"))
    bench, tuning, period_s = Bench(task), Tuning(16.0, 10.0, 0.03), 1.0 / 55.0
    for seed in (5, 13, 36, 42, 47):
        trace, observe = bench.tracer("pose", 380.0, tuning), bench.observer("pose")
        values, ended, frames = task.reset(seed), False, 0
        truth = shown = task.scene()
        while not ended:
            frames += 1
            told = observe(values)
            assert isinstance(told, Estimate) and isinstance(truth, Cable)
            offset_mm, angle_deg = _missed(told, truth)
            assert offset_mm < 2.0 and angle_deg < 12.0
            values, ended = task.step(trace(told, period_s))
            truth, shown = shown, task.scene()
        assert frames > 30  # and not lost at once
