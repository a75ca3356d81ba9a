"""What cannot be used is refused alike everywhere, in one line; what came is never thrown away."""

import asyncio
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lumitip import AsyncFingertip, Fingertip, FingertipGroup
from lumitip.calibration import user_folder
from lumitip.errors import (
    ArgumentError,
    CalibrationError,
    EndOfRecording,
    LayoutError,
    LinkTimeout,
    LumitipError,
    UrlError,
)
from lumitip.links.base import LinkEvent

ODD_TIMES = [math.nan, -1.0, -math.inf, "3", [1.0], 1j]


@pytest.mark.parametrize("timeout", ODD_TIMES)
def test_a_timeout_that_is_none_is_refused_alike_everywhere(open_feed, timeout) -> None:
    tip, _ = open_feed()
    group = FingertipGroup({"one": tip})
    waits: list[Callable[[], object]] = [
        lambda: tip.read(timeout),
        lambda: tip.get_data(3, timeout),
        lambda: next(tip.frames(timeout)),
        lambda: group.read(timeout),
        lambda: next(group.moments(timeout)),
        lambda: Fingertip.open("twin://demo", timeout=timeout),
    ]
    for wait in waits:
        with pytest.raises(ArgumentError, match=r"timeout is .*; seconds from 0 on are needed"):
            wait()

    async def main() -> None:
        async with AsyncFingertip.open("twin://disc") as slow:
            for wait in (slow.read, lambda t: slow.get_data(3, t)):
                with pytest.raises(ArgumentError, match=r"timeout is .*; seconds from 0"):
                    await wait(timeout)

    if timeout is ODD_TIMES[0]:
        asyncio.run(main())


def test_without_a_timeout_all_wait_as_long_as_it_takes() -> None:
    with Fingertip.open("twin://demo?rate=300", timeout=None) as tip:
        assert len(tip.get_data(2, timeout=None)) == 2
        with FingertipGroup.open({"one": "twin://demo?rate=300"}, timeout=None) as group:
            assert group.read(timeout=None)["one"].seq >= 0


@pytest.mark.parametrize("number", [0, -1, 2.5, "3", None])
def test_a_number_that_is_none_is_refused(open_feed, number) -> None:
    tip, _ = open_feed()
    for ask in (tip.get_data, lambda n: tip.tare(num_samples=n)):
        with pytest.raises(ArgumentError, match=r"num_samples is .*; a whole number from 1"):
            ask(number)
    with pytest.raises(ArgumentError, match=r"buffer is .*;"):
        Fingertip.open("twin://demo", buffer=number)


@pytest.mark.parametrize("url", [None, 3, b"twin://demo", ["twin://demo"]])
def test_an_address_that_is_no_text_is_refused(url) -> None:
    with pytest.raises(UrlError, match=r"; one like ble://Lumitip is needed"):
        Fingertip.open(url)
    with pytest.raises(UrlError, match="one like"):
        FingertipGroup.open({"left": url})


def test_what_is_no_layout_or_no_group_is_refused() -> None:
    with pytest.raises(LayoutError, match=r"\{'a': 1\}; a Layout or the path of one"):
        Fingertip.open("twin://demo", {"a": 1})
    for urls in (["twin://demo"], "twin://demo", None, {}):
        with pytest.raises(ArgumentError, match="names and addresses of at least one fingertip"):
            FingertipGroup.open(urls)


def test_a_kind_that_there_is_not_is_refused(open_feed) -> None:
    tip, _ = open_feed()
    with pytest.raises(ArgumentError, match="kind is 'foo'; allowed are empty, dark"):
        tip.tare("foo")


def test_the_end_of_a_recording_holds_the_frames_that_were_left(open_feed) -> None:
    tip, feed = open_feed()
    with pytest.raises(LinkTimeout):
        tip.read(0.0)
    feed.packet(0, 7)
    feed.report(LinkEvent("ended", "run.mcap is over"))
    assert tip.get_data(4).seq.tolist() == [0, 1, 2, 3]
    with pytest.raises(EndOfRecording, match=r"over: 3 of 4 frames were left") as caught:
        tip.get_data(4)
    assert caught.value.block.seq.tolist() == [4, 5, 6]
    assert caught.value.block.values.shape == (3, 32)
    with pytest.raises(EndOfRecording, match="0 of 4") as caught:
        tip.get_data(4)
    assert caught.value.block is None


def test_a_timeout_holds_the_frames_that_came(open_feed) -> None:
    tip, feed = open_feed()
    with pytest.raises(LinkTimeout) as caught:
        tip.get_data(2, timeout=0.0)
    assert caught.value.block is None
    feed.packet(0, 3)
    with pytest.raises(LinkTimeout, match="3 of 8") as caught:
        tip.get_data(8, timeout=0.02)
    assert caught.value.block.seq.tolist() == [0, 1, 2]


def test_coroutines_get_the_rest_of_a_recording_too(tmp_path: Path, layout) -> None:
    from lumitip.frame import Frame
    from lumitip.recording import Writer

    path, raw = tmp_path / "run.mcap", np.zeros(32, np.uint8)
    with Writer(path, layout, device_id="dev") as writer:
        for n in range(7):
            writer.write(Frame(n, n / 50, 0.0, 0.0, 1e9 + n / 50, raw, 8, raw * 1.0, 0, "dev"))

    async def main() -> list[int]:
        sizes = []
        async with AsyncFingertip.open(f"replay://{path}?speed=0") as tip:
            with pytest.raises(EndOfRecording) as caught:
                while True:
                    sizes.append(len(await tip.get_data(3)))
        return [*sizes, len(caught.value.block)]

    assert asyncio.run(main()) == [3, 3, 1]


def test_the_users_folder_needs_no_home_when_one_is_set(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def homeless() -> Path:
        raise RuntimeError("no home")

    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setattr(Path, "home", homeless)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    assert user_folder() == tmp_path / "lumitip"
    monkeypatch.delenv("XDG_DATA_HOME")
    with pytest.raises(CalibrationError, match="Set XDG_DATA_HOME to a folder") as caught:
        user_folder()
    assert isinstance(caught.value, LumitipError)


@pytest.mark.parametrize("timeout", [float("inf"), 1e12])
def test_a_timeout_of_centuries_waits(timeout: float) -> None:
    with Fingertip.open("twin://demo?rate=300", timeout=timeout) as tip:
        assert tip.read(timeout).seq >= 0
        assert len(tip.get_data(3, timeout)) == 3
