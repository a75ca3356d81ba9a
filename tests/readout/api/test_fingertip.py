"""`Fingertip`: reading in every way, counting what is lost, and saying why nothing comes."""

import threading
import time

import numpy as np
import pytest

from lumitip import Block, Frame, LinkEvent
from lumitip.errors import EndOfRecording, FingertipClosed, LinkTimeout, NotConnected, WrongDesign


def test_read_gives_frames_in_order(open_feed) -> None:
    tip, feed = open_feed()
    got: list[Frame] = []
    reader = threading.Thread(target=lambda: got.extend(tip.read(2.0) for _ in range(6)))
    reader.start()
    _until(lambda: tip._queue is not None)
    feed.packet(0, 2)
    feed.packet(2, 4)
    reader.join()
    assert [f.seq for f in got] == list(range(6))
    assert [int(f.raw[0]) for f in got] == list(range(6))
    assert [f.dropped_before for f in got] == [0] * 6
    assert np.diff([f.t for f in got]) == pytest.approx(np.full(5, 0.01), abs=1e-9)
    assert got[3].t_device == pytest.approx(0.03)


def test_values_are_the_complement_whatever_the_bits(open_feed) -> None:
    tip, feed = open_feed()
    for n, (bits, code, value) in enumerate(
        [(8, 0, 255.0), (8, 55, 200.0), (10, 1023, 0.0), (12, 4095, 0.0), (12, 819, 204.0)]
    ):
        feed.packet(n, bits=bits, value=code)
        frame = tip.latest()
        assert frame.bits == bits
        assert frame.values.dtype == np.float32
        assert frame.values == pytest.approx(np.full(32, value), abs=1e-4)
        assert frame.raw.dtype == (np.uint8 if bits == 8 else np.uint16)


@pytest.mark.parametrize(
    "send",
    [
        lambda feed: feed.packet(0),
        lambda feed: feed.packet(0, bits=12),
        lambda feed: feed.legacy(3),
    ],
)
def test_frames_cannot_be_changed(open_feed, send) -> None:
    tip, feed = open_feed()
    send(feed)
    frame = tip.latest()
    with pytest.raises(AttributeError):
        frame.seq = 7
    for array in (frame.raw, frame.values):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
        below = array
        while isinstance(below, np.ndarray):
            with pytest.raises(ValueError, match="WRITEABLE"):
                below.flags.writeable = True
            below = below.base


def test_latest_is_none_before_the_first_frame_and_then_the_freshest(open_feed) -> None:
    tip, feed = open_feed()
    assert tip.latest() is None
    feed.packet(0, 3)
    assert tip.latest().seq == 2
    assert tip.latest() is tip.latest()


def test_a_timeout_is_by_the_clock_and_says_why(open_feed) -> None:
    tip, feed = open_feed()
    began = time.monotonic()
    with pytest.raises(LinkTimeout, match=r"no frame in 0\.05 s: feed is connected but sends"):
        tip.read(0.05)
    assert time.monotonic() - began >= 0.05
    feed.fault("crc")
    with pytest.raises(LinkTimeout, match=r"1 packets could not be decoded.*a crc fault"):
        tip.read(0.01)
    feed.report(LinkEvent("lost", "gone"))
    with pytest.raises(TimeoutError, match="is lost; reconnecting"):
        tip.read(0.01)
    assert not tip.connected


def test_get_data_gives_values_with_their_times(open_feed) -> None:
    tip, feed = open_feed()
    with pytest.raises(LinkTimeout):
        tip.read(0.0)
    feed.packet(0, 10)
    feed.packet(12, 10)
    block = tip.get_data(15, timeout=1.0)
    assert isinstance(block, Block)
    assert block.values.shape == block.raw.shape == (15, 32)
    assert block.values.dtype == np.float32
    assert block.seq.tolist() == [*range(10), *range(12, 17)]
    assert block.dropped == 2
    assert block.t == pytest.approx(block.t[0] + block.seq * 0.01, abs=1e-6)
    assert block.t_wall == pytest.approx(time.time(), abs=5.0)
    with pytest.raises(LinkTimeout, match=r"5 of 8 frames came"):
        tip.get_data(8, timeout=0.02)
    with pytest.raises(ValueError, match="num_samples is 0"):
        tip.get_data(0)


def test_losses_are_told_by_cause(open_feed) -> None:
    tip, feed = open_feed()
    feed.packet(0)
    feed.packet(4)
    assert tip.latest().dropped_before == 3
    feed.fault("crc")
    feed.packet(6)
    feed.fault("length")
    feed.packet(9)
    feed.packet(9)
    assert tip.stats.dropped == {"link": 3, "crc": 1, "length": 2, "queue": 0}
    assert tip.stats.received == 4
    assert tip.stats.repeated == 1
    assert tip.stats.unreadable == 2
    feed.fault("crc")
    feed.packet(10)
    assert tip.stats.dropped["crc"] == 1, "noise that no frame was lost in"


def test_a_slow_reader_loses_the_oldest_and_it_is_counted(open_feed) -> None:
    tip, feed = open_feed(buffer=10)
    with pytest.raises(LinkTimeout):
        tip.read(0.0)
    feed.packet(0, 25)
    assert tip.stats.dropped["queue"] == tip.stats.overflowed == 15
    assert [tip.read(0).seq for _ in range(10)] == list(range(15, 25))


def test_nobody_reading_is_no_loss(open_feed) -> None:
    tip, feed = open_feed(buffer=10)
    feed.packet(0, 200)
    assert tip.stats.dropped["queue"] == 0
    assert tip.stats.received == 200


def test_a_legacy_device_cannot_tell_what_is_lost(open_feed) -> None:
    tip, feed = open_feed()
    feed.legacy(10)
    feed.legacy(20)
    frame = tip.latest()
    assert (frame.seq, frame.t_device, frame.dropped_before) == (1, None, None)
    assert frame.t == frame.t_host
    assert frame.values[0] == 235.0
    assert tip.stats.dropped is None
    assert tip.stats.overflowed == 0
    assert tip.stats.jitter_ms is None


def test_every_way_of_reading_gets_every_frame(open_feed) -> None:
    tip, feed = open_feed()
    called: list[int] = []
    looped: list[int] = []
    stop = tip.subscribe(lambda frame: called.append(frame.seq))
    loop = threading.Thread(target=lambda: looped.extend(f.seq for f in tip.frames()))
    loop.start()
    _until(lambda: len(tip._hub._queues) == 2)
    with pytest.raises(LinkTimeout):
        tip.read(0.0)
    for n in range(30):
        feed.packet(n)
    assert [tip.read(0).seq for n in range(30)] == list(range(30))
    _until(lambda: len(called) == len(looped) == 30)
    assert called == looped == list(range(30))
    stop()
    _until(lambda: len(tip._hub._queues) == 2)
    feed.packet(30)
    tip.close()
    loop.join()
    assert len(called) == 30
    assert len(looped) == 31


def test_a_subscriber_that_fails_ends_alone(open_feed, caplog: pytest.LogCaptureFixture) -> None:
    tip, feed = open_feed()
    seen: list[int] = []

    def fails(frame: Frame) -> None:
        seen.append(frame.seq)
        raise RuntimeError("mine")

    tip.subscribe(fails)
    feed.packet(0)
    _until(lambda: not tip._hub._queues)
    feed.packet(1)
    assert seen == [0]
    assert "it will not be called again" in caplog.text
    assert tip.latest().seq == 1


def test_closing_ends_loops_and_wakes_readers(open_feed) -> None:
    tip, feed = open_feed()
    ended: list[object] = []

    def read() -> None:
        try:
            tip.read(None)
        except NotConnected as error:
            ended.append(error)

    reader = threading.Thread(target=read)
    reader.start()
    _until(lambda: tip._queue is not None)
    tip.close()
    reader.join()
    assert isinstance(ended[0], FingertipClosed)
    assert feed.stopped
    assert list(tip.frames()) == []
    with pytest.raises(FingertipClosed, match="open it again"):
        tip.latest()
    tip.close()


def test_what_is_queued_is_read_before_the_end_is_told(open_feed) -> None:
    tip, feed = open_feed()
    with pytest.raises(LinkTimeout):
        tip.read(0.0)
    feed.packet(0, 2)
    feed.report(LinkEvent("ended", "the recording is over"))
    assert [tip.read(0).seq, tip.read(0).seq] == [0, 1]
    with pytest.raises(EndOfRecording):
        tip.read(0)
    assert tip.latest().seq == 1


def test_a_device_of_another_design_is_refused(open_feed) -> None:
    tip, feed = open_feed()
    feed.packet(0, design=0xBEEF)
    with pytest.raises(WrongDesign, match=r"design beef….*Use the layout\.json") as caught:
        tip.read(0.1)
    assert caught.value.found == "beef…"
    assert caught.value.expected == f"{tip.layout.design_hash[:4]}…"
    with pytest.raises(WrongDesign):
        tip.latest()
    told, feed = open_feed(any_design=True)
    feed.packet(0, design=0xBEEF)
    assert told.latest().seq == 0


def test_events_tell_what_happens(open_feed) -> None:
    events: list[str] = []
    tip, feed = open_feed(on_event=lambda event: events.append(event.kind))
    feed.packet(1000)
    feed.report(LinkEvent("lost", "gone"))
    feed.report(LinkEvent("connected", "back"))
    feed.packet(0, time_us=100_000)
    assert events == ["connected", "lost", "connected", "restarted"]
    assert tip.stats.reconnects == 1
    assert tip.stats.restarts == 1
    assert tip.latest().dropped_before is None
    assert tip.latest().seq == 1


def test_a_listener_that_fails_harms_nothing(open_feed, caplog: pytest.LogCaptureFixture) -> None:
    def fails(_: LinkEvent) -> None:
        raise RuntimeError("mine")

    tip, feed = open_feed(on_event=fails)
    feed.packet(0)
    assert tip.latest().seq == 0
    assert "on_event failed" in caplog.text


def test_rate_and_jitter(open_feed) -> None:
    tip, feed = open_feed()
    assert tip.stats.rate_hz is None
    for n in range(0, 400, 4):
        feed.packet(n, 4, t_host=50.0 + n * 0.01 + 0.03)
    stats = tip.stats
    assert stats.rate_hz == pytest.approx(100.0, rel=1e-3)
    assert stats.jitter_ms == pytest.approx(np.std([0, 10, 20, 30]), rel=0.01)


def _until(true, timeout_s: float = 5.0) -> None:
    until = time.monotonic() + timeout_s
    while not true():
        assert time.monotonic() < until, "did not happen"
        time.sleep(0.002)
