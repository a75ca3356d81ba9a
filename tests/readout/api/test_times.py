"""Times of frames: in order, and at the distance of the device clock."""

import re
import time
from pathlib import Path

import numpy as np
import pytest

from lumitip import Fingertip, Layout, LinkEvent
from lumitip.errors import NotConnected
from lumitip.recording import Reader, Writer
from lumitip.session.arrivals import ArrivalTime
from lumitip.session.timing import DeviceClock, SteadyTime


def test_frames_keep_their_distance_when_a_stall_begins_the_link(open_feed) -> None:
    tip, feed = open_feed()
    base = time.monotonic()
    arrivals = [2.0 + 0.001 * n for n in range(50)] + [2.1 + 0.04 * n for n in range(250)]
    frames = []
    for n, arrival in enumerate(arrivals):
        feed.packet(4 * n, 4, t_host=base + arrival)
        frames.append(tip.latest())
    steps_s = np.diff([f.t for f in frames])
    assert steps_s.min() >= 0.25 * 0.04 - 1e-9
    assert steps_s[-1] == pytest.approx(0.04, abs=1e-6), "it has caught up"
    assert frames[-1].t <= frames[-1].t_host
    assert np.diff([f.t_wall for f in frames]).min() > 0.0


@pytest.mark.parametrize("set_by_s", [17_280_000.0, -3600.0, 0.9, -0.08])
def test_the_wall_time_follows_the_computers_clock_where_it_is_set(
    open_feed, layout: Layout, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, set_by_s: float
) -> None:
    events: list[LinkEvent] = []
    tip, feed = open_feed(on_event=events.append)
    wall, frames = time.time, []
    with Writer(tmp_path / "across.mcap", layout, device_id="feed") as writer:
        for number in range(20):
            if number == 10:
                monkeypatch.setattr(time, "time", lambda: wall() + set_by_s)
            feed.packet(number)
            frames.append(tip.latest())
            writer.write(frames[-1])
    offsets_s = np.array([frame.t_wall - frame.t for frame in frames])
    assert offsets_s[:10] == pytest.approx(offsets_s[0], abs=1e-6)
    assert offsets_s[10:] == pytest.approx(offsets_s[0] + set_by_s, abs=0.011)
    assert [e.kind for e in events] == ["connected", "clock"]
    (by_s,) = re.findall(r"set by ([+-][\d.]+) s", events[-1].detail)
    assert float(by_s) == pytest.approx(set_by_s, abs=0.011)
    # Within a recording times go on; one that is begun later has the new clock.
    across = [frame.t_wall for frame in Reader(tmp_path / "across.mcap")]
    np.testing.assert_allclose(np.diff(across), np.diff([f.t for f in frames]), atol=1e-4)
    with Writer(tmp_path / "later.mcap", layout, device_id="feed") as writer:
        writer.write(frames[-1])
    later = Reader(tmp_path / "later.mcap")
    assert next(iter(later)).t_wall == pytest.approx(later.metadata.start_wall, abs=60.0)


def test_a_clock_that_is_trimmed_does_not_move_the_times(
    open_feed, monkeypatch: pytest.MonkeyPatch
) -> None:
    events: list[LinkEvent] = []
    tip, feed = open_feed(on_event=events.append)
    feed.packet(0)
    first, wall = tip.latest(), time.time
    monkeypatch.setattr(time, "time", lambda: wall() + 0.03)
    feed.packet(1)
    second = tip.latest()
    assert second.t_wall - second.t == first.t_wall - first.t
    assert [e.kind for e in events] == ["connected"]


def test_a_busy_computer_is_not_taken_for_a_clock_that_is_set(
    open_feed, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It may stall for long between the readings of both clocks."""
    events: list[LinkEvent] = []
    tip, feed = open_feed(on_event=events.append)
    wall = time.time

    def stalls() -> float:
        time.sleep(0.06)
        return wall()

    for number in range(6):
        monkeypatch.setattr(time, "time", stalls if number % 2 else wall)
        feed.packet(number)
    assert [e.kind for e in events] == ["connected"] and tip.stats.received == 6


@pytest.mark.parametrize("stall_s", [0.2, 1.0, 2.0, 5.0])
@pytest.mark.parametrize("period_s", [0.005, 0.04])
def test_times_after_a_stall_at_the_start_lead_little_and_not_long(
    stall_s: float, period_s: float
) -> None:
    clock, steady = DeviceClock(), SteadyTime()
    read_s = np.arange(0.0, 8.0, period_s)
    arrivals_s = np.maximum(read_s, stall_s) + 0.002
    times_s = []
    for read, arrival in zip(read_s.tolist(), arrivals_s.tolist(), strict=True):
        clock.add(read, arrival)
        times_s.append(steady.next(min(clock.host(read), arrival), read))
    lead_s = times_s - arrivals_s
    assert lead_s.max() < 0.25 * stall_s + 0.05
    assert arrivals_s[lead_s > 1e-6].max() - stall_s < stall_s / 3.0 + 0.3
    assert np.diff(times_s).min() >= 0.25 * period_s - 1e-9


@pytest.mark.slow
def test_a_link_that_stalls_and_then_bursts_keeps_the_times_of_its_frames(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from lumitip.links import twin

    real = twin.packet_at

    def stalls(layout, options, number, frames):
        if number == 100:
            time.sleep(1.0)
        return real(layout, options, number, frames)

    monkeypatch.setattr(twin, "packet_at", stalls)
    with Fingertip.open("twin://disc?rate=200&speed=0") as tip:
        block = tip.get_data(300, timeout=60.0)
    assert block.dropped == 0
    assert (np.diff(block.t) >= 0.8 * 0.005 - 1e-6).all()
    assert block.t[-1] - block.t[0] == pytest.approx(299 * 0.005, rel=0.25)


def test_legacy_frames_of_one_moment_have_times_in_order(
    open_feed, monkeypatch: pytest.MonkeyPatch
) -> None:
    tip, feed = open_feed()
    now, wall_s = time.monotonic(), time.time() - time.monotonic()
    monkeypatch.setattr(time, "monotonic", lambda: now)
    monkeypatch.setattr(time, "time", lambda: now + wall_s)
    frames = []
    for value in range(90):
        now += 0.06 if value % 3 == 0 else 0.0
        feed.legacy(value)
        frames.append(tip.latest())
    t, t_host = (np.array([getattr(f, name) for f in frames]) for name in ("t", "t_host"))
    assert np.diff(t).min() > 0.0
    assert np.diff([f.t_wall for f in frames]).min() > 0.0
    assert np.diff(t[30:]) == pytest.approx(0.02, rel=0.02)
    assert (t <= t_host + 0.02 + 1e-9).all()
    assert t[-1] == pytest.approx(t_host[-1], abs=0.002)


def _legacy_times(arrivals_s: np.ndarray) -> np.ndarray:
    arrivals, steady = ArrivalTime(), SteadyTime()
    return np.array([steady.next(arrivals.next(at), None) for at in arrivals_s.tolist()])


@pytest.mark.parametrize("interval_s", [0.03, 0.05, 0.1])
@pytest.mark.parametrize("period_s", [0.01, 0.0182, 0.02])
def test_legacy_frames_of_any_connection_interval_are_spaced(
    period_s: float, interval_s: float
) -> None:
    noise_s = np.random.default_rng(1).exponential(0.0003, round(20.0 / period_s))
    read_s = np.arange(noise_s.size) * period_s
    arrivals_s = np.ceil(read_s / interval_s) * interval_s
    stalled = (read_s > 9.9) & (arrivals_s < 10.3)
    arrivals_s[stalled] = 10.3
    arrivals_s = np.maximum.accumulate(arrivals_s + noise_s)
    t = _legacy_times(arrivals_s)
    assert np.diff(t).min() > 0.0
    later = read_s > 5.0
    steps = np.diff(t[later]) / period_s
    assert steps.min() > 0.6
    assert steps.max() < 1.6
    assert (t - arrivals_s)[later].max() < 1.1 * period_s
    assert np.ptp((t - read_s)[later]) < 1.5 * period_s


def test_legacy_times_after_lost_frames_are_early_for_a_moment() -> None:
    arrivals_s = np.concatenate([np.arange(0.0, 10.0, 0.02), np.arange(12.0, 20.0, 0.02)])
    early_s = arrivals_s - _legacy_times(arrivals_s)
    assert early_s.max() < 0.5 + 1e-9
    assert np.abs(early_s[arrivals_s > 12.3]).max() < 0.02


def test_legacy_times_begin_anew_with_a_connection(open_feed, monkeypatch) -> None:
    tip, feed = open_feed()
    now = time.monotonic()
    monkeypatch.setattr(time, "monotonic", lambda: now)
    for value in range(20):
        now += 0.02
        feed.legacy(value)
    feed.report(LinkEvent("lost", "lost", NotConnected("lost")))
    now += 5.0
    feed.report(LinkEvent("connected", "connected"))
    feed.legacy(20)
    assert tip.latest().t == now


def test_times_increase_over_a_restart(open_feed) -> None:
    tip, feed = open_feed()
    base = time.monotonic()
    feed.packet(1000, 4, t_host=base)
    before = tip.latest()
    feed.packet(0, 4, time_us=100_000, t_host=base + 0.001)
    assert tip.stats.restarts == 1
    assert tip.latest().t > before.t
