"""Sequence and time of packets: wraps, repeats, gaps and new runs of the firmware."""

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumitip.protocol.packet import Packet
from lumitip.session.timing import Place, Timeline

PERIOD_US = 2000
VALUES = np.zeros((4, 3), np.uint8)


def _packet(sequence: int, time_us: int | None = None, frames: int = 4) -> Packet:
    at = sequence * PERIOD_US if time_us is None else time_us
    return Packet(1, sequence % 2**16, 8, at % 2**32, PERIOD_US, VALUES[:1].repeat(frames, 0))


def _place(packets: Sequence[tuple[float, Packet]]) -> list[Place]:
    timeline = Timeline()
    return [timeline.place(packet, t_host) for t_host, packet in packets]


def test_packets_follow_each_other() -> None:
    places = _place([(0.0, _packet(100)), (0.008, _packet(104)), (0.016, _packet(108))])
    assert [(p.seq, p.repeated, p.lost, p.restarted) for p in places] == [
        (0, 0, 0, False),
        (4, 0, 0, False),
        (8, 0, 0, False),
    ]
    assert [p.time_us for p in places] == [200_000, 208_000, 216_000]


def test_number_and_time_wrap() -> None:
    first = 2**16 * 40 - 4
    near_wrap = 2**32 - 5000
    places = _place(
        [
            (0.0, _packet(first, near_wrap)),
            (0.008, _packet(first + 4, near_wrap + 8000)),
            (0.016, _packet(first + 8, near_wrap + 16000)),
        ]
    )
    assert [p.seq for p in places] == [0, 4, 8]
    assert places[2].time_us - places[0].time_us == 16000
    assert not any(p.restarted or p.lost or p.repeated for p in places)


def test_what_is_missing_is_counted() -> None:
    places = _place([(0.0, _packet(0)), (0.05, _packet(24))])
    assert (places[1].seq, places[1].lost) == (24, 20)


def test_a_link_cut_for_minutes_counts_beyond_the_wrap_of_the_number() -> None:
    away = 400_000  # 800 s: the number wrapped six times
    places = _place([(0.0, _packet(0)), (800.0, _packet(4 + away))])
    assert places[1].lost == away


def test_a_link_cut_for_hours_counts_beyond_the_wrap_of_the_time() -> None:
    away = 5_400_000  # 3 h: the time wrapped twice
    places = _place([(0.0, _packet(0)), (10_800.0, _packet(4 + away))])
    assert places[1].lost == away


def test_a_packet_that_comes_again_is_left_out() -> None:
    places = _place(
        [
            (0.0, _packet(0)),
            (0.008, _packet(4)),
            (0.009, _packet(4)),
            (0.010, _packet(0)),
            (0.016, _packet(8)),
        ]
    )
    assert [p.repeated for p in places] == [0, 0, 4, 4, 0]
    assert (places[4].seq, places[4].lost) == (8, 0)


def test_a_late_packet_is_left_out_and_stays_counted_as_lost() -> None:
    places = _place(
        [(0.0, _packet(0)), (0.016, _packet(8)), (0.017, _packet(4)), (0.024, _packet(12))]
    )
    assert [p.lost for p in places] == [0, 4, 0, 0]
    assert [p.repeated for p in places] == [0, 0, 4, 0]
    assert places[3].seq == 12


def test_only_the_new_part_of_an_overlapping_packet_counts() -> None:
    places = _place([(0.0, _packet(0)), (0.01, _packet(2))])
    assert (places[1].seq, places[1].repeated, places[1].lost) == (4, 2, 0)
    assert places[1].time_us == 8000


@pytest.mark.parametrize("ran_s", [3.0, 40.0, 131.072, 1800.0, 4200.0])
def test_a_restart_goes_on_counting(ran_s: float) -> None:
    ran = int(ran_s * 1e6 / PERIOD_US)
    places = _place(
        [
            (ran_s, _packet(ran)),
            (ran_s + 2.0, _packet(0, 900_000)),
            (ran_s + 2.008, _packet(4, 908_000)),
        ]
    )
    assert places[1].restarted
    assert (places[1].seq, places[1].lost, places[1].time_us) == (4, None, 900_000)
    assert (places[2].seq, places[2].lost, places[2].restarted) == (8, 0, False)


def test_a_restart_soon_after_the_start_is_seen_once_the_link_was_cut() -> None:
    timeline = Timeline()
    timeline.place(_packet(400, 800_000), 10.0)
    timeline.reconnected()
    place = timeline.place(_packet(0, 500_000), 12.0)
    assert place.restarted
    assert place.lost is None


def _place_after_outage(before_s: float, away_s: float, now_s: float) -> Place:
    """Place of the first packet after an outage, by the uptimes of the device around it."""
    timeline = Timeline()
    timeline.place(_packet(int(before_s * 1e6 / PERIOD_US)), 1000.0)
    timeline.reconnected()
    return timeline.place(_packet(int(now_s * 1e6 / PERIOD_US)), 1000.0 + away_s)


@pytest.mark.parametrize(
    ("before_s", "away_s", "now_s"),
    [(60.0, 605.0, 65.0), (2.0, 6.0, 5.0), (1.0, 10_800.0, 2000.0)],
)
def test_a_restart_within_an_outage_is_noticed_once_it_runs_longer_than_before(
    before_s: float, away_s: float, now_s: float
) -> None:
    place = _place_after_outage(before_s, away_s, now_s)
    assert (place.restarted, place.lost, place.seq) == (True, None, 4)
    assert place.time_us == int(now_s * 1e6)


@pytest.mark.parametrize("away_s", [0.5, 1.9, 6.0, 600.0, 4400.0, 10_800.0])
@pytest.mark.parametrize("skew", [-0.009, 0.0])
def test_an_outage_with_skew_and_a_late_first_packet_is_no_restart(
    away_s: float, skew: float
) -> None:
    late_s = min(1.8, away_s / 2)
    ran_s = away_s * (1.0 + skew) - late_s
    place = _place_after_outage(60.0, away_s, 60.0 + ran_s)
    assert not place.restarted
    assert place.lost == int((60.0 + ran_s) * 1e6 / PERIOD_US) - 30_000 - 4


def test_a_stall_before_an_outage_is_no_restart() -> None:
    timeline = Timeline()
    timeline.place(_packet(0), 9.0)  # read 9 s before it arrives
    timeline.reconnected()
    assert timeline.place(_packet(6000), 12.0).lost == 5996


def test_a_link_that_stalls_for_seconds_is_no_restart() -> None:
    packets = [(3.0, _packet(n)) for n in range(0, 1500, 4)]
    places = _place([*packets, (3.004, _packet(1500))])
    assert not any(p.restarted or p.lost or p.repeated for p in places)


@given(
    st.lists(st.sampled_from(["ok", "lost", "twice", "late"]), min_size=1, max_size=60),
    st.integers(0, 2**18),
)
def test_every_frame_is_given_once_or_counted(fates: list[str], first: int) -> None:
    timeline = Timeline()
    given, lost, seen = 0, 0, []
    sent = [(n, _packet(first + 4 * n)) for n, _ in enumerate(fates)]
    order = [(n, p) for n, p in sent for _ in range({"lost": 0, "twice": 2}.get(fates[n], 1))]
    order.sort(key=lambda item: item[0] + (1.5 if fates[item[0]] == "late" else 0))
    for n, packet in order:
        place = timeline.place(packet, 100.0 + n * 0.008)
        assert not place.restarted
        new = packet.frames - place.repeated
        if new:
            lost += place.lost or 0
            assert place.seq == given + lost
            given += new
            seen.append(n)
    assert seen == sorted(set(seen))
    if seen:
        assert given + lost == 4 * (max(seen) - seen[0] + 1)
