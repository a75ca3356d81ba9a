"""A recording as a link: in its own time, or as fast as it is read."""

import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from lumitip import Calibration, Fingertip, Frame, Layout
from lumitip.errors import (
    EndOfRecording,
    LinkError,
    LinkTimeout,
    LumitipError,
    UrlError,
    WrongDesign,
)
from lumitip.recording import Writer

START = 1.7e9
PERIOD_S = 0.02


def _frames(layout: Layout, number: int) -> Iterator[Frame]:
    for n in range(number):
        lost = 3 if n == 5 else 0
        seq = n + (3 if n >= 5 else 0)
        raw = np.full(len(layout), seq % 251, np.uint8)
        yield Frame(
            seq,
            7.0 + seq * PERIOD_S,
            500.0 + seq * PERIOD_S,
            0.0,
            START + seq * PERIOD_S,
            raw,
            8,
            raw.astype(np.float32),
            lost,
            "dev",
        )


@pytest.fixture
def record(layout: Layout, tmp_path: Path) -> Callable[..., Path]:
    def made(number: int, calibration: Calibration | None = None) -> Path:
        path = tmp_path / f"run{number}.mcap"
        with Writer(path, layout, device_id="dev", calibration=calibration) as writer:
            for frame in _frames(layout, number):
                writer.write(frame)
        return path

    return made


def test_it_plays_in_its_own_time(record, layout: Layout) -> None:
    path = record(20)
    with Fingertip.open(f"replay://{path}") as tip:
        began = time.monotonic()
        assert tip.layout == layout
        assert tip.device_id == "dev"
        frames = list(tip.frames())
        assert time.monotonic() - began > 0.3
        with pytest.raises(EndOfRecording, match="is over"):
            tip.read(0.0)
        last = tip.latest()
    assert last.seq == 22
    assert frames[-1].seq == 22
    assert frames[-1].t_wall == pytest.approx(START + 22 * PERIOD_S, abs=1e-6)
    assert frames[-1].t_host == pytest.approx(500.0 + 22 * PERIOD_S)
    assert frames[-1].t == pytest.approx(frames[-1].t_host)
    assert frames[-1].t_device == pytest.approx(7.0 + 22 * PERIOD_S)
    assert frames[-1].values[0] == 255.0 - 22


def test_a_reader_that_comes_late_misses_nothing(record) -> None:
    with Fingertip.open(f"replay://{record(20)}?speed=50") as tip:
        time.sleep(0.2)  # longer than the recording
        assert tip.stats.received <= 1
        assert [frame.seq for frame in tip.frames()] == [*range(5), *range(8, 23)]


@pytest.mark.parametrize("asks", ["latest", "wait_latest"])
def test_asking_for_the_newest_frame_starts_it(record, asks: str) -> None:
    with Fingertip.open(f"replay://{record(20)}") as tip:
        until = time.monotonic() + 5.0
        frame = None
        while frame is None and time.monotonic() < until:
            frame = tip.latest() if asks == "latest" else tip.wait_latest(1.0)
        assert frame is not None and frame.seq < 5


def test_the_newest_frame_is_asked_for_again_and_again(record) -> None:
    with Fingertip.open(f"replay://{record(20)}?speed=0") as tip:
        until, seen = time.monotonic() + 10.0, set()
        while len(seen) < 20 and time.monotonic() < until:
            if (frame := tip.latest()) is not None:
                seen.add(frame.seq)
            time.sleep(0.001)
        assert len(seen) > 10


def test_a_slow_reader_of_a_recording_at_its_own_speed_is_warned(
    record, caplog: pytest.LogCaptureFixture
) -> None:
    with Fingertip.open(f"replay://{record(60)}") as tip:
        frames = tip.frames()
        next(frames)
        time.sleep(0.9)
        for _ in range(3):
            next(frames)
    assert "s behind" in caplog.text


def test_a_recording_that_nobody_reads_can_be_closed(record) -> None:
    began = time.monotonic()
    with Fingertip.open(f"replay://{record(20)}"):
        pass
    assert time.monotonic() - began < 2.0


def test_the_home_folder_has_its_usual_sign(
    record, layout: Layout, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from lumitip.view.player import Player

    path = record(3)
    monkeypatch.setenv("HOME", str(tmp_path))
    with Fingertip.open(f"replay://~/{path.name}?speed=0") as tip:
        assert [f.seq for f in tip.frames()] == [0, 1, 2]
    assert Player.of_url(f"replay://~/{path.name}").layout == layout


def test_as_fast_as_it_is_read_nobody_loses_a_frame(record, until: Callable[..., None]) -> None:
    path = record(3000)
    began = time.monotonic()
    with Fingertip.open(f"replay://{path}?speed=0", buffer=8) as tip:
        time.sleep(0.1)
        assert tip.stats.received <= 1, "nothing is played before somebody reads"
        seen: list[int] = []
        tip.subscribe(lambda frame: seen.append(frame.seq))
        frames = [frame.seq for frame in tip.frames()]
        until(lambda: len(seen) == 3000)
        assert tip.stats.dropped == {"link": 3, "queue": 0, "crc": 0, "length": 0}
    assert time.monotonic() - began < 30 < 3000 * PERIOD_S
    # Whoever comes first starts it, so the second may miss what was played before it came.
    assert len(frames) > 2900
    assert np.diff(frames).max() <= 4, "but nothing in between"


def test_a_slow_reader_that_leaves_holds_nobody_up(record) -> None:
    with Fingertip.open(f"replay://{record(500)}?speed=0", buffer=4) as tip:
        for _, frame in zip(range(2), tip.frames(), strict=False):
            assert frame.seq < 3
        assert len(list(tip.frames())) > 480


def test_a_reader_that_never_comes_back_is_not_waited_for(
    record, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("lumitip.session.queues.PATIENCE_S", 0.1)
    with Fingertip.open(f"replay://{record(500)}?speed=0", buffer=16) as tip:
        tip.read(5.0)  # and never again
        assert [frame.seq for frame in tip.frames()][-1] == 502
        assert tip.stats.overflowed > 400


def test_closing_ends_a_replay_that_waits(record) -> None:
    tip = Fingertip.open(f"replay://{record(500)}?speed=0", buffer=4)
    with pytest.raises(LinkTimeout):
        for _ in range(1000):
            tip.read(0.0)
    closing = threading.Thread(target=tip.close)
    closing.start()
    closing.join(5.0)
    assert not closing.is_alive()


def test_the_recordings_calibration_is_used(record, layout: Layout) -> None:
    empty = np.full((5, len(layout)), 204.0, np.float32)
    then = Calibration("dev", layout.design_hash).measured("empty", empty)
    Calibration("dev", layout.design_hash).measured("empty", empty / 2).save()
    path = record(10, then)
    with Fingertip.open(f"replay://{path}?speed=0") as tip:
        values = [next(iter(tip.frames())).values[0] for _ in range(1)]
        assert tip.calibration.empty == pytest.approx(then.empty)
    assert values[0] == pytest.approx(min(255.0, 255.0 * 255.0 / 204.0))
    with Fingertip.open(f"replay://{path}?speed=0", calibrated=False) as tip:
        assert next(iter(tip.frames())).values[0] == 255.0
        assert tip.calibration.empty is None


def test_an_address_without_a_file_is_refused() -> None:
    with pytest.raises(UrlError, match=r"has no file; one like replay://run\.mcap is needed"):
        Fingertip.open("replay://?speed=2")


def test_a_recording_of_another_design_is_refused(record, make_layout) -> None:
    path = record(10)
    other = make_layout((4, 5, 4), 5.0)
    with pytest.raises(WrongDesign, match=r"run10\.mcap has design"):
        Fingertip.open(f"replay://{path}", other)
    with Fingertip.open(f"replay://{path}?speed=0", other, any_design=True) as tip:
        assert len(tip.layout) == 32


def test_a_damaged_recording_gives_what_it_has_and_says_so(record) -> None:
    path = record(400)
    data = path.read_bytes()
    path.write_bytes(data[: len(data) * 2 // 3])
    with Fingertip.open(f"replay://{path}?speed=0") as tip:
        frames = []
        with pytest.raises(LinkError, match="lumitip recover"):
            frames.extend(iter(lambda: tip.read(5.0), None))
        assert tip.stats.received > 200
    with pytest.raises(LumitipError, match="cannot be read"):
        Fingertip.open(f"replay://{path}.none")


def test_a_fault_while_it_plays_is_told(record, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(_: object) -> Iterator[Frame]:
        raise ArithmeticError("mine")

    tip = Fingertip.open(f"replay://{record(5)}?speed=0")
    tip.close()
    monkeypatch.setattr("lumitip.recording.Reader.__iter__", fails)
    with (
        pytest.raises(LinkError, match="unexpected ArithmeticError: mine"),
        Fingertip.open(f"replay://{record(6)}?speed=0") as tip,
    ):
        tip.read(5.0)
