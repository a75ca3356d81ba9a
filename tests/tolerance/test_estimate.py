"""The estimates of a study against `PoseEstimator`, and its self-calibration against `learn`."""

import numpy as np
import pytest

from lumitip.estimation.learn import learn
from lumitip.estimation.search import ALPHA_SD, GAP_SD_MM
from lumitip.twin import Model
from lumitip.twin.built import Lines
from lumitip_fab.derive.auto.resolve import Resolved
from lumitip_fab.derive.making.tolerances import spreads
from lumitip_fab.tolerance.bench import AGREED, COLUMNS, Bench
from lumitip_fab.tolerance.draws import Draws, draw
from lumitip_fab.tolerance.estimate import gross
from lumitip_fab.tolerance.options import Goals
from lumitip_fab.tolerance.yields import good


def drawn(design: Resolved, fingers: int, seed: int) -> Draws:
    cells = len(design.design.layout)
    return draw(design.config.catalogue.tolerances, spreads(design.config), cells, fingers, seed)


@pytest.mark.slow
def test_errors_of_many_frames_are_those_of_the_pose_estimator(
    design: Resolved, tried: Bench
) -> None:
    frames = tried.frames(drawn(design, 12, 5), tried.lines)
    for kind, lines in tried.lines.items():
        values = frames[kind].tared
        estimates = tried.estimates(lines)
        own = estimates.errors(values, lines, estimates.nothing_known(12))
        theirs, ambiguous = estimates.searched(values, lines)
        assert ambiguous.mean() < 0.25
        both = [np.abs(errors[~ambiguous]) for errors in (own, theirs)]
        same = (np.abs(own - theirs)[~ambiguous] <= AGREED).all(axis=1)
        assert same.mean() > 0.95, kind
        percentiles = [np.percentile(errors, [50, 75, 90], axis=0) for errors in both]
        assert np.allclose(*percentiles, rtol=0.1), kind
        rms = [np.sqrt((errors**2).mean(axis=1)) for errors in (own, theirs)]
        assert np.allclose(*(np.median(errors, axis=0) for errors in rms), rtol=0.1), "and all"


def test_an_estimate_follows_a_gross_error_to_its_limit(tried: Bench) -> None:
    lines = Lines("edge", np.array([[0.1, 0.0]]))
    dark = np.full((1, 1, 32), 255.0)
    dark[..., :4] = 0.0
    estimates = tried.estimates(lines)
    errors = estimates.errors(dark, lines, estimates.nothing_known(1))
    assert np.isfinite(errors).all()
    assert np.all(np.abs(errors) <= (2.0, 10.0))


@pytest.mark.slow
def test_self_calibration_finds_what_learning_finds(design: Resolved, tried: Bench) -> None:
    layout, fingers = design.design.layout, drawn(design, 3, 8)
    frames = tried.frames(fingers, {"use": tried.use})["use"].tared
    found = tried.estimates(tried.use).learned(frames, tried.use)
    model = Model.from_layout(layout)
    for number, values in enumerate(frames):
        learned = learn(layout, values, "edge", most_frames=len(values))
        assert np.sqrt(np.mean((learned.gains - found.gains[number]) ** 2)) < 0.015
        gap_mm, alpha = found.drift[number] * (GAP_SD_MM, ALPHA_SD)
        assert learned.model.gap_mm - model.gap_mm == pytest.approx(gap_mm, abs=0.2)
        assert learned.model.alpha - model.alpha == pytest.approx(alpha, abs=0.08)


@pytest.mark.slow
def test_self_calibration_lowers_the_misfit_of_an_uneven_finger(
    design: Resolved, tried: Bench
) -> None:
    fingers = {name: 0.0 * of for name, of in drawn(design, 4, 2).items()}
    gains = 0.06 * np.random.default_rng(1).standard_normal((4, 32))
    uneven = {**fingers, "drift": gains, "gap": np.full((4, 1), 0.5)}
    tared, learned = tried.errors(uneven, ("after tare", "after self-calibration"))[..., :4]
    noise = 0.01  # of cables, which the tare alone leaves within 0.03 mm of their places
    assert np.all(learned.mean(axis=0) < 0.9 * tared.mean(axis=0) + noise)
    assert learned.sum() < 0.75 * tared.sum()
    frames = tried.frames(uneven, {"use": tried.use})["use"].tared
    known = tried.estimates(tried.use).learned(frames, tried.use)
    off = known.gains / known.gains.mean(axis=1, keepdims=True) - 1.0 - gains
    assert np.sqrt(np.mean(off**2)) < 0.05
    assert np.allclose(known.drift[:, 0] * GAP_SD_MM, 0.5, atol=0.25)


def test_a_finger_with_a_gross_error_is_never_good(design: Resolved, tried: Bench) -> None:
    assert gross(np.array([[2.0, 0.0], [0.0, -10.0], [1.9, 9.0]])).tolist() == [True, True, False]
    fingers = {name: 0.0 * of for name, of in drawn(design, 2, 2).items()}
    far = {**fingers, "mask_shift": np.array([[0.0, 0.0, 4.0, 4.0], [0.0] * 4])}
    rows = tried.errors(far, COLUMNS[1:2])[0]
    assert rows[0, 4] > 0.0
    assert rows[1, 4] == 0.0
    assert good(rows, Goals.of_both(2.0, 10.0)).mean() == 0.5
