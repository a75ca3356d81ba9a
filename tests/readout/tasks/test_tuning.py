"""The search for tunings: as hard for the published law as for the law of the line."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import pytest

from lumitip.links.twin import published_layout
from lumitip.processing import Processor
from lumitip.tasks import Bench, Metrics, Settings, Task, Tuning, search, summary
from lumitip.tasks.curve import BEND_DEG
from lumitip.tasks.trial import CENTRE_GRID, GRIDS, LINE_GRID, SEEDS, around, at_edge
from lumitip.twin import HalfPlane, Twin

GAINS = sorted({tuning.gain_per_s for tuning in CENTRE_GRID})
HEIGHTS_MM = sorted({tuning.height_mm for tuning in CENTRE_GRID})


@dataclass
class Recorder:
    """A bench that runs nothing: it records what it is asked, and makes up the lateral rms."""

    rms_mm: Callable[[Tuning], float]
    asked: list[tuple[str, float, Tuning, tuple[int, ...]]] = field(default_factory=list)

    def run_all(
        self, controller: str, speed_mm_s: float, tuning: Tuning, seeds: Iterable[int]
    ) -> list[Metrics]:
        """One trial for each seed, all alike; above 5 mm the line is lost."""
        run, rms_mm = tuple(seeds), self.rms_mm(tuning)
        self.asked.append((controller, speed_mm_s, tuning, run))
        reason = "lost" if rms_mm > 5.0 else "end"
        return [Metrics(reason, 375.0, 4.0, rms_mm, 9.0, float("nan")) for _ in run]


def _bowl(gain_per_s: float, height_mm: float) -> Callable[[Tuning], float]:
    """Lateral rms that is least at a gain and a height."""
    return lambda t: 1.0 + abs(t.gain_per_s / gain_per_s - 1.0) + abs(t.height_mm - height_mm)


def test_every_controller_gets_as_many_trials_on_the_same_curves() -> None:
    trials = {}
    for controller in GRIDS:
        recorder = Recorder(_bowl(33.0, 0.2))
        tuned = search(recorder, controller, 200.0)  # type: ignore[arg-type]
        assert {asked[:2] for asked in recorder.asked} == {(controller, 200.0)}
        assert {seeds for *_, seeds in recorder.asked} == {SEEDS}
        assert tuned.tried == len({tuning for *_, tuning, _ in recorder.asked})
        trials[controller] = len(recorder.asked)
    assert trials == {"centre": 54, "line": 54, "pose": 54}
    assert min(SEEDS) >= 10_000  # the test's curves begin at 0


def test_the_gains_of_the_published_law_reach_beyond_sixty_four() -> None:
    assert GAINS[0] <= 8.0 and GAINS[-1] > 64.0
    assert HEIGHTS_MM[0] < 0.0 < HEIGHTS_MM[-1]
    assert max(tuning.gain_per_s for tuning in LINE_GRID) <= 64.0


@pytest.mark.parametrize(("gain_per_s", "height_mm"), [(37.0, -1.3), (12.5, 0.3), (70.0, -2.0)])
def test_the_published_law_is_refined_around_its_best(gain_per_s: float, height_mm: float) -> None:
    recorder = Recorder(_bowl(gain_per_s, height_mm))
    tuned = search(recorder, "centre", 200.0)  # type: ignore[arg-type]
    assert tuned.tuning.gain_per_s == pytest.approx(gain_per_s, rel=0.11)
    assert tuned.tuning.height_mm == pytest.approx(height_mm, abs=0.17)
    assert tuned.at_edge == () and tuned.losses == 0


@pytest.mark.parametrize("gain_per_s", GAINS[1:-1])
def test_refinements_stay_between_a_gain_and_its_neighbours(gain_per_s: float) -> None:
    near = around(Tuning(gain_per_s, height_mm=-1.0))
    place = GAINS.index(gain_per_s)
    assert len(set(near)) == 24
    assert GAINS[place - 1] < min(t.gain_per_s for t in near)
    assert max(t.gain_per_s for t in near) < GAINS[place + 1]
    assert -2.0 < min(t.height_mm for t in near) < max(t.height_mm for t in near) < 0.0


def test_fewer_losses_count_before_less_distance() -> None:
    keeps, loses = Tuning(8.0, 6.0), Tuning(12.0, 6.0)
    rms_mm = {keeps: 4.9, loses: 5.1}
    recorder = Recorder(lambda tuning: rms_mm[tuning])
    tuned = search(recorder, "line", 320.0, {"line": (loses, keeps)})  # type: ignore[arg-type]
    assert (tuned.tuning, tuned.losses, tuned.at_edge) == (keeps, 0, ("K_p",))


def test_a_best_at_the_edge_is_named() -> None:
    tried = [Tuning(gain, 6.0, lead) for gain in (8.0, 16.0, 32.0) for lead in (0.0, 0.03, 0.06)]
    assert at_edge(Tuning(16.0, 6.0, 0.03), tried) == ()
    assert at_edge(Tuning(32.0, 6.0, 0.03), tried) == ("K_p",)
    assert at_edge(Tuning(8.0, 6.0, 0.06), tried) == ("K_p", "lead")
    low = Recorder(_bowl(3.0, 0.0))
    assert search(low, "centre", 200.0).at_edge == ("K_p",)  # type: ignore[arg-type]


def test_tuning_keeps_off_tunings_that_lose_the_line() -> None:
    bench = Bench(Task(published_layout(), Settings("cloth", length_mm=200.0)))
    best = Tuning(8.0, 10.0)
    grids = {"line": (Tuning(-8.0, 4.0), best, Tuning(0.0, 0.0))}
    assert search(bench, "line", 100.0, grids, (10_000, 10_001)).tuning == best


def test_the_dark_centre_lies_lower_under_a_turned_line_which_height_makes_up_for() -> None:
    layout = published_layout()
    twin, processor = Twin(layout), Processor(layout)

    def centre_mm(angle_deg: float) -> float:
        contact = processor(twin.values(HalfPlane(offset_mm=0.0, angle_deg=180.0 + angle_deg)))
        assert contact.centre_mm is not None
        return contact.centre_mm[1]

    for angle_deg in (-BEND_DEG, BEND_DEG):
        assert centre_mm(angle_deg) < centre_mm(0.0) - 1.5
        assert min(HEIGHTS_MM) < centre_mm(angle_deg) - centre_mm(0.0)


@pytest.mark.slow
def test_without_the_height_the_published_law_loses_curves_at_any_gain() -> None:
    bench = Bench(Task(published_layout(), Settings("cloth")))
    for gain_per_s in (16.0, 64.0):
        assert summary(bench, "centre", 60.0, Tuning(gain_per_s), SEEDS).losses >= 4
    assert summary(bench, "centre", 60.0, Tuning(64.0, height_mm=-5.0 / 3.0), SEEDS).losses == 0
