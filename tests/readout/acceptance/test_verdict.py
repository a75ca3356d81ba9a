"""Faults are found and named; good fingers are accepted."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from acceptance_frames import Bench
from lumitip.acceptance.gauge import Gauge, GaugeError
from lumitip.acceptance.steps import Frames
from lumitip.acceptance.verdict import Judge, Verdict
from lumitip.errors import ArgumentError
from lumitip.layout import Layout
from lumitip.links.twin import published_layout


def kinds(verdict: Verdict) -> list[str]:
    return [finding.kind for finding in verdict.findings]


def damaged(frames: Frames, damage: Callable[[np.ndarray], None]) -> Frames:
    """Frames after a damage of each array in place."""
    empty, sheet, moving = frames.empty.copy(), frames.sheet.copy(), frames.moving.copy()
    gauge = tuple(part.copy() for part in frames.gauge)
    for part in (empty, sheet, moving, *gauge):
        damage(part)
    return Frames(empty, sheet, moving, gauge)


def test_good_fingers_are_accepted(bench: Bench, judge: Judge) -> None:
    off = {"receiver_x": 0.3, "emitter_y": -0.3, "gap": 0.1, "scatter": 0.1, "emitter_turn": 0.5}
    verdict = judge(bench.frames(off))
    assert verdict.accepted, verdict.findings
    assert verdict.empty.max() > 200.0
    assert verdict.dark.max() < 5.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("deviations", "kind", "words"),
    [
        ({"receiver_x": 1.3}, "receiver mask", "mm to the right"),
        ({"emitter_y": -1.4}, "emitter mask", "mm towards the gripper"),
        ({"receiver_turn": 4.0}, "receiver mask", "to the left, seen on"),
        ({"gap": 1.1}, "gap", "gap: +1."),
        ({"gap": -1.1}, "gap", "gap: -1."),
        ({"scatter": -0.54}, "silicone", "from the drawing"),
        ({"hole": -0.8}, "holes", "rulers"),
    ],
)
def test_what_is_wrong_with_the_fingers_is_named(
    bench: Bench, judge: Judge, deviations: dict[str, float], kind: str, words: str
) -> None:
    verdict = judge(bench.frames(deviations))
    assert kinds(verdict)[0] == kind
    assert words in verdict.findings[0].text
    assert verdict.findings[0].times_limit > 1.0
    assert not verdict.accepted


@pytest.mark.slow
def test_scatter_is_compared_with_good_fingers(bench: Bench, judge: Judge) -> None:
    frames = bench.frames({"scatter": -0.45})
    assert judge(frames).accepted
    assert kinds(judge(frames, {"scatter": 0.0})) == ["silicone"]
    assert judge(frames, {"scatter": -0.4}).accepted


@pytest.mark.slow
def test_milky_silicone_is_named(bench: Bench, judge: Judge) -> None:
    [finding] = judge(bench.frames({"scatter": 0.38}), {"scatter": 0.0}).findings
    assert finding.kind == "silicone"
    assert "milky" in finding.text


@pytest.mark.slow
@pytest.mark.parametrize(
    ("thicker_mm", "kinds_of"),
    [((0.4, 0.0), ["receiver thickness"]), ((0.0, -0.5), ["emitter thickness"]), ((0.2, -0.2), [])],
)
def test_thickness_is_judged_where_it_was_measured(
    bench: Bench, judge: Judge, thicker_mm: tuple[float, float], kinds_of: list[str]
) -> None:
    off = dict(zip(("receiver_silicone", "emitter_silicone"), thicker_mm, strict=True))
    frames = bench.frames(off)
    assert kinds(judge(frames, None, thicker_mm)) == kinds_of
    # What was measured is not fitted as something else.
    found = judge(frames, None, thicker_mm).deviations
    assert abs(found["scatter"]) < 0.05
    assert abs(found["hole"]) < 0.1
    assert "thickness" not in " ".join(kinds(judge(frames)))


@pytest.mark.slow_cases
@pytest.mark.parametrize("pair", [(0, 1), (5, 20)])
def test_swapped_cells_are_named(bench: Bench, judge: Judge, pair: tuple[int, int]) -> None:
    def swap(frames: np.ndarray) -> None:
        frames[:, pair] = frames[:, pair[::-1]]

    verdict = judge(damaged(bench.frames(), swap))
    assert [(f.kind, f.cells) for f in verdict.findings] == [("swapped", pair)]
    assert "each reads what the other should" in verdict.findings[0].text


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "damage"),
    [
        ("dark", lambda light: light * 0.0),
        ("saturated", lambda light: light * 0.0 + 255.0),
        ("stuck", lambda light: light * 0.0 + 131.0),
        ("weak", lambda light: 0.3 * light),
        ("leak", lambda light: 60.0 + 0.6 * light),
    ],
)
def test_a_faulty_cell_is_named_and_the_others_are_judged(
    bench: Bench, judge: Judge, kind: str, damage: Callable[[np.ndarray], np.ndarray]
) -> None:
    def one(frames: np.ndarray) -> None:
        frames[:, 13] = damage(frames[:, 13])

    verdict = judge(damaged(bench.frames({"receiver_x": 0.4}), one))
    assert [(f.kind, f.cells) for f in verdict.findings] == [(kind, (13,))]
    assert verdict.deviations["receiver_x"] == pytest.approx(0.4, abs=0.1)


@pytest.mark.slow
def test_cells_that_are_bridged_are_named(bench: Bench, judge: Judge) -> None:
    def bridge(frames: np.ndarray) -> None:
        frames[:, [5, 20]] = frames[:, [5, 20]].mean(axis=1, keepdims=True)

    verdict = judge(damaged(bench.frames(), bridge))
    assert {(f.kind, f.cells) for f in verdict.findings} == {("odd", (5,)), ("odd", (20,))}
    assert "A bridge to another cell" in verdict.findings[0].text


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    ("kind", "change", "words"),
    [
        ("exposure", lambda light: np.minimum(4.0 * light, 255.0), "too large"),
        ("exposure", lambda light: 0.3 * light, "too small"),
        ("leak", lambda light: 255.0 - light, "steps 1 and 2 were exchanged"),
    ],
)
def test_light_that_is_wrong_everywhere_is_one_finding(
    bench: Bench, judge: Judge, kind: str, change: Callable[[np.ndarray], np.ndarray], words: str
) -> None:
    def everywhere(frames: np.ndarray) -> None:
        frames[:] = change(frames)

    verdict = judge(damaged(bench.frames(), everywhere))
    [text] = [finding.text for finding in verdict.findings if finding.kind == kind]
    assert words in text


def test_flicker_in_a_steady_step_is_noise(bench: Bench, judge: Judge) -> None:
    frames = bench.frames()
    flicker = np.where(np.arange(len(frames.empty)) % 2, 20.0, -20.0)[:, None].astype(np.float32)
    verdict = judge(replace(frames, empty=frames.empty - 20.0 + flicker))
    assert set(kinds(verdict)) == {"noisy"}


@pytest.mark.slow
def test_a_gauge_put_in_the_wrong_way_round_is_unexplained(bench: Bench, judge: Judge) -> None:
    frames = bench.frames()
    verdict = judge(replace(frames, gauge=(*frames.gauge[2:], *frames.gauge[:2])))
    assert "unexplained" in kinds(verdict)
    assert "right way round" in verdict.findings[-1].text


def test_a_sheet_that_does_not_move_is_not_accepted(bench: Bench, judge: Judge) -> None:
    frames = bench.frames()
    verdict = judge(replace(frames, moving=np.concatenate([frames.empty] * 3)))
    assert not verdict.accepted
    assert verdict.unseen is not None
    assert "the sheet moved over 0% of the cells" in verdict.unseen
    assert judge.unseen(frames.empty, frames.sheet, frames.moving[:15]) is not None
    assert judge.unseen(frames.empty, frames.sheet, frames.moving) is None


def test_the_sheet_need_not_be_seen_by_dead_cells(bench: Bench, judge: Judge) -> None:
    frames = bench.frames()
    dead = list(range(0, 32, 4))
    empty, sheet, moving = (light.copy() for light in (frames.empty, frames.sheet, frames.moving))
    for light in (empty, sheet, moving):
        light[:, dead] = 0.0
    assert judge.unseen(empty, sheet, moving) is None
    verdict = judge(replace(frames, empty=empty, sheet=sheet, moving=moving))
    assert not verdict.accepted
    assert {cell for finding in verdict.findings for cell in finding.cells} >= set(dead)


def test_another_design_is_refused(gauge: Gauge) -> None:
    with pytest.raises(GaugeError, match="the gauge is of design 0000"):
        Judge(published_layout(), replace(gauge, design_hash="0" * 64))


def test_frames_of_other_cells_or_placements_are_refused(bench: Bench, judge: Judge) -> None:
    frames = bench.frames()
    with pytest.raises(ArgumentError, match="frames of 3 placements; the gauge has 4"):
        judge(replace(frames, gauge=frames.gauge[:3]))
    with pytest.raises(ArgumentError, match=r"sheet has shape \(40, 31\); \(2 or more, 32\)"):
        judge(replace(frames, sheet=frames.sheet[:, :31]))
    frames.moving[3, 4] = np.nan
    with pytest.raises(ArgumentError, match="moving has values that are not finite"):
        judge(frames)


def test_few_cells_are_refused_at_once(gauge: Gauge, make_layout: Callable[..., Layout]) -> None:
    layout = make_layout((2, 3))
    with pytest.raises(GaugeError, match="the fingertip has 5 cells; 8 are needed"):
        Judge(layout, replace(gauge, design_hash=layout.design_hash))
