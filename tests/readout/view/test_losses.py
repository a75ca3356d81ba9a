"""Losses are said in one sentence that stands still."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from live_page import opened
from lumitip import Layout
from lumitip.frame import RecordedFrame
from lumitip.recording import Writer
from lumitip.session.stats import Dropped, Stats
from lumitip.view.finger import Finger
from lumitip.view.losses import Losses
from lumitip.view.server import ViewServer

Serve = Callable[..., ViewServer]
StillFinger = Callable[[Layout, np.ndarray], Finger]
NONE = Stats(100, Dropped(), 0, 0, 0, 0, 0, 100.0, 1.0)
CAUSES = {
    "link": ("lost on the way", "Bring the fingertip closer"),
    "crc": ("damaged on arrival", "another cable"),
    "length": ("cut off on arrival", "firmware"),
    "queue": ("not read in time", "Close other programs"),
}


def lost(**frames: int) -> Stats:
    return replace(NONE, dropped=Dropped(**frames), overflowed=frames.get("queue", 0))


@pytest.mark.parametrize("cause", CAUSES)
def test_sentence_has_count_place_and_remedy(cause: str) -> None:
    losses = Losses()
    assert losses.status(NONE, 0, 0.0)["text"] == "No frame was lost since this page connected."
    said = losses.status(lost(**{cause: 1234}), 0, 3.0)
    what, remedy = CAUSES[cause]
    assert said["text"].startswith(f"1\u202f234 frames were {what} in the last 10 s. ")
    assert remedy in said["text"]
    assert said["fresh"] is True
    assert len(said["text"]) < 120


def test_frames_that_the_page_skips_are_not_called_lost() -> None:
    losses = Losses()
    losses.status(NONE, 0, 0.0)
    text = losses.status(NONE, 40, 3.0)["text"]
    assert text.startswith("40 frames were not drawn by this page in the last 10 s. Recordings")


def test_what_a_hidden_page_missed_is_not_of_the_last_ten_seconds() -> None:
    losses = Losses()
    losses.status(NONE, 0, 0.0)
    losses.status(NONE, 0, 0.5)
    said = losses.status(lost(link=3), 1748, 20.5)
    assert said == {
        "text": "1\u202f748 frames were not drawn by this page while the page was hidden.",
        "fresh": False,
    }
    said = losses.status(lost(link=5), 1748, 22.5)
    assert said["text"].startswith("2 frames were lost on the way in the last 10 s. Bring")
    assert said["fresh"] is True


def test_it_changes_every_two_seconds_at_most_and_goes_after_ten() -> None:
    losses = Losses()
    losses.status(NONE, 0, 0.0)
    said = []
    for step in range(40):  # 20 s, some frames lost in each half second of the first ten
        now_s = 2.5 + 0.5 * step
        stats = lost(link=3 * min(step + 1, 20), crc=min(step + 1, 20))
        said.append(losses.status(stats, 0, now_s)["text"])
    changes = [i for i in range(1, 40) if said[i] != said[i - 1]]
    assert min(np.diff(changes)) >= 4
    assert len(changes) <= 10
    quiet = losses.status(lost(link=60, crc=20), 0, 40.0)
    assert quiet == {
        "text": "80 frames were lost or not drawn since this page connected, none just now.",
        "fresh": False,
    }


def test_frames_that_a_recording_lacks_are_not_blamed_on_the_link() -> None:
    losses = Losses(replayed=True)
    losses.status(NONE, 0, 0.0)
    said = losses.status(lost(link=12), 0, 3.0)["text"]
    assert said == "12 frames were missing in the recording in the last 10 s."
    losses = Losses(replayed=True)
    losses.status(NONE, 0, 0.0)
    said = losses.status(NONE, 40, 3.0)["text"]
    assert said.startswith("40 frames were not drawn by this page in the last 10 s. Close other")


@pytest.mark.slow
def test_a_replay_says_what_its_recording_lacks(
    serve: Serve, page: Page, layout: Layout, tmp_path: Path
) -> None:
    path = tmp_path / "run.mcap"
    raw = np.full(len(layout), 20, np.uint8)
    with Writer(path, layout, device_id="finger", start_wall=1000.0) as writer:
        for i in range(0, 1000, 4):
            at = 0.01 * i
            writer.write(RecordedFrame(i, at, 5.0 + at, 1000.0 + at, raw, 8, 3 if i else 0))
    opened(page, serve(f"replay://{path}?speed=0.5"))
    expect(page.locator(".losses")).to_contain_text("frames were missing in the recording in the")


def test_losses_from_before_the_page_are_not_its_own() -> None:
    losses = Losses()
    losses.status(lost(link=500), 0, 0.0)
    said = losses.status(lost(link=501), 0, 5.0)
    assert said["text"].startswith("1 frame was lost on the way in the last 10 s.")


def test_a_device_that_counts_nothing_is_named() -> None:
    losses = Losses()
    said = losses.status(replace(NONE, dropped=None), 0, 0.0)
    assert "does not number its frames" in said["text"]


@pytest.mark.slow
def test_losses_on_the_page_move_nothing_and_can_be_read(
    serve: Serve, page: Page, still: StillFinger, layout: Layout, monkeypatch: pytest.MonkeyPatch
) -> None:
    finger = still(layout, np.full(len(layout), 20))
    opened(page, serve(finger))
    words = page.locator(".losses")
    expect(words).to_contain_text("No frame was lost")
    boxes = """() => JSON.stringify([...document.querySelectorAll(
        "h3, dl, .time, .grid, button, canvas, aside")].map((e) => e.getBoundingClientRect()))"""
    for width in (1280, 700, 390):
        page.set_viewport_size({"width": width, "height": 800})
        page.wait_for_timeout(300)
        before = json.loads(page.evaluate(boxes))
        for cause in CAUSES:
            losses = Losses()
            losses.status(NONE, 0, 0.0)
            text = losses.status(lost(**{cause: 12_345}), 0, 3.0)
            with monkeypatch.context() as patch:
                patch.setattr(Losses, "status", lambda *_, text=text: text)
                expect(words).to_have_text(text["text"].replace("\u202f", " "))
                expect(words).to_have_class("losses bad")
                assert words.evaluate("e => e.scrollHeight <= e.clientHeight"), (width, cause)
                assert json.loads(page.evaluate(boxes)) == before
