"""Recording, replaying and taring from the page."""

import os
import re
import shutil
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import Writer as McapWriter
from playwright.sync_api import Page, expect

from live_page import opened, until
from lumitip import Layout, LumitipError
from lumitip.calibration import Calibration
from lumitip.cli import main
from lumitip.errors import ViewError
from lumitip.fingertip import Fingertip
from lumitip.recording import Reader, RecordingError, Writer, summarise
from lumitip.view.finger import Finger
from lumitip.view.player import Player
from lumitip.view.registry import MOST_REPLAYS, FingerRegistry
from lumitip.view.server import ViewServer

pytestmark = pytest.mark.slow

Serve = Callable[..., ViewServer]
StillFinger = Callable[[Layout, np.ndarray], Finger]
WaitFor = Callable[[Callable[[], bool]], None]
PLAYER = "lumitip.panels.get({}).status?.player"


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """800 frames at 100 Hz of a cable that moves."""
    path = tmp_path / "recordings" / "run.mcap"
    path.parent.mkdir()
    with Fingertip.open("twin://cable?rate=2000&speed=240&noise=0") as tip:
        frames = [tip.read() for _ in range(800)]
        with Writer(path, tip.layout, device_id="finger", start_wall=1000.0) as writer:
            for i, frame in enumerate(frames):
                writer.write(replace(frame, t_wall=1000.0 + i / 100))
    return path


def test_recording_from_the_page_makes_a_readable_file(
    serve: Serve, page: Page, wait_for: WaitFor, tmp_path: Path
) -> None:
    server = serve("twin://demo?rate=200")
    opened(page, server)
    page.locator(".record").click()
    expect(page.locator(".record")).to_have_attribute("aria-pressed", "true")
    wait_for(
        lambda: (server.registry.fingers[1].status()["recording"] or {}).get("frames", 0) > 200
    )
    page.keyboard.press("r")
    expect(page.locator("#notice")).to_have_text("twin-demo-001.mcap written")
    expect(page.locator(".record")).to_have_attribute("aria-pressed", "false")
    reader = Reader(tmp_path / "recordings" / "twin-demo-001.mcap")
    frames = list(reader)
    assert reader.layout == server.registry.fingers[1].tip.layout
    assert reader.metadata.device_id == "twin:demo"
    seq = [f.seq for f in frames]
    assert len(seq) > 200
    assert seq == list(range(seq[0], seq[0] + len(seq)))

    page.keyboard.press("r")
    expect(page.locator(".recorded")).to_have_text(re.compile("recording twin-demo-002.mcap"))


def test_references_do_not_change_while_they_are_recorded(serve: Serve, page: Page) -> None:
    server = serve("twin://edge?rate=200")
    opened(page, server)
    page.keyboard.press("r")
    expect(page.locator(".record")).to_have_attribute("aria-pressed", "true")
    page.locator(".tare").click()
    expect(page.locator("#notice")).to_contain_text("twin-edge-001.mcap is being recorded")
    assert server.registry.fingers[1].tip.calibration.empty is None


def test_no_recording_starts_while_a_reference_is_measured(
    serve: Serve, page: Page, wait_for: WaitFor, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    measured = threading.Event()
    monkeypatch.setattr(Fingertip, "tare", lambda *_: measured.wait(60.0))
    server = serve("twin://edge?rate=200")
    finger = server.registry.fingers[1]
    opened(page, server)
    page.keyboard.press("t")
    expect(page.locator(".record")).to_be_disabled()
    wait_for(lambda: finger.status()["taring"])
    page.keyboard.press("r")
    with pytest.raises(ViewError, match="a reference is being measured; record afterwards"):
        finger.record(tmp_path / "run.mcap")
    with pytest.raises(ViewError, match="a reference is being measured; tare again afterwards"):
        finger.tare("empty")
    page.reload()  # as another browser
    expect(page.locator(".tare")).to_be_disabled()
    expect(page.locator(".record")).to_be_disabled()
    measured.set()
    expect(page.locator(".record")).to_be_enabled()
    assert server.registry.recordings() == []
    page.keyboard.press("r")
    expect(page.locator(".record")).to_have_attribute("aria-pressed", "true")


def test_a_damaged_recording_says_so(serve: Serve, page: Page, recording: Path) -> None:
    data = bytearray(recording.read_bytes())
    data[len(data) // 2 : len(data) // 2 + 4096] = bytes(4096)
    recording.write_bytes(data)
    opened(page, serve(f"replay://{recording}?speed=16"))
    expect(page.locator(".detail")).to_contain_text("damaged: bytes ")


def test_a_recording_that_dies_is_said_once_and_can_be_read(
    serve: Serve, page: Page, wait_for: WaitFor, monkeypatch: pytest.MonkeyPatch
) -> None:
    server = serve("twin://demo?rate=200")
    opened(page, server)
    page.keyboard.press("r")
    expect(page.locator(".recorded")).to_contain_text("recording twin-demo-001.mcap")
    full = OSError(28, "No space left on device")

    def fails(*_: object) -> None:
        raise full

    monkeypatch.setattr(McapWriter, "add_message", fails)
    notice, box = page.locator("#notice"), page.locator(".recorded")
    path = server.registry.folder / "twin-demo-001.mcap"
    error = f"the recording ended: {path}: cannot be written: {full}"
    expect(notice).to_have_text(f"twin:demo: {error}")
    expect(notice).to_have_class("error")
    expect(box).to_have_class("recorded bad")
    expect(box).to_contain_text(error)
    for shown in (notice, box):
        assert shown.evaluate("e => e.scrollHeight <= e.clientHeight")
        assert shown.evaluate("e => e.scrollWidth <= e.clientWidth")
    expect(page.locator(".record")).to_have_attribute("aria-pressed", "false")
    notice.click()
    expect(notice).to_have_text("")
    page.wait_for_timeout(1500)  # some statuses later
    expect(notice).to_have_text("")
    server.registry.fingers[1].warning = "RerunSink has failed"
    expect(page.locator(".detail")).to_have_text("RerunSink has failed")
    expect(page.locator(".detail")).to_have_class("detail bad")


@pytest.mark.parametrize("slow", ["add_message", "finish", "start"])
def test_a_slow_disk_does_not_hold_up_the_status(
    slow: str, wait_for: WaitFor, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    waits, goes_on = threading.Event(), threading.Event()
    real = getattr(McapWriter, slow)

    def slowly(*arguments: Any, **more: Any) -> Any:
        waits.set()
        assert goes_on.wait(30.0)
        return real(*arguments, **more)

    finger = Finger.open("twin://demo?rate=200")
    if slow != "start":
        finger.record(tmp_path / "run.mcap")
    finger.start(lambda: None)
    monkeypatch.setattr(McapWriter, slow, slowly)
    steps = {"finish": finger.stop_recording, "start": lambda: finger.record(tmp_path / "run.mcap")}
    step = threading.Thread(target=steps.get(slow, lambda: None))
    step.start()
    assert waits.wait(30.0)
    found: list[dict[str, Any]] = []
    asking = threading.Thread(target=lambda: found.append(finger.status()), daemon=True)
    asking.start()
    asking.join(5.0)
    try:
        assert len(found) == 1, "it waits for the disk"
        recording = found[0]["recording"]
        assert (slow == "start") if recording is None else recording["on"]
        assert finger.is_recording_to("run.mcap") == (slow != "start")
    finally:
        goes_on.set()
    step.join(30.0)
    finger.close()
    assert summarise(tmp_path / "run.mcap").damage == ()
    assert not finger.is_recording_to("run.mcap")


def test_recording_ends_with_the_server(
    serve: Serve, page: Page, wait_for: WaitFor, tmp_path: Path
) -> None:
    server = serve("twin://demo?rate=200")
    opened(page, server)
    page.keyboard.press("r")
    wait_for(lambda: (server.registry.fingers[1].status()["recording"] or {}).get("frames", 0) > 50)
    page.goto("about:blank")
    server.__exit__(None, None, None)
    assert len(list(Reader(tmp_path / "recordings" / "twin-demo-001.mcap"))) > 50


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
    recording: Path, wait_for: WaitFor
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
        with pytest.raises(ViewError, match="8 replays are open; 8 are allowed. Close one, then"):
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
    for given, was in zip(got, expected, strict=True):
        assert (given.seq, given.t_wall, given.bits) == (was.seq, was.t_wall, was.bits)
        np.testing.assert_array_equal(given.raw, was.raw)
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


def test_tare_from_the_page_is_kept_and_refused_when_something_moves(
    serve: Serve, page: Page, wait_for: WaitFor, still: StillFinger, layout: Layout
) -> None:
    finger = still(layout, np.linspace(10, 40, len(layout)))
    server = serve(finger, "twin://cable?speed=400&rate=500")
    opened(page, server)
    page.keyboard.press("2")
    page.keyboard.press("t")
    notice = page.locator("#notice")
    expect(notice).to_contain_text("Hold the fingers still and open, away from flickering light")
    expect(notice).to_have_class("error")
    page.wait_for_timeout(7000)  # a notice that is no error has gone by then
    for width in (1280, 700, 390):
        page.set_viewport_size({"width": width, "height": 800})
        expect(notice).to_contain_text("away from flickering light")
        assert notice.evaluate("e => e.scrollWidth <= e.clientWidth"), width
        assert notice.evaluate("e => e.scrollHeight <= e.clientHeight"), width
    notice.click()
    expect(notice).to_have_text("")
    assert server.registry.fingers[2].tip.calibration.empty is None

    assert min(page.evaluate("[...lumitip.panels.get(1).newest.values]")) == 255 - 40
    page.keyboard.press("1")
    page.keyboard.press("t")
    expect(page.locator("#notice")).to_have_text("still: tared, empty reference")
    kept = Calibration.kept("still", layout.design_hash, len(layout))
    assert kept.empty is not None
    np.testing.assert_allclose(kept.empty, 255 - np.floor(np.linspace(10, 40, len(layout))))
    wait_for(lambda: min(page.evaluate("[...lumitip.panels.get(1).newest.values]")) > 254)


def test_files_that_cannot_be_named_or_read_hide_no_others(recording: Path) -> None:
    folder = recording.parent
    (Path(os.fsdecode(os.fsencode(folder) + b"/\xff.mcap"))).write_bytes(b"x")
    (folder / "broken.mcap").symlink_to(folder / "gone")
    assert FingerRegistry((), folder).recordings() == ["run.mcap"]


def test_one_recording_that_cannot_be_ended_keeps_no_other_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fingers = [Finger.open("twin://demo"), Finger.open("twin://edge")]
    registry = FingerRegistry(fingers, tmp_path)
    for finger in fingers:
        finger.record(registry.fresh(finger))

    stop = fingers[0]._recorder.stop

    def fails() -> None:
        stop()
        raise RecordingError("disk full")

    monkeypatch.setattr(fingers[0]._recorder, "stop", fails)
    with pytest.raises(RecordingError, match="disk full"):
        registry.close()
    assert summarise(tmp_path / "twin-edge-001.mcap").damage == ()
    assert not any(finger.tip.connected for finger in fingers)
