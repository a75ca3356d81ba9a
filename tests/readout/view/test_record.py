"""Recording and taring from the page."""

import os
import re
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import Writer as McapWriter
from playwright.sync_api import Page, expect

from live_page import opened
from lumitip import Layout
from lumitip.calibration import Calibration
from lumitip.errors import ViewError
from lumitip.fingertip import Fingertip
from lumitip.recording import Reader, RecordingError, summarise
from lumitip.view.finger import Finger
from lumitip.view.registry import FingerRegistry
from lumitip.view.server import ViewServer

pytestmark = pytest.mark.slow

Serve = Callable[..., ViewServer]
StillFinger = Callable[[Layout, np.ndarray], Finger]
WaitFor = Callable[[Callable[[], bool]], None]


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


def test_a_second_press_stops_a_recording_at_once(
    serve: Serve, page: Page, wait_for: WaitFor
) -> None:
    server = serve("twin://demo?rate=200")
    finger = server.registry.fingers[1]
    opened(page, server)
    for number in (1, 2):
        page.keyboard.press("r")
        page.keyboard.press("r")
        name = f"twin-demo-{number:03d}.mcap"
        expect(page.locator("#notice")).to_have_text(f"{name} written")
        recording = finger.status()["recording"]
        assert (recording["file"], recording["on"]) == (name, False)
    page.keyboard.press("r")
    wait_for(lambda: bool(finger.status()["recording"]["on"]))


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


def test_a_recording_that_dies_is_said_once_and_can_be_read(
    serve: Serve, page: Page, monkeypatch: pytest.MonkeyPatch
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
    slow: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
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
