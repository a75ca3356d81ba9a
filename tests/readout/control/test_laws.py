"""Laws, limits, and what a tracer does without a line and at a corner."""

import math
from dataclasses import replace

import numpy as np
import pytest

from lumitip.control import CentreLaw, ControlError, Limits, LineLaw, Sight, Tracer, sight_of
from lumitip.control.tracer import Lead
from lumitip.estimation import Estimate, PoseEstimator
from lumitip.links.twin import published_layout
from lumitip.processing import Processor
from lumitip.twin import Cable, Corner, HalfPlane, Twin

DT_S = 1.0 / 55.0


def _edge(offset_mm: float, angle_deg: float, **changes: object) -> Estimate:
    told = Estimate("edge", offset_mm, angle_deg, math.nan, 0.0, 1.0, np.eye(4) * 1e-4, 0.99)
    return replace(told, **changes)  # type: ignore[arg-type]


NOTHING = _edge(0.0, 0.0, kind="none")


def test_the_line_law_is_height_and_angle() -> None:
    law = LineLaw(speed_mm_s=100.0, gain_per_s=5.0, turn_per_s=7.0, target_mm=1.0)
    command = law(Sight(height_mm=3.0, angle=0.2))
    assert command is not None
    assert command.forward_mm_s == pytest.approx(100.0 * math.cos(0.2))
    assert command.lateral_mm_s == pytest.approx(5.0 * 2.0 + 100.0 * math.sin(0.2))
    assert command.rotation_rad_s == pytest.approx(1.4)
    assert math.hypot(100.0 * math.cos(0.2), 100.0 * math.sin(0.2)) == pytest.approx(100.0)
    assert law(Sight(centre_mm=1.0)) is None


def test_the_published_law_holds_the_dark_centre() -> None:
    law = CentreLaw(speed_mm_s=30.0, gain_per_s=4.0, target_mm=5.0)
    command = law(Sight(centre_mm=3.5, height_mm=2.0, angle=0.5))
    assert command is not None
    assert (command.forward_mm_s, command.lateral_mm_s, command.rotation_rad_s) == (30, -6, 0)
    assert law(Sight(height_mm=2.0)) is None


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    "scene", [HalfPlane(offset_mm=-2.0, angle_deg=160.0), Cable(offset_mm=2.0, angle_deg=-20.0)]
)
def test_both_ways_of_seeing_agree(scene: HalfPlane | Cable) -> None:
    layout = published_layout()
    values = Twin(layout).values(scene)
    expected_mm = 2.0 / math.cos(math.radians(20.0))
    # The published method has a bias of some degrees on cables.
    for seen, most_deg in ((Processor(layout)(values), 6.0), (PoseEstimator(layout)(values), 0.5)):
        sight = sight_of(seen)
        assert sight.height_mm == pytest.approx(expected_mm, abs=most_deg / 10.0)
        assert math.degrees(sight.angle) == pytest.approx(-20.0, abs=most_deg)


@pytest.mark.slow
def test_a_corner_is_seen_ahead_and_a_flat_one_is_none() -> None:
    layout = published_layout()
    values = Twin(layout).values(Corner(x_mm=4.0, y_mm=-1.0, angle_deg=135.0))
    for seen in (Processor(layout)(values), PoseEstimator(layout)(values)):
        assert sight_of(seen).corner_mm == pytest.approx(4.0, abs=1.5)
    corner = PoseEstimator(layout)(values)
    assert sight_of(replace(corner, opening_deg=140.0)).corner_mm is None


def test_an_estimate_that_distrusts_itself_shows_no_line() -> None:
    assert sight_of(_edge(1.0, 5.0, flags=("astray",))).height_mm is None
    assert sight_of(_edge(1.0, 5.0, flags=("weak",))).height_mm is None
    assert sight_of(_edge(1.0, 5.0, flags=("misfit",))).height_mm is not None  # curved
    assert sight_of(_edge(1.0, 85.0)).height_mm is None
    # As the published bent cable, and as the edge of a sheet that is fitted as a cable.
    assert sight_of(_edge(1.0, 5.0, flags=("misfit",), rms_counts=29.0)).height_mm is not None
    assert sight_of(_edge(1.0, 5.0, flags=("misfit",), rms_counts=151.0)).height_mm is None


@pytest.mark.parametrize("every", [10, 40])
def test_single_frames_with_a_line_do_not_keep_a_trace_alive(every: int) -> None:
    tracer = Tracer(LineLaw(80.0))
    tracer(_edge(0.0, 0.0), DT_S)
    frames = [tracer(NOTHING if n % every else _edge(0.0, 0.0), DT_S) for n in range(1, 110)]
    assert frames[-1].reason == "lost"


def test_a_corner_behind_the_finger_is_left_behind() -> None:
    tracer = Tracer(LineLaw(80.0), corner_at_mm=0.0, corner_frames=1)
    behind = _edge(0.0, 0.0, kind="corner", vertex_mm=(-5.0, 0.0), opening_deg=90.0)
    assert tracer(behind, DT_S).state != "stop"
    for ahead_mm in (8.0, 4.0):
        ahead = replace(behind, vertex_mm=(ahead_mm, 0.0))
        assert tracer(ahead, DT_S).state != "stop"
    assert tracer(behind, DT_S).reason == "corner"


def test_commands_stay_within_the_limits() -> None:
    limits = Limits(forward_mm_s=50.0, lateral_mm_s=10.0, rotation_rad_s=0.5)
    command = Tracer(LineLaw(200.0), limits)(_edge(8.0, 30.0), DT_S)
    assert (command.forward_mm_s, command.lateral_mm_s, command.rotation_rad_s) == (50, 10, 0.5)
    with pytest.raises(ControlError, match="above 0"):
        Limits(lateral_mm_s=0.0)
    with pytest.raises(ControlError, match="corner_frames is 0;"):
        Tracer(LineLaw(), corner_frames=0)


def test_without_a_line_it_slows_searches_both_sides_and_stops() -> None:
    tracer = Tracer(LineLaw(80.0), slow_s=0.1, search_s=0.6)
    before = tracer(_edge(1.0, 0.0), DT_S)
    commands = [tracer(NOTHING, DT_S) for _ in range(60)]
    states = [c.state for c in commands]
    assert states == sorted(states, key=["slow", "search", "stop"].index)
    slow = [c.forward_mm_s for c in commands if c.state == "slow"]
    assert before.forward_mm_s > slow[0] > slow[-1] >= 0.0 and slow == sorted(slow, reverse=True)
    search = [c.lateral_mm_s for c in commands if c.state == "search"]
    assert search[0] > 0.0 > search[-1]  # the line was above
    assert commands[-1].reason == "lost" and commands[-1].forward_mm_s == 0.0
    assert tracer(_edge(0.0, 0.0), DT_S).state == "stop"
    tracer.reset()
    assert tracer(_edge(0.0, 0.0), DT_S).state == "trace"


def test_a_line_that_comes_back_is_followed_on() -> None:
    tracer = Tracer(LineLaw(80.0))
    tracer(_edge(1.0, 0.0), DT_S)
    assert tracer(NOTHING, DT_S).state == "slow"
    assert tracer(_edge(1.0, 0.0), DT_S) == Tracer(LineLaw(80.0))(_edge(1.0, 0.0), DT_S)


def test_it_stops_at_a_corner_and_not_at_a_single_frame_of_one() -> None:
    def corner(ahead_mm: float) -> Estimate:
        return _edge(0.0, 0.0, kind="corner", vertex_mm=(ahead_mm, 0.0), opening_deg=90.0)

    tracer = Tracer(LineLaw(80.0), corner_at_mm=1.0, corner_frames=3)
    assert tracer(corner(0.5), DT_S).state == "trace"
    assert tracer(_edge(0.0, 0.0), DT_S).forward_mm_s == pytest.approx(80.0)
    speeds = [tracer(corner(c), DT_S).forward_mm_s for c in (11.0, 10.0, 9.0, 5.0, 2.0)]
    assert speeds[:2] == pytest.approx([80.0, 80.0]) and speeds[2:] == sorted(speeds[2:])[::-1]
    assert speeds[-1] < 10.0
    stopped = tracer(corner(1.2), DT_S)
    assert (stopped.state, stopped.reason, stopped.forward_mm_s) == ("stop", "corner", 0.0)
    assert Tracer(LineLaw(80.0))(corner(0.0), DT_S).state == "trace"  # not asked to stop


def test_a_lead_tells_the_angle_ahead_once_the_line_turns() -> None:
    lead = Lead(0.05)
    turning = [lead(Sight(height_mm=0.0, angle=0.02 * frame), DT_S).angle for frame in range(30)]
    assert turning[0] == 0.0  # one frame shows no turning
    rate = 0.02 / DT_S
    assert turning[-1] - 0.02 * 29 == pytest.approx(0.05 * rate, rel=0.01)
    assert 0.0 < turning[1] - 0.02 < 0.05 * rate  # smoothed


def test_a_lead_begins_anew_without_a_line_and_is_none_at_zero() -> None:
    lead = Lead(0.05)
    for angle in (0.0, 0.3):
        lead(Sight(height_mm=0.0, angle=angle), DT_S)
    assert lead(Sight(centre_mm=1.0), DT_S) == Sight(centre_mm=1.0)
    assert lead(Sight(height_mm=0.0, angle=0.3), DT_S).angle == 0.3
    assert lead(Sight(height_mm=0.0, angle=0.4), 0.0).angle == 0.4  # no time, no turning
    assert abs(lead(Sight(height_mm=0.0, angle=-1.3), DT_S).angle) < math.radians(80.0)
    none = Lead(0.0)
    assert [none(Sight(height_mm=0.0, angle=a), DT_S).angle for a in (0.0, 1.3)] == [0.0, 1.3]


def test_a_tracer_turns_earlier_with_a_lead() -> None:
    plain, ahead = Tracer(LineLaw(80.0)), Tracer(LineLaw(80.0), lead_s=0.05)
    for angle_deg in (0.0, 2.0, 4.0):
        commands = [t(_edge(0.0, angle_deg), DT_S) for t in (plain, ahead)]
    assert commands[1].rotation_rad_s > commands[0].rotation_rad_s > 0.0
    ahead.reset()
    assert ahead(_edge(0.0, 4.0), DT_S) == plain.law(sight_of(_edge(0.0, 4.0)))
    with pytest.raises(ControlError, match=r"lead_s is -0\.1"):
        Tracer(LineLaw(), lead_s=-0.1)
