"""Expected errors: against the estimator, and where they must grow or fall."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Model, Twin
from lumitip_fab import derived
from lumitip_fab.explore.accuracy import Grasp, Sample, Trials, rms
from lumitip_fab.solve import information
from lumitip_fab.solve.information import Grasps, expected, lines, slope

ONE = Grasps((3.0,), (3.0,))


@pytest.fixture(scope="module")
def layout(design_dir: Path) -> Layout:
    return derived(design_dir / "presets/published.toml").layout


def _with_hole(layout: Layout, hole_mm: float) -> Layout:
    return replace(layout, optics=replace(layout.optics, hole_mm=hole_mm))


@pytest.mark.slow
def test_it_predicts_the_errors_of_the_estimator(layout: Layout) -> None:
    """Rms errors of real estimates, with wrong optics, over different holes."""
    found, wanted = [], []
    for hole_mm in (2.0, 2.5, 3.5):
        changed = _with_hole(layout, hole_mm)
        misses = Trials(changed, Sample(), Grasp()).misses("edge")
        found.append(rms(misses[:, 0]))
        wanted.append(expected(changed, ONE).rms()["edge_mm"])
    assert found[0] > found[1] > found[2]
    assert np.array(found) / np.array(wanted) == pytest.approx(1.0, abs=0.25)


def test_known_optics_and_gains_leave_the_bound_of_the_noise(
    layout: Layout, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With nothing else unknown it is the textbook bound of one parameter, computed here anew."""
    for name in ("GAIN_SD", "_LIGHT_SD", "_CLEAR_SD"):
        monkeypatch.setattr(information, name, 0.0)
    monkeypatch.setattr(information, "OPTICS_SD", dict.fromkeys(information.OPTICS_SD, 1e-9))
    monkeypatch.setattr(information, "POSE_SD", (1e3, 1e-6))
    own = expected(layout, Grasps((3.0,), (), 6)).edges[:, 0]
    twin, step_mm = Twin(layout, Model.from_layout(layout)), 0.05
    offsets_mm, angles_deg = lines(layout, 6)
    rise = twin.edges(offsets_mm + step_mm, angles_deg) - twin.edges(
        offsets_mm - step_mm, angles_deg
    )
    bound = information.COUNTS / np.linalg.norm(rise / (2.0 * step_mm), axis=1)
    assert own == pytest.approx(bound, rel=1e-3)


@pytest.mark.slow
def test_every_unknown_makes_the_errors_larger(
    layout: Layout, monkeypatch: pytest.MonkeyPatch
) -> None:
    def errors() -> Floats:
        found = expected(layout, ONE)
        return np.concatenate([found.edges, found.cables])

    usual = errors()
    for name in ("GAIN_SD", "_LIGHT_SD"):
        with monkeypatch.context() as known:
            known.setattr(information, name, 0.0)
            assert np.all(errors() <= usual + 1e-9), name
            assert np.any(errors() < 0.99 * usual), name
    for name, sd in information.OPTICS_SD.items():
        with monkeypatch.context() as known:
            known.setattr(information, "OPTICS_SD", information.OPTICS_SD | {name: sd / 1e6})
            assert np.all(errors() <= usual + 1e-9), name


def test_a_dim_finger_is_noisier_and_a_saturated_one_sees_less(layout: Layout) -> None:
    usual, dim, bright = (
        expected(layout, ONE, gain).rms()["cable_mm"]
        for gain in (Model.gain, Model.gain / 20.0, Model.gain * 4.0)
    )
    assert dim > 1.1 * usual
    assert bright > 1.1 * usual


def test_the_slope_at_the_ends_is_that_inside(layout: Layout) -> None:
    """Values are clipped beyond no light and full light; a difference across an end halves."""
    twin = Twin(layout, Model.from_layout(layout))
    inside = [slope(twin, np.full(len(layout), light)) for light in (0.01, 0.99)]
    ends = [slope(twin, np.full(len(layout), light)) for light in (0.0, 1.0)]
    assert ends[0] == pytest.approx(inside[0], rel=0.02)
    assert ends[1] == pytest.approx(inside[1], rel=0.15)


def test_cables_thicker_than_the_gap_are_left_out(layout: Layout) -> None:
    found = expected(layout, Grasps((2.0, 6.0), (1.0, 4.0), 5))
    assert len(found.edges) == 10
    assert len(found.cables) == 15
    assert "cable_mm" not in expected(layout, Grasps((2.0,), (4.0,), 5)).rms()
