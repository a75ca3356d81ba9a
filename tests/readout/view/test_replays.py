"""Replaying from the page."""

import os
import re
import shutil
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from live_page import opened, until
from lumitip import LumitipError
from lumitip.cli import main
from lumitip.errors import ViewError
from lumitip.recording import Reader
from lumitip.view.finger import Finger
from lumitip.view.player import Player
from lumitip.view.registry import MOST_REPLAYS, FingerRegistry
from lumitip.view.server import ViewServer

pytestmark = pytest.mark.slow

Serve = Callable[..., ViewServer]
WaitFor = Callable[[Callable[[], bool]], None]
PLAYER = "lumitip.panels.get({}).status?.player"


def test_a_damaged_recording_says_so(serve: Serve, page: Page, recording: Path) -> None:
    data = bytearray(recording.read_bytes())
    data[len(data) // 2 : len(data) // 2 + 4096] = bytes(4096)
    recording.write_bytes(data)
    opened(page, serve(f"replay://{recording}?speed=16"))
    expect(page.locator(".speed")).to_have_value("16")
    expect(page.locator(".speed option").last).to_have_text("16 ×")
    expect(page.locator(".detail")).to_contain_text("damaged: bytes ")


def test_replay_from_the_page_pauses_winds_and_closes(
    serve: Serve, page: Page, wait_for: WaitFor, recording: Path
) -> None:
    opened(page, serve("twin://edge"))
    page.keyboard.press("p")
    page.get_by_role("button", name=recording.name).click()
    expect(page.locator(".finger")).to_have_count(2, timeout=30_000)
    replay = page.locator(".finger").nth(1)
    expect(replay.locator(".tare")).to_be_hidden()
    wait_for(lambda: bool(page.evaluate(PLAYER.format(2))))
    page.keyboard.press("k")
    wait_for(lambda: page.evaluate(PLAYER.format(2))["playing"] is False)
    replay.locator(".seek").fill("1.5")
    wait_for(lambda: abs(page.evaluate(PLAYER.format(2))["position_s"] - 1.5) < 0.02)
    wait_for(
        lambda: (
            page.evaluate("lumitip.panels.get(2).newest.seq") == list(Reader(recording))[150].seq
        )
    )
    page.keyboard.press("ArrowRight")
    wait_for(lambda: abs(page.evaluate(PLAYER.format(2))["position_s"] - 2.5) < 0.02)
    replay.locator(".speed").select_option("0.5")
    wait_for(lambda: page.evaluate(PLAYER.format(2))["speed"] == 0.5)
    replay.locator(".play").click()
    wait_for(lambda: page.evaluate(PLAYER.format(2))["position_s"] > 2.9)
    replay.locator(".close").click()
    expect(page.locator(".finger")).to_have_count(1, timeout=30_000)


def test_replays_of_a_file_are_one_and_replays_of_all_are_few(
    recording: Path,
) -> None:
    folder = recording.parent
    for n in range(1, MOST_REPLAYS + 1):
        shutil.copy(recording, folder / f"copy-{n}.mcap")
    registry = FingerRegistry([Finger.open("twin://edge")], folder)
    try:
        number = registry.replay("run.mcap")
        player = registry.fingers[number].player
        player.control(playing=False)
        assert registry.replay("run.mcap") == number
        assert player.status()["playing"], "it goes on"
        recording.write_bytes((folder / "copy-1.mcap").read_bytes())
        os.utime(recording, ns=(0, 0))
        changed = registry.replay("run.mcap")
        assert changed != number, "another recording of the same name"
        for n in range(1, MOST_REPLAYS - 1):
            registry.replay(f"copy-{n}.mcap")
        with pytest.raises(ViewError, match=r"8 replays are open; 8 are allowed\. Close one, then"):
            registry.replay(f"copy-{MOST_REPLAYS}.mcap")
        assert registry.replay("run.mcap") == changed
        registry.remove(number)
        registry.replay(f"copy-{MOST_REPLAYS}.mcap")
        assert len(registry.fingers) == 1 + MOST_REPLAYS
    finally:
        registry.close()


def test_a_replay_that_is_asked_for_twice_is_one_finger(
    serve: Serve, page: Page, recording: Path
) -> None:
    opened(page, serve("twin://edge"))
    for _ in range(2):
        page.keyboard.press("p")
        page.get_by_role("button", name=recording.name).click()
        expect(page.locator("#notice")).to_have_text(f"replaying {recording.name}")
        expect(page.locator(".finger")).to_have_count(2)
        expect(page.locator(".finger").nth(1)).to_have_class(re.compile("chosen"))
        page.keyboard.press("1")
    page.wait_for_timeout(500)
    expect(page.locator(".finger")).to_have_count(2)


def test_a_page_that_is_loaded_after_the_end_shows_the_last_frame(
    serve: Serve, page: Page, wait_for: WaitFor, recording: Path
) -> None:
    server = serve(f"replay://{recording}?speed=16")
    finger = server.registry.fingers[1]
    wait_for(lambda: finger.status()["player"]["playing"] is False)
    last = list(Reader(recording))[-1].seq
    for _ in range(6):
        page.goto(server.url)
        page.wait_for_selector(f'.finger[data-seq="{last}"]')
        grid = "lumitip.panels.get(1).grid.canvas.getContext('2d').getImageData(0, 0, 800, 400)"
        until(page, f"new Set(new Uint32Array({grid}.data.buffer)).size > 50")
        expect(page.locator(".kind")).to_have_text("cable")  # the estimate is there too
    # The list of fingers may come long after the frame.
    page.route("**/api/fingers", lambda route: (page.wait_for_timeout(400), route.continue_()))
    page.goto(server.url)
    page.wait_for_selector(f'.finger[data-seq="{last}"]')


def test_player_gives_every_frame_as_it_was(recording: Path, wait_for: WaitFor) -> None:
    expected = list(Reader(recording))
    got: list[Any] = []
    player = Player(recording, speed=16.0)
    player.start(lambda arrival: got.append(arrival.content), lambda _: None)
    wait_for(lambda: len(got) == len(expected))
    for asked, was in zip(got, expected, strict=True):
        assert (asked.seq, asked.t_wall, asked.bits) == (was.seq, was.t_wall, was.bits)
        np.testing.assert_array_equal(asked.raw, was.raw)
    assert player.status()["playing"] is False
    # At its end it begins again.
    player.control(playing=True)
    wait_for(lambda: len(got) == 2 * len(expected))
    player.stop()


def test_a_replay_waits_for_the_view_that_reads_it(recording: Path, wait_for: WaitFor) -> None:
    finger = Finger.open(f"replay://{recording}?speed=16")
    time.sleep(0.8)  # longer than the recording at this speed
    assert finger.count == 0
    finger.start(lambda: None)
    try:
        wait_for(lambda: finger.count == 800)
        assert finger.newer(799)[0][0][0].seq == list(Reader(recording))[-1].seq
    finally:
        finger.close()


def test_one_of_several_fingers_is_replayed(recording: Path, tmp_path: Path) -> None:
    both = tmp_path / "both.mcap"
    assert (
        main(
            [
                "foxglove",
                f"left={recording}",
                f"right={recording}",
                "--out",
                str(both),
                "--no-estimate",
            ]
        )
        == 0
    )
    with pytest.raises(LumitipError, match=r"'left', 'right': choose one"):
        Finger.open(f"replay://{both}")
    assert Player.of_url(f"replay://{both}?finger=right").device_id == "finger"


def test_player_shows_the_frame_it_is_wound_to(recording: Path, wait_for: WaitFor) -> None:
    got: list[Any] = []
    player = Player(recording)
    player.control(playing=False)
    player.start(lambda arrival: got.append(arrival.content), lambda _: None)
    expected = list(Reader(recording))
    for count, (position_s, frame) in enumerate(((2.0, 200), (0.0, 0), (99.0, 799), (-1.0, 0)), 1):
        player.control(position_s=position_s)
        wait_for(lambda count=count: len(got) == count)  # type: ignore[misc]
        assert got[-1].seq == expected[frame].seq
    player.stop()
    assert len(got) == 4


def test_player_refuses_what_it_cannot_play(tmp_path: Path, recording: Path) -> None:
    with pytest.raises(LumitipError, match="cannot be read"):
        Finger.open(f"replay://{tmp_path / 'none.mcap'}")
    broken = tmp_path / "broken.mcap"
    broken.write_bytes(b"not a recording")
    with pytest.raises(LumitipError, match="no MCAP recording"):
        Finger.open(f"replay://{broken}")
    with pytest.raises(LumitipError, match="speed"):
        Finger.open(f"replay://{recording}?speed=1000")
    with pytest.raises(LumitipError, match="speed"):
        Player(recording).control(speed=0.0)
