"""Cells that are dead or stuck: left out by name, and a line is followed without them."""

import numpy as np
import pytest

from bench_dead_cells import TUNED
from lumitip import Layout
from lumitip.estimation import PoseEstimator
from lumitip.tasks import Settings, Task, TaskError
from lumitip.tasks.trial import Bench
from lumitip.twin import Cable, HalfPlane, Scene, Twin

EDGE, CABLE = HalfPlane(offset_mm=1.0, angle_deg=8.0), Cable(offset_mm=-1.5, angle_deg=-12.0)


def lit_and_dark(twin: Twin, scene: Scene) -> tuple[list[int], list[int]]:
    """Cells that an object does not reach, and those that it covers."""
    values = twin.values(scene)
    return np.flatnonzero(values > 250.0).tolist(), np.flatnonzero(values < 5.0).tolist()


@pytest.mark.slow_cases
@pytest.mark.parametrize(("kind", "scene"), [("edge", EDGE), ("cable", CABLE)])
def test_stuck_cells_are_left_out_by_name(
    estimator: PoseEstimator, twin: Twin, wrong_twins: list[Twin], kind: str, scene: Scene
) -> None:
    lit, dark = lit_and_dark(twin, scene)
    for source in (twin, wrong_twins[3]):
        values = np.floor(source.values(scene))
        wanted = estimator(values, kind)
        assert wanted.left_out == ()
        stuck = sorted([lit[0], lit[len(lit) // 2], dark[0]] if dark else lit[:: len(lit) // 2])
        values[stuck] = [0.0 if cell in lit else 255.0 for cell in stuck]
        found = estimator(values, kind)
        assert set(found.left_out) <= set(stuck)
        assert set(found.left_out) >= set(stuck) & set(lit)
        assert found.offset_mm == pytest.approx(wanted.offset_mm, abs=0.3)
        assert found.angle_deg == pytest.approx(wanted.angle_deg, abs=2.0)
        assert "misfit" not in found.flags


def test_cells_without_a_value_are_named(estimator: PoseEstimator, twin: Twin) -> None:
    values = twin.values(EDGE)
    values[[3, 17]] = np.nan
    assert estimator(values, "edge").left_out == (3, 17)
    values = np.full(len(twin.layout), 255.0)
    values[5] = np.inf
    assert (estimator(values).kind, estimator(values).left_out) == ("none", (5,))


@pytest.mark.parametrize("tracking", [False, True])
def test_a_frame_with_too_few_values_is_no_empty_grasp(cells: Layout, tracking: bool) -> None:
    estimate = PoseEstimator(cells, tracking=tracking)
    every = tuple(range(len(cells)))
    for lost in (np.nan, np.inf, -np.inf, 1e10):
        for kind in (None, "edge"):
            found = estimate(np.full(len(cells), lost), kind)
            assert (found.kind, found.flags, found.left_out) == ("none", ("dead",), every)
    for known, flags in ((3, ("dead",)), (4, ())):
        for light, kind in ((255.0, "none"), (2.0, "covered")):
            values = np.full(len(cells), np.nan)
            values[:known] = light
            found = estimate(values)
            assert (found.kind, found.flags, found.left_out) == (kind, flags, every[known:])
    found = estimate(np.full(len(cells), 255.0))
    assert (found.kind, found.flags, found.left_out) == ("none", (), ())


@pytest.mark.slow
def test_a_tracker_goes_on_without_stuck_cells(twin: Twin) -> None:
    tracker = PoseEstimator(twin.layout, tracking=True)
    stuck = lit_and_dark(twin, CABLE)[0][:3]
    for step in np.arange(0.0, 1.5, 0.1):
        values = np.floor(twin.values(Cable(CABLE.offset_mm + step, CABLE.angle_deg)))
        values[stuck] = 0.0
        found = tracker(values, "cable")
        assert set(found.left_out) == set(stuck) and "dead" in found.flags
        assert found.offset_mm == pytest.approx(CABLE.offset_mm + step, abs=0.1)
    values[stuck] = twin.values(Cable(CABLE.offset_mm + step, CABLE.angle_deg))[stuck]
    assert (tracker(values, "cable").left_out, tracker(values, "cable").flags) == ((), ())


def test_a_tracker_takes_cells_back_that_had_no_value(twin: Twin) -> None:
    tracker, chance = PoseEstimator(twin.layout, tracking=True), np.random.default_rng(2)
    for _ in range(60):
        values = np.floor(twin.values(EDGE))
        missing = int(chance.integers(len(values)))
        values[missing] = np.nan
        found = tracker(values, "edge")
        assert (found.left_out, found.flags) == ((missing,), ())
    half = np.arange(len(values)) % 2 == 0
    for lost in (half, ~half):
        values = np.where(lost, np.nan, np.floor(twin.values(EDGE)))
        assert set(tracker(values, "edge").left_out) == set(np.flatnonzero(lost).tolist())


def test_a_fit_is_not_saved_by_leaving_out_many_cells(estimator: PoseEstimator, twin: Twin) -> None:
    chance = np.random.default_rng(4)
    values = np.floor(twin.values(EDGE))
    wild = chance.permutation(len(values))[:9]
    values[wild] = 255.0 - values[wild]
    found = estimator(values, "edge")
    assert found.left_out == () and "misfit" in found.flags


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["cloth", "cable"])
@pytest.mark.parametrize("reads", [None, 0.0, 255.0])
def test_traces_go_on_with_three_dead_cells(cells: Layout, kind: str, reads: float | None) -> None:
    bench = Bench(Task(cells, Settings(kind, dead_cells=3, dead_value=reads)))
    lost = [m.lost for m in bench.run_all("pose", 200.0, TUNED[kind], range(20))]
    assert sum(lost) <= 1


def test_each_trial_has_other_dead_cells(cells: Layout) -> None:
    task = Task(cells, Settings("cable", dead_cells=3, dead_value=0.0))
    drawn = [tuple(sorted(task.dead.tolist())) for seed in range(4) for _ in [task.reset(seed)]]
    assert len(set(drawn)) == 4 and {len(set(cells)) for cells in drawn} == {3}
    assert (task.reset(1)[task.dead] == 0.0).all()
    same = Task(cells, Settings("cable")).reset(1)
    alive = np.setdiff1d(np.arange(len(cells)), task.dead)
    np.testing.assert_array_equal(task.reset(1)[alive], same[alive])
    with pytest.raises(TaskError, match="dead_cells is 33; the layout has 32 cells"):
        Task(cells, Settings(dead_cells=33))
    with pytest.raises(TaskError, match="dead_value"):
        Settings(dead_value=256.0)
