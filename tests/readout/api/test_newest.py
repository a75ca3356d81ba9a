"""`wait_latest` and `latest`: the newest frame, without a queue; and how late a reader is."""

import asyncio
import logging
import re
import threading
import time

import numpy as np
import pytest

from lumitip import AsyncFingertip, Fingertip, LinkEvent
from lumitip.errors import ArgumentError, EndOfRecording, FingertipClosed, LinkTimeout, StaleFrame
from lumitip.recording import Writer
from lumitip.session.queues import FrameQueue


def test_each_call_waits_for_a_newer_frame_of_the_twin() -> None:
    with Fingertip.open("twin://disc?rate=200") as tip:
        seqs = [tip.wait_latest(10.0).seq for _ in range(20)]
        assert (np.diff(seqs) > 0).all()
        assert tip._hub._queues == (), "nothing queues"


def test_a_slow_loop_gets_the_newest_and_nothing_counts_as_lost() -> None:
    with Fingertip.open("twin://disc?rate=500", buffer=1) as tip:
        first = tip.wait_latest(10.0)
        time.sleep(0.3)
        before = tip.latest()
        frame = tip.wait_latest(10.0)
        assert before is not None and frame.seq > before.seq > first.seq
        assert tip.stats.overflowed == 0


def test_no_frame_is_handed_out_twice_whatever_the_call(open_feed) -> None:
    tip, feed = open_feed()
    feed.packet(0)
    assert tip.latest().seq == 0
    with pytest.raises(LinkTimeout, match=r"no frame in 0\.02 s: feed is connected but sends"):
        tip.wait_latest(0.02)
    with pytest.raises(LinkTimeout):
        tip.read(0.0)
    feed.packet(1)
    assert tip.wait_latest(0.0).seq == 1
    feed.packet(2)
    feed.packet(3)
    assert tip.read(0.0).seq == 1, "reading goes on in order"
    assert tip.wait_latest(0.0).seq == 3
    assert [tip.read(0.0).seq for _ in range(2)] == [2, 3]
    with pytest.raises(LinkTimeout):
        tip.wait_latest(0.0)
    with pytest.raises(ArgumentError, match="timeout_s is -1"):
        tip.wait_latest(-1)


def test_threads_each_get_the_newest(open_feed) -> None:
    tip, feed = open_feed()
    got: dict[int, list[int]] = {0: [], 1: []}
    took = threading.Barrier(3, timeout=30.0)

    def run(number: int) -> None:
        for _ in range(5):
            got[number].append(tip.wait_latest(30.0).seq)
            took.wait()

    threads = [threading.Thread(target=run, args=(number,)) for number in got]
    for thread in threads:
        thread.start()
    for n in range(5):
        feed.packet(n)
        took.wait()
    for thread in threads:
        thread.join()
    assert got == {0: [0, 1, 2, 3, 4], 1: [0, 1, 2, 3, 4]}


def test_a_waiting_thread_wakes_when_the_fingertip_is_closed(open_feed) -> None:
    tip, _ = open_feed()
    ended: list[Exception] = []

    def wait() -> None:
        try:
            tip.wait_latest(None)
        except FingertipClosed as error:
            ended.append(error)

    waiting = threading.Thread(target=wait)
    waiting.start()
    time.sleep(0.05)
    tip.close()
    waiting.join(30.0)
    assert len(ended) == 1


def test_an_old_frame_is_an_error_where_its_age_is_limited(open_feed) -> None:
    tip, feed = open_feed()
    assert tip.latest() is None
    with pytest.raises(StaleFrame, match="no frame came yet, max_age_s is 5"):
        tip.latest(max_age_s=5.0)
    feed.packet(0, t_host=time.monotonic())
    assert tip.latest(max_age_s=30.0).seq == 0
    time.sleep(0.02)
    feed.report(LinkEvent("lost", "gone"))
    with pytest.raises(TimeoutError, match=r"frame is 0\.\d+ s old, max_age_s is 0\.01: .*is lost"):
        tip.latest(max_age_s=0.01)
    assert tip.latest().seq == 0
    with pytest.raises(ArgumentError, match="max_age_s is nan"):
        tip.latest(float("nan"))


def test_the_first_frame_of_a_thread_is_of_now(open_feed) -> None:
    tip, feed = open_feed()
    feed.packet(0, t_host=time.monotonic() - 5.0)
    with pytest.raises(LinkTimeout, match=r"no frame in 0\.02 s"):
        tip.wait_latest(0.02)
    feed.packet(500, t_host=time.monotonic())
    assert tip.wait_latest(0.0).raw[0] == 500 % 251, "it came since"
    got: list[object] = []

    def first(timeout_s: float | None) -> None:
        try:
            got.append(tip.wait_latest(timeout_s).raw[0])
        except LinkTimeout as error:
            got.append(str(error))

    def of_a_new_thread(timeout_s: float | None) -> object:
        thread = threading.Thread(target=first, args=(timeout_s,), daemon=True)
        thread.start()
        thread.join(60.0)
        assert not thread.is_alive()
        return got[-1]

    assert of_a_new_thread(30.0) == of_a_new_thread(None) == 500 % 251, "it is young enough"
    feed.report(LinkEvent("lost", "gone"))
    assert "the connection to feed is lost" in str(of_a_new_thread(0.02))
    waiting = threading.Thread(target=first, args=(None,), daemon=True)
    number, seq = len(got), 500
    waiting.start()
    while waiting.is_alive() and seq < 1500:  # the first ones may come before it waits
        seq += 1
        feed.packet(seq, t_host=time.monotonic())
        waiting.join(0.05)
    assert len(got) > number and got[-1] != 500 % 251, "it waits for a new one"


def test_a_frame_from_before_a_cut_is_not_one_of_now(open_feed) -> None:
    tip, feed = open_feed()
    feed.packet(0, t_host=time.monotonic() - 5.0)
    assert tip.latest().seq == 0
    feed.packet(1, t_host=time.monotonic() - 4.0)
    assert tip.wait_latest(0.02).seq == 1, "a slow loop over a link that is not cut"
    feed.packet(2, t_host=time.monotonic() - 3.0)
    feed.report(LinkEvent("lost", "gone"))
    with pytest.raises(LinkTimeout, match=r"no frame in 0\.02 s: the connection to feed is lost"):
        tip.wait_latest(0.02)
    feed.packet(3, t_host=time.monotonic() - 3.0)
    feed.report(LinkEvent("lost", "gone"))
    feed.report(LinkEvent("connected", "back"))
    with pytest.raises(LinkTimeout, match=r"no frame in 0\.02 s: feed is connected"):
        tip.wait_latest(0.02)
    feed.packet(4, t_host=time.monotonic())
    feed.report(LinkEvent("lost", "gone"))
    assert tip.wait_latest(30.0).seq == 4, "younger than the timeout"
    feed.packet(5, t_host=time.monotonic())
    feed.report(LinkEvent("lost", "gone"))
    assert tip._pass_over(None).seq == 5, "without a timeout nothing from before is young"


def test_the_first_frame_of_a_coroutine_is_of_now(
    open_feed, monkeypatch: pytest.MonkeyPatch
) -> None:
    tip, feed = open_feed()
    monkeypatch.setattr(Fingertip, "open", lambda *_, **__: tip)

    async def main() -> None:
        feed.packet(0, t_host=time.monotonic() - 5.0)
        async with AsyncFingertip.open("feed://") as opened:
            with pytest.raises(LinkTimeout, match=r"no frame in 0\.02 s"):
                await opened.wait_latest(0.02)
            feed.packet(500, t_host=time.monotonic())
            assert (await opened.wait_latest(30.0)).raw[0] == 500 % 251
            feed.packet(501, t_host=time.monotonic() - 3.0)
            feed.report(LinkEvent("lost", "gone"))
            with pytest.raises(LinkTimeout, match="the connection to feed is lost"):
                await opened.wait_latest(0.02)

    asyncio.run(main())


def test_a_recording_ages_from_its_arrival(tmp_path, layout) -> None:
    path = tmp_path / "run.mcap"
    with (
        Fingertip.open("twin://disc?rate=500", layout) as tip,
        Writer(path, layout, device_id=tip.device_id) as writer,
    ):
        for _ in range(5):
            writer.write(tip.read(10.0))
    with Fingertip.open(f"replay://{path}?speed=0") as tip:
        seqs = [tip.wait_latest(10.0).seq for _ in range(5)]
        assert np.diff(seqs).tolist() == [1] * 4, "a recording without pace waits for its reader"
        assert tip.latest(max_age_s=60.0).seq == seqs[-1]
        with pytest.raises(EndOfRecording):
            tip.wait_latest(10.0)


@pytest.mark.slow
def test_coroutines_wait_for_the_newest() -> None:
    async def main() -> None:
        async with AsyncFingertip.open("twin://disc?rate=200") as tip:
            seqs = [(await tip.wait_latest(10.0)).seq for _ in range(10)]
            assert (np.diff(seqs) > 0).all()
            await asyncio.sleep(0.1)
            latest = tip.latest(max_age_s=30.0)
            assert (await tip.wait_latest(10.0)).seq > latest.seq > seqs[-1]
            assert tip.fingertip.stats.overflowed == 0
        async with AsyncFingertip.open("twin://disc?rate=1") as tip:
            await tip.wait_latest(10.0)
            with pytest.raises(LinkTimeout, match=r"no frame in 0\.01 s"):
                await tip.wait_latest(0.01)

    asyncio.run(main())


def test_a_reader_that_falls_behind_is_warned(open_feed, caplog: pytest.LogCaptureFixture) -> None:
    tip, feed = open_feed()
    with pytest.raises(LinkTimeout):
        tip.read(0.0)
    for n in range(4):
        feed.packet(n)
    time.sleep(0.6)
    with caplog.at_level(logging.WARNING):
        assert [tip.read(0.0).seq for _ in range(4)] == [0, 1, 2, 3]
    (record,) = caplog.records
    assert record.getMessage().startswith("feed: this reader is 0.")
    assert "3 frames wait in its queue. Use wait_latest() if only the newest" in record.getMessage()


def test_a_reader_is_warned_at_each_doubling_and_anew_once_it_has_caught_up(
    open_feed, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    tip, feed = open_feed()
    feed.packet(0)
    frame = tip.latest()
    now_s = 0.0
    monkeypatch.setattr("lumitip.session.queues.time.monotonic", lambda: now_s)

    def warned(delays_s: list[float], counted: bool = True, wait: bool = False) -> list[str]:
        nonlocal now_s
        caplog.clear()
        queue = FrameQueue(10, counted=counted)
        for delay_s in delays_s:
            queue.put([frame], wait)
            now_s += delay_s
            assert queue.get(0.0) is frame
        return re.findall(r"is (\d\.\d) s behind", caplog.text)

    slower = [0.125 * n for n in range(48)]
    with caplog.at_level(logging.WARNING):
        assert warned(slower) == ["0.6", "1.4", "2.9", "5.9"]
        assert warned([0.6, 0.4, 0.6]) == ["0.6"], "it has not caught up"
        assert warned([3.0, 0.05, 0.6, 1.3]) == ["3.0", "0.6", "1.3"]
        assert warned(slower, counted=False) == warned(slower, wait=True) == []


def test_a_reader_that_waits_for_a_link_is_not_warned(
    open_feed, caplog: pytest.LogCaptureFixture
) -> None:
    tip, feed = open_feed()
    with pytest.raises(LinkTimeout):
        tip.read(0.6)
    feed.packet(0, 50, t_host=time.monotonic())
    assert tip.read(0.0).seq == 0
    assert not caplog.records
