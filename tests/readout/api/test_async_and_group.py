"""`AsyncFingertip` and `FingertipGroup`."""

import asyncio
import threading
from pathlib import Path

import numpy as np
import pytest

from lumitip import AsyncFingertip, FingertipGroup, Layout
from lumitip.errors import ArgumentError, FingertipClosed, LinkTimeout, UrlError
from lumitip.frame import RecordedFrame
from lumitip.recording import Writer
from lumitip.session.hub import Hub

FAST = "twin://disc?rate=1000"


def test_coroutines_read_in_every_way() -> None:
    async def main() -> None:
        async with AsyncFingertip.open(FAST) as tip:
            one, two = await tip.read(5.0), await tip.read(5.0)
            assert two.seq == one.seq + 1
            block = await tip.get_data(30)
            assert block.values.shape == (30, 32)
            assert block.seq[0] == two.seq + 1
            assert tip.latest().seq >= block.seq[-1]
            seen = []
            async for frame in tip:
                seen.append(frame.seq)
                if len(seen) == 20:
                    break
            assert np.diff(seen).tolist() == [1] * 19
            assert tip.fingertip.stats.received > 50
        with pytest.raises(FingertipClosed, match="not open: use `async with"):
            await tip.read()

    asyncio.run(main())


def test_a_cancelled_read_takes_no_frame() -> None:
    async def main() -> None:
        async with AsyncFingertip.open("twin://disc?rate=20") as tip:
            first = await tip.read(5.0)
            reading = asyncio.create_task(tip.read(5.0))
            await asyncio.sleep(0)
            reading.cancel()
            with pytest.raises(asyncio.CancelledError):
                await reading
            assert (await tip.read(5.0)).seq == first.seq + 1

    asyncio.run(main())


def test_timeouts_and_errors_are_those_of_the_plain_fingertip() -> None:
    async def main() -> None:
        async with AsyncFingertip.open("twin://disc?rate=1") as tip:
            with pytest.raises(LinkTimeout, match=r"no frame in 0\.02 s"):
                await tip.read(0.02)
            with pytest.raises(LinkTimeout, match=r"0 of 5 frames came in 0\.02 s"):
                await tip.get_data(5, timeout=0.02)
            with pytest.raises(ValueError, match="num_samples is 0"):
                await tip.get_data(0)
        with pytest.raises(UrlError):
            async with AsyncFingertip.open("twin://pyramid"):
                pass

    asyncio.run(main())


def test_closing_ends_a_loop_that_waits() -> None:
    async def main() -> None:
        async with AsyncFingertip.open("twin://disc?rate=1") as tip:

            async def loop() -> int:
                return len([frame async for frame in tip])

            looping = asyncio.create_task(loop())
            await asyncio.sleep(0.05)
            tip.fingertip.close()
            assert await asyncio.wait_for(looping, 5.0) == 0

    asyncio.run(main())


def test_a_fingertip_that_opens_after_its_task_was_cancelled_is_closed_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    closed: list[Hub] = []
    close = Hub.close
    monkeypatch.setattr(Hub, "close", lambda hub, *a: (closed.append(hub), close(hub, *a)))

    async def main() -> None:
        async def open_it() -> None:
            async with AsyncFingertip.open("twin://disc?rate=1"):
                raise AssertionError("was cancelled before")

        opening = asyncio.create_task(open_it())
        await asyncio.sleep(0)
        opening.cancel()
        with pytest.raises(asyncio.CancelledError):
            await opening

    asyncio.run(main())
    assert len(closed) == 1


def test_frames_of_a_group_belong_together() -> None:
    urls = {"slow": "twin://disc?rate=50", "fast": "twin://cable?rate=400"}
    with FingertipGroup.open(urls) as group:
        moments = [group.read(5.0) for _ in range(12)]
    slow = [m["slow"].seq for m in moments]
    assert np.diff(slow).tolist() == [1] * 11, "the slowest sets the pace"
    assert np.diff([m["fast"].seq for m in moments]).min() > 1
    assert np.median([m.spread_s for m in moments]) < 0.01
    assert all(m["slow"].device_id == "twin:disc" for m in moments)
    for m in moments:
        assert min(f.t for f in m.frames.values()) <= m.t <= max(f.t for f in m.frames.values())


def test_the_nearest_frame_is_chosen_and_none_is_lost_on_a_timeout(open_feed) -> None:
    one, left = open_feed(device_id="left")
    two, right = open_feed(device_id="right")
    group = FingertipGroup({"left": one, "right": two})
    with pytest.raises(LinkTimeout, match=r"^left: no frame"):
        group.read(0.0)
    with pytest.raises(LinkTimeout):
        two.read(0.0)
    at = 100.0
    left.packet(0, t_host=at)
    with pytest.raises(LinkTimeout, match=r"^right: no frame"):
        group.read(0.0)
    for n in range(5):
        right.packet(n, t_host=at + 0.01 * n - 0.014)
    moment = group.read(0.0)
    assert moment["left"].seq == 0
    assert moment["right"].raw[0] == 1, "4 ms before, the next is 6 ms after"
    left.packet(2, t_host=at + 0.02)
    assert group.read(0.0)["right"].raw[0] == 3


def test_the_newest_moment_of_a_group_queues_nothing(open_feed) -> None:
    one, left = open_feed(device_id="left")
    two, right = open_feed(device_id="right")
    group = FingertipGroup({"left": one, "right": two})
    for n in range(5):
        left.packet(n)
        right.packet(n + 10)
    moment = group.wait_latest(1.0)
    assert (moment["left"].raw[0], moment["right"].raw[0]) == (4, 14)
    left.packet(5)
    with pytest.raises(LinkTimeout, match=r"^right: no frame in 0\.0\d* s"):
        group.wait_latest(0.05)
    sent = threading.Timer(0.05, lambda: (right.packet(15), left.packet(7)))
    left.packet(6)
    sent.start()
    moment = group.wait_latest(5.0)
    assert moment["left"].raw[0] in (6, 7)
    assert moment["right"].raw[0] == 15
    sent.join()
    with pytest.raises(ArgumentError, match="timeout_s is -1"):
        group.wait_latest(-1.0)


@pytest.mark.parametrize("booted_s", [0.0, 50_000.0])
def test_recordings_are_aligned_by_the_wall_clock(
    tmp_path: Path, layout: Layout, booted_s: float
) -> None:
    """Two at 100 Hz: of one computer, and of another one that was booted earlier."""
    urls, raw = {}, np.full(len(layout), 20, np.uint8)
    for name, delay_s, late_s, clock_s in (
        ("left", 0.002, 0.0, 0.0),
        ("right", 0.036, 0.203, booted_s),
    ):
        path = tmp_path / f"{name}.mcap"
        with Writer(path, layout, device_id=name, start_wall=1000.0) as writer:
            for i in range(60):
                at = 0.01 * i + late_s
                t_host = 70.0 + clock_s + at + delay_s
                writer.write(RecordedFrame(i, at, t_host, 1000.0 + at, raw, 8, 0))
        urls[name] = f"replay://{path}?speed=0"
    with FingertipGroup.open(urls) as group:
        moments = [group.read(10.0) for _ in range(20)]
    for n, moment in enumerate(moments):
        left, right = moment["left"], moment["right"]
        assert (left.seq, right.seq) == (20 + n, n)
        assert moment.recorded
        assert moment.spread_s == pytest.approx(0.003, abs=1e-5)
        # Frames keep their times; the moment has the clock of the first.
        assert left.t == pytest.approx(70.0 + 0.01 * left.seq + 0.002, abs=1e-5)
        assert right.t == pytest.approx(70.0 + booted_s + 0.01 * right.seq + 0.239, abs=1e-5)
        assert moment.t == pytest.approx(left.t + 0.0015, abs=1e-5)


def test_a_group_opens_all_or_none(monkeypatch: pytest.MonkeyPatch) -> None:
    closed: list[Hub] = []
    close = Hub.close
    monkeypatch.setattr(Hub, "close", lambda hub, *a: (closed.append(hub), close(hub, *a)))
    with pytest.raises(UrlError):
        FingertipGroup.open({"a": FAST, "b": "twin://pyramid"})
    assert len(closed) == 1
    with pytest.raises(ValueError, match="at least one"):
        FingertipGroup.open({})


def test_layouts_of_a_group_by_name(make_layout) -> None:
    small = make_layout((4, 5, 4), 5.0)
    with FingertipGroup.open({"a": FAST, "b": FAST}, {"b": small}) as group:
        moment = group.read(5.0)
    assert moment["a"].values.shape == (32,)
    assert moment["b"].values.shape == (13,)
