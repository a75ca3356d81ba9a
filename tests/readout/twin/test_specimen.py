"""The gains of the published sensor's cells lower the misfit of each real frame left out."""

import numpy as np
import pytest

from lumitip.links.twin import published_layout
from lumitip.twin import Cable, HalfPlane, Model, Twin
from lumitip.twin.specimen import PUBLISHED_GAINS
from real_fit import NAMES, RealFit, Shared
from real_light import RealLight
from real_terms import MADE, PLAIN, Numbers, RealTwin

pytestmark = pytest.mark.slow

SD = 0.04
"""Deviation of the prior of the gains, as in `benchmarks/bench_real_misfit.py`."""
Own = dict[str, Numbers]


@pytest.fixture(scope="module")
def real_twin() -> RealTwin:
    """At the usual scattered share alone, which is faster."""
    return RealTwin(published_layout(), RealLight(published_layout(), (0.6,)))


@pytest.fixture(scope="module")
def fit(real_twin: RealTwin) -> RealFit:
    return RealFit(real_twin)


def _own(fit: RealFit, starts: Own) -> Own:
    return {name: fit.alone(name, starts[name], fit.nothing).own[name] for name in NAMES}


@pytest.fixture(scope="module")
def plain(fit: RealFit) -> Own:
    """Fits of a plain cloth, a corner and a straight cable."""
    return _own(fit, PLAIN)


@pytest.fixture(scope="module")
def made(fit: RealFit) -> Own:
    """The same with hems and a bend."""
    return _own(fit, {name: PLAIN[name] | MADE.get(name, {}) for name in NAMES})


@pytest.mark.parametrize("objects", ["plain", "made"])
def test_gains_of_two_frames_lower_the_misfit_of_the_third(
    fit: RealFit, objects: str, request: pytest.FixtureRequest
) -> None:
    own: Own = request.getfixturevalue(objects)
    found = fit.held_out(own, {}, SD)
    for name in NAMES:
        before = fit.started(name, own[name], fit.nothing)
        assert found[name][0] < before - 0.4, name


def test_the_same_gains_on_other_cells_do_not(fit: RealFit, plain: Own) -> None:
    found = fit.held_out(plain, {}, SD)
    lower = np.ones(31, bool)
    for name in NAMES:
        before = fit.started(name, plain[name], fit.nothing)
        shifted = [np.roll(found[name][1].gains, by) for by in range(1, 32)]
        after = np.array([fit.started(name, plain[name], Shared({}, s)) for s in shifted])
        lower &= after < before - 0.1
    assert np.count_nonzero(lower) <= 2


def test_a_blur_between_neighbours_does_not(fit: RealFit, plain: Own) -> None:
    found = fit.held_out(plain, {"blur": 0.05})
    before = {name: fit.started(name, plain[name], fit.nothing) for name in NAMES}
    assert any(found[name][0] > before[name] + 0.4 for name in NAMES)


def test_the_gains_of_the_twin_are_those_of_all_three_frames(fit: RealFit, made: Own) -> None:
    gains = fit.together(made, fit.nothing, SD).shared.gains
    assert gains == pytest.approx(PUBLISHED_GAINS, abs=0.02)


def test_a_twin_has_them_only_on_request() -> None:
    layout = published_layout()
    assert len(PUBLISHED_GAINS) == len(layout)
    assert np.array_equal(Twin(layout).gains, np.ones(len(layout)))
    dark = Twin(layout, gains=PUBLISHED_GAINS).values()
    assert dark.argmin() == np.argmin(PUBLISHED_GAINS) == 22


@pytest.mark.parametrize("name", ["cloth_edge", "cable"])
def test_the_fitted_twin_is_the_twin(real_twin: RealTwin, name: str) -> None:
    """At a gap that was computed; an edge on the twin's raster."""
    own = {"offset_mm": 0.4, "angle_deg": 183.0, "gap_mm": 4.0, "light": 1.0, "clear": 0.0}
    light, drive = real_twin.light(name, own, {})
    twin = Twin(published_layout(), Model.from_layout(published_layout(), 4.0))
    at, cloth = twin.plane(), HalfPlane(0.4, 183.0)
    expected = {
        "cloth_edge": twin.batch(cloth.coverage(at.x_mm, at.y_mm, at.pixel_mm)[None])[0],
        "cable": twin.values(Cable(0.4, 183.0)),
    }
    assert real_twin.values(light, drive, {}) == pytest.approx(expected[name], abs=0.1)
