"""Age of what the node publishes, frames that it skips, and its diagnostics of both."""

import statistics
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ros_pace import alive, delay, diagnosed, recorded, wait_until

Make = Callable[..., Any]


@pytest.fixture
def slow(make_node: Make, monkeypatch: pytest.MonkeyPatch) -> Any:
    """An active node that needs 12 ms for each frame; one comes every 5 ms."""
    node = make_node(url="twin://disc?rate=200", estimate=False)
    node.on_configure(None)
    delay(node, monkeypatch, 0.012)
    node.on_activate(None)
    return node


def newest_age_s(node: Any) -> float:
    stamp = node.published["~/values"][-1].header.stamp
    return time.time() - stamp.sec - stamp.nanosec * 1e-9


@pytest.mark.slow
def test_a_node_that_is_too_slow_publishes_the_newest_frames(slow: Any) -> None:
    time.sleep(0.3)
    ages_s = []
    until = time.monotonic() + 2.0
    while time.monotonic() < until:
        ages_s.append(newest_age_s(slow))
        time.sleep(0.02)
    # A node that worked on all frames would be 0.7 s late in the middle. Single ages depend on what
    # else the computer does.
    assert statistics.median(ages_s) < 0.2
    slow.on_deactivate(None)
    _, _, figures = diagnosed(slow)
    assert int(figures["published"]) == len(slow.published["~/values"])
    assert int(figures["not published"]) > int(figures["published"]) / 2
    assert figures["not read in time"] == figures["lost"] == "0"


def test_nothing_is_skipped_by_a_node_that_is_fast_enough(make_node: Make) -> None:
    node = make_node(url="twin://disc?rate=50", estimate=False)
    node.on_configure(None)
    node.on_activate(None)
    wait_until(lambda: len(node.published["~/values"]) > 20)
    _, _, figures = diagnosed(node)
    assert int(figures["published"]) > 10 and int(figures["not published"]) < 3
    assert float(figures["age of the last published (s)"]) < 0.5


def test_frames_that_arrive_together_are_all_worked_on(
    ros: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys.modules[ros.Pace.__module__], "BEHIND_S", 5.0)  # of a busy computer
    done = []
    published = ros.Published()
    pace = ros.Pace(lambda frame, _: done.append(frame), False, published)
    for number in range(200):
        pace.put(number)
    wait_until(lambda: len(done) == 200)
    pace.stop()
    assert done == list(range(200)) and published.skipped == 0


def test_few_frames_wait_for_work_that_hangs(ros: Any) -> None:
    free, begun, done = threading.Event(), threading.Event(), []
    published = ros.Published()

    def work(frame: Any, _: float) -> None:
        begun.set()
        free.wait(10.0)
        done.append(frame)

    pace = ros.Pace(work, False, published)
    pace.put(0)
    assert begun.wait(5.0)
    for number in range(1, 30):
        pace.put(number)
        time.sleep(0.005)
    assert len(pace._waiting) == 1
    free.set()
    wait_until(lambda: len(done) == 2)
    pace.stop()
    assert done == [0, 29] and published.skipped == 28


@pytest.mark.parametrize("every", [True, False])
def test_nothing_is_worked_on_and_nothing_waits_after_the_end(ros: Any, every: bool) -> None:
    free, begun, done = threading.Event(), threading.Event(), []

    def work(frame: Any, _: float) -> None:
        begun.set()
        free.wait(10.0)
        done.append(frame)

    pace = ros.Pace(work, every, ros.Published())
    pace.put(0)
    assert begun.wait(5.0)
    pace.put(1)
    putting = threading.Thread(target=pace.put, args=(2,), daemon=True)
    putting.start()  # waits for room where every frame counts
    ending = threading.Thread(target=pace.stop, daemon=True)
    ending.start()
    putting.join(5.0)
    assert not putting.is_alive() and ending.is_alive(), "it waits for the frame in work"
    free.set()
    ending.join(5.0)
    assert not ending.is_alive() and not alive()
    pace.put(3)
    pace.stop()
    assert done == [0] and not pace._waiting


def test_diagnostics_see_a_node_that_hangs(
    make_node: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = make_node(url="twin://disc?rate=200", estimate=False, stale_s=0.2)
    node.on_configure(None)
    delay(node, monkeypatch, 0.6)
    node.on_activate(None)
    time.sleep(0.4)
    level, text, figures = diagnosed(node)
    assert level == b"\1" and text.startswith("no frame was published in 0.")
    assert figures["published"] == "0"
    time.sleep(0.7)
    level, text, _ = diagnosed(node)
    assert level == b"\1" and text.startswith("the last published frame is ")
    assert "wait_latest" not in text and "estimate: false" in text


def test_diagnostics_see_a_source_that_stalls(make_node: Make, tmp_path: Path) -> None:
    path = recorded(tmp_path / "run.mcap", 3, gap_s=60.0)
    node = make_node(url=f"replay://{path}", estimate=False, stale_s=0.2)
    node.on_configure(None)
    node.on_activate(None)
    wait_until(lambda: len(node.published["~/values"]) == 2)  # the third is a minute later
    time.sleep(0.3)
    level, text, _ = diagnosed(node)
    assert level == b"\1" and "sends nothing" in text
    assert node.on_cleanup(None) and not alive()


def test_an_untared_finger_is_a_warning_until_it_is_tared(make_node: Make) -> None:
    node = make_node(url="twin://empty", estimate=False, stale_s=5.0)
    node.on_configure(None)
    node.on_activate(None)
    wait_until(lambda: node.published["~/values"])
    level, text, _ = diagnosed(node)
    assert level == b"\1" and "not tared: call ~/tare with nothing between the fingers" in text
    assert node.services["~/tare"]().success
    assert diagnosed(node)[:2] == (b"\0", "frames arrive")
    again = make_node(url="twin://empty", estimate=False, stale_s=5.0)
    again.on_configure(None)
    again.on_activate(None)
    wait_until(lambda: again.published["~/values"])
    assert diagnosed(again)[:2] == (b"\0", "frames arrive"), "the stored tare is used"


@pytest.mark.slow
def test_deactivating_ends_the_thread_also_of_a_recording_that_waits(
    slow: Any, make_node: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert len(alive()) == 1
    slow.on_deactivate(None)
    assert not alive()
    node = make_node(url=f"replay://{recorded(tmp_path / 'a.mcap', 30)}?speed=0", estimate=False)
    node.on_configure(None)
    delay(node, monkeypatch, 0.05)
    node.on_activate(None)
    wait_until(lambda: len(node.published["~/values"]) >= 2)
    node.on_deactivate(None)
    count = len(node.published["~/values"])
    assert not alive() and count < 30
    node.on_activate(None)
    wait_until(lambda: node.failure and len(node.published["~/values"]) > 25)  # of 30
    node.on_cleanup(None)
    assert not alive()
