"""Closed loops on few curves, and what carries them."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lumitip.control import CentreLaw, Command, LineLaw, Tracer
from lumitip.links.twin import published_layout
from lumitip.tasks import Bench, Curve, Settings, Summary, Task, TaskError, Tuned, Tuning, summary
from lumitip.tasks.bench import Result, advantages, bench_tasks, workers
from lumitip.tasks.report import goals, markdown, write
from lumitip.tasks.trial import Team
from lumitip.twin import Corner

LAYOUT = published_layout()
TUNED = Tuning(8.0, 10.0)
FOUND = Tuned(TUNED, 320.0, 2, 54, ("K_p",))


@pytest.fixture(scope="module")
def cloth() -> Bench:
    """A cloth's edge of 200 mm."""
    return Bench(Task(LAYOUT, Settings("cloth", length_mm=200.0)))


def test_curves_are_smooth_seeded_and_straight_at_the_end() -> None:
    curve = Curve.random(400.0, seed=3, straight_end_mm=80.0)
    again, other = (Curve.random(400.0, seed=s, straight_end_mm=80.0) for s in (3, 4))
    assert np.array_equal(curve.y_mm, again.y_mm) and not np.array_equal(curve.y_mm, other.y_mm)
    steps = np.hypot(np.diff(curve.x_mm), np.diff(curve.y_mm))
    assert steps == pytest.approx(0.25) and curve.length_mm == 400.0
    assert np.abs(curve.bend_per_mm).max() < 1.0 / 20.0
    assert np.abs(curve.heading[-300:]).max() == pytest.approx(0.0, abs=1e-9)
    assert np.degrees(np.abs(curve.heading).max()) > 10.0
    assert curve.nearest(float(curve.x_mm[800]) + 0.05, float(curve.y_mm[800]), near=760) == 800


def test_the_finger_moves_as_commanded_with_lag_and_latency() -> None:
    task = Task(LAYOUT, Settings("cable", rate_hz=100.0, lag_s=0.05, latency=2, noise=0.0))
    seen = [task.reset(0)]
    for _ in range(100):
        values, _ = task.step(Command(forward_mm_s=10.0))
        seen.append(values)
    # A first-order lag is behind by velocity times its time constant.
    assert task.x_mm == pytest.approx(10.0 * (1.0 - 0.05), abs=0.01)
    task = Task(LAYOUT, Settings("cable", latency=2, noise=0.0))
    first = task.reset(0)
    moved = [task.step(Command(lateral_mm_s=40.0))[0] for _ in range(4)]
    assert np.array_equal(moved[0], first) and np.array_equal(moved[1], first)
    assert not np.array_equal(moved[2], first)


@pytest.mark.slow
def test_what_is_seen_is_where_the_truth_says() -> None:
    from lumitip.estimation import PoseEstimator

    estimator = PoseEstimator(LAYOUT)
    for kind in ("cloth", "cable"):
        task = Task(LAYOUT, Settings(kind, latency=0, noise=0.0))
        task.reset(5)
        task.heading, task.y_mm = math.radians(12.0), 1.5
        values, _ = task.step(Command())
        told = estimator(values)
        height_mm, angle = task.line()
        assert told.kind == ("edge" if kind == "cloth" else "cable")
        assert told.angle_deg == pytest.approx(math.degrees(angle), abs=0.8)
        seen_mm = told.offset_mm / math.cos(math.radians(told.angle_deg))
        assert seen_mm == pytest.approx(height_mm, abs=0.2)
        assert told.dark_side == ("left" if kind == "cloth" else "")


def test_the_line_law_stays_closer_to_the_line_than_the_published_law(cloth: Bench) -> None:
    published = summary(cloth, "centre", 120.0, Tuning(67.5, height_mm=-1.67), range(3))
    line, pose = (summary(cloth, name, 120.0, TUNED, range(3)) for name in ("line", "pose"))
    assert published.losses == line.losses == pose.losses == 0
    assert max(line.lateral_rms_mm, pose.lateral_rms_mm) < published.lateral_rms_mm
    assert max(line.angle_rms_deg, pose.angle_rms_deg) < published.angle_rms_deg
    assert summary(cloth, "centre", 200.0, TUNED, range(3)).losses >= 2  # its gain is too low


def test_a_law_with_the_wrong_sign_loses_the_line(cloth: Bench) -> None:
    assert summary(cloth, "line", 80.0, Tuning(-8.0, -10.0), range(2)).losses == 2


def test_the_same_seed_gives_the_same_trial(cloth: Bench) -> None:
    first, again = (cloth.run("line", 120.0, TUNED, 7) for _ in range(2))
    assert first.lateral_rms_mm == again.lateral_rms_mm and first.reason == "end"


@pytest.mark.slow
def test_cloth_tracing_ends_at_the_corner() -> None:
    bench = Bench(Task(LAYOUT, Settings("cloth", length_mm=200.0, corner=True)))
    for controller in ("line", "pose"):
        told = bench.run(controller, 80.0, TUNED, 1)
        assert told.reason == "corner" and abs(told.corner_error_mm) < 1.5
    assert isinstance(bench.task.scene(), Corner)
    # Without being told to stop there it runs off the corner.
    tracer, values = Tracer(LineLaw(80.0)), bench.task.reset(1)
    observe, ended = bench.observer("line"), False
    while not ended:
        values, ended = bench.task.step(tracer(observe(values), 1.0 / 55.0))
    assert bench.task.metrics().lost


def test_settings_are_checked() -> None:
    for wrong in ({"kind": "rope"}, {"kind": "cable", "corner": True}, {"rate_hz": 0.0}):
        with pytest.raises(TaskError):
            Settings(**wrong)  # type: ignore[arg-type]


@pytest.mark.slow
def test_the_bench_writes_table_figures_and_plots(tmp_path: Path) -> None:
    said: list[str] = []
    results = bench_tasks(
        LAYOUT,
        1,
        said.append,
        ("line",),
        {"line": (80.0, 5000.0)},
        {"line": (TUNED,)},
        tuning_seeds=(10_000,),
    )
    assert [r.task for r in results] == ["cloth", "cable", "corner"]
    for r in results:
        best = r.fastest()
        assert best is not None and best.speed_mm_s == 80.0 and len(r.rows) == 2
    written = {p.name: p for p in write(results, tmp_path)}
    assert "NaN" not in written["tasks.json"].read_text()
    table = written["tasks.md"].read_text()
    assert table.count("| line angle | 8/s | 10/s | 0 s | – | 1 | 0 at 320 mm/s | – |") == 3
    assert "cloth, line: K_p 8/s, K_θ 10/s, lead 0 s (best of 1, 0 lost at 320 mm/s)" in said
    assert table.count("| line angle | 80 mm/s | 0 of 1 | ") == 3
    assert table.count("| line angle | 5000 mm/s | 1 of 1 | – | – | – |") == 3
    if "tasks.svg" in written:
        text = written["tasks.svg"].read_text()
        assert "edge of a cloth" in text and "curves lost" in text


@pytest.mark.slow
def test_a_team_of_processes_finds_what_one_bench_finds() -> None:
    settings = Settings("cable", length_mm=120.0)
    one = Bench(Task(LAYOUT, settings)).run_all("line", 100.0, TUNED, range(3))
    with workers(2) as pool:
        team = Team(pool, LAYOUT, settings).run_all("line", 100.0, TUNED, range(3))
    assert list(map(repr, team)) == list(map(repr, one))  # NaN is not equal to itself


def test_highest_speeds_count_only_up_to_the_first_failure() -> None:
    row = Summary(20.0, 100, 0, 0.5, 2.0, math.nan)
    rows = (row, replace(row, speed_mm_s=40.0, losses=3), replace(row, speed_mm_s=60.0))
    told = Result("cloth", "centre", FOUND, rows)
    assert [r.speed_mm_s if r else None for r in (told.fastest(), told.fastest(0.05))] == [20, 60]
    none = replace(told, rows=(replace(row, losses=100),))
    assert none.fastest() is None and "| – | – | – | – |" in markdown([none])


def test_controllers_are_held_against_the_published_law_at_equal_loss() -> None:
    row = Summary(0.0, 100, 0, 0.5, 2.0, math.nan)

    def result(controller: str, *rows: tuple[float, int]) -> Result:
        made = tuple(replace(row, speed_mm_s=speed, losses=lost) for speed, lost in rows)
        return Result("cloth", controller, FOUND, made)

    centre = result("centre", (20.0, 0), (40.0, 0), (60.0, 4), (80.0, 6))
    line = result("line", (120.0, 0), (160.0, 5), (200.0, 9))
    pose = result("pose", (100.0, 0), (120.0, 1))
    told = [centre, line, pose]
    assert [a.times for a in advantages(told)] == [3.0, 2.5]
    assert [a.times for a in advantages(told, 0.05)] == [160.0 / 60.0, 2.0]
    ((met, goal),) = goals(told)
    assert met and "3.0 (120 against 40 mm/s) times as fast" in goal
    assert "at most 5 % loss: 2.7 (160 against 60 mm/s)" in goal
    assert "| 120 mm/s | 3.0 | 160 mm/s | 2.7 |" in markdown(told)
    slow, nothing = result("line", (110.0, 0)), result("line", (100.0, 8))
    assert [met for met, _ in goals([centre, slow])] == [False]
    assert [met for met, _ in goals([centre, nothing])] == [False]
    assert advantages([line]) == []


def test_centre_target_is_the_middle_of_the_dark(cloth: Bench) -> None:
    law = cloth.tracer("centre", 20.0, TUNED).law
    # The sheet is towards the tip: all rows above the line are dark, and weigh nearly the same.
    above_mm = float(LAYOUT.y_mm[LAYOUT.y_mm > 1.0].mean())
    assert isinstance(law, CentreLaw) and law.target_mm == pytest.approx(above_mm, abs=0.6)
    lower = cloth.tracer("centre", 20.0, replace(TUNED, height_mm=-1.5)).law
    assert isinstance(lower, CentreLaw) and lower.target_mm == law.target_mm - 1.5
