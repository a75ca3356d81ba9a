"""The covariance of an estimate is that of the numbers which it reports."""

import math
from dataclasses import replace

import numpy as np
import pytest

from lumitip.estimation import Estimate, PoseEstimator
from lumitip.estimation.estimate import report
from lumitip.estimation.fit import Fit
from lumitip.estimation.uncertain import covariance
from lumitip.twin import Cable, Corner, HalfPlane, Twin

STEP = 1e-5
SCENES = {
    "edge": HalfPlane(offset_mm=1.3, angle_deg=12.0, clear=0.4),
    "cable": Cable(offset_mm=-0.7, angle_deg=-31.0, diameter_mm=3.4),
    "corner": Corner(x_mm=1.0, y_mm=-2.0, angle_deg=100.0, clear=0.3),
}
OWN = {
    "edge": set(),
    "cable": {"width_mm"},
    "corner": {"direction_deg", "opening_deg", "x_mm", "y_mm"},
}


def number(estimate: Estimate, name: str) -> float:
    """The number that a row of the covariance is about."""
    if name in ("x_mm", "y_mm"):
        assert estimate.vertex_mm is not None
        return estimate.vertex_mm["xy".index(name[0])]
    return float(getattr(estimate, name))


@pytest.mark.parametrize("kind", SCENES)
def test_rows_are_those_of_the_reported_numbers(
    estimator: PoseEstimator, twin: Twin, kind: str
) -> None:
    found = estimator.fitted(0.95 * twin.values(SCENES[kind]), kind)
    shape, uncertain = estimator._search.shape(kind), covariance(found)

    def reported(fit: Fit) -> Estimate:
        return report(shape, fit, uncertain, 50.0)

    estimate = reported(found)
    names = estimate.parameters
    assert set(names) == {"angle_deg", "offset_mm", "transmittance", "gain", *OWN[kind]}
    assert len(set(names)) == len(names) and estimate.covariance.shape == (len(names),) * 2
    by_pose = np.empty((len(names), found.pose.size))
    for entry in range(found.pose.size):
        step = STEP * np.eye(found.pose.size)[entry]
        less, more = (reported(replace(found, pose=found.pose + s)) for s in (-step, step))
        by_pose[:, entry] = [(number(more, n) - number(less, n)) / (2 * STEP) for n in names]
    expected = by_pose @ uncertain @ by_pose.T
    deviations = np.sqrt(np.diag(expected))
    assert (deviations > 0.0).all()
    difference = (estimate.covariance - expected) / np.outer(deviations, deviations)
    assert np.abs(difference).max() < 1e-3


def test_without_light_nothing_is_known_of_the_transmittance(
    estimator: PoseEstimator, twin: Twin
) -> None:
    found = estimator.fitted(twin.values(SCENES["edge"]), "edge")
    dark = replace(found, pose=np.array([*found.pose[:-2], 0.0, 0.4]))
    estimate = report(estimator._search.shape("edge"), dark, covariance(found), 50.0)
    assert math.isnan(estimate.transmittance) and estimate.gain == 0.0
    assert estimate.parameters == ("angle_deg", "offset_mm", "gain")
    assert np.isfinite(estimate.covariance).all()


def test_noise_moves_transmittance_and_gain_as_is_said(
    estimator: PoseEstimator, twin: Twin
) -> None:
    values, chance = 0.95 * twin.values(SCENES["edge"]), np.random.default_rng(0)
    noisy = [estimator(values + chance.standard_normal(values.size), "edge") for _ in range(40)]
    for name in ("transmittance", "gain"):
        at = noisy[0].parameters.index(name)
        said = np.sqrt(np.median([one.covariance[at, at] for one in noisy]))
        assert np.std([getattr(one, name) for one in noisy]) < 2.0 * said < 1.0
