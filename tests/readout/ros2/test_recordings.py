"""Recordings that a node plays: from their first frame, whole at speed 0, with newer stamps."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lumitip.recording import Reader
from ros_pace import delay, diagnosed, recorded, wait_until

Make = Callable[..., Any]


@pytest.mark.slow
@pytest.mark.parametrize("speed", ["", "?speed=0", "?speed=1"])
def test_a_recording_plays_from_its_first_frame_once_the_node_is_active(
    make_node: Make, tmp_path: Path, speed: str
) -> None:
    path = recorded(tmp_path / "run.mcap", 40)
    node = make_node(url=f"replay://{path}{speed}")
    node.on_configure(None)
    time.sleep(0.3)
    assert diagnosed(node)[:2] == (b"\0", "the recording begins once the node is active")
    assert not node.failure, "it does not play yet"
    node.on_activate(None)

    def skipped() -> int:
        return int(diagnosed(node)[2]["not published"])

    wait_until(lambda: node.failure and len(node.published["~/estimate"]) == 40 - skipped())
    node.on_deactivate(None)
    assert len(node.published["~/values"]) == 40 - skipped()
    assert skipped() < (1 if "speed=0" in speed else 10), "a busy computer may be behind"


def slow_node(make_node: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """An active node that is slower than a recording of 30 frames at speed 0."""
    node = make_node(url=f"replay://{recorded(tmp_path / 'a.mcap', 30)}?speed=0", estimate=False)
    node.on_configure(None)
    delay(node, monkeypatch, 0.02)
    node.on_activate(None)
    return node


def test_a_slow_node_publishes_every_frame_of_a_recording_at_speed_0(
    make_node: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = slow_node(make_node, tmp_path, monkeypatch)
    wait_until(lambda: len(node.published["~/values"]) == 30)
    assert diagnosed(node)[2]["not published"] == "0"


def test_a_recording_that_begins_anew_has_newer_stamps(make_node: Make, tmp_path: Path) -> None:
    """tf2 ignores what is older than the last transform."""

    def stamps_s(url: str) -> list[float]:
        node = make_node(url=url, estimate=False)
        node.on_configure(None)
        node.on_activate(None)
        published = node.published["~/values"]
        wait_until(lambda: len(published) + node._published.skipped == 10)
        node.on_cleanup(None)
        stamps = [m.header.stamp for m in published]
        return [stamp.sec + stamp.nanosec * 1e-9 for stamp in stamps]

    path = recorded(tmp_path / "run.mcap", 10)
    began_s = time.time()
    first, again = stamps_s(f"replay://{path}"), stamps_s(f"replay://{path}?speed=2")
    assert began_s < first[0] and first[-1] < again[0] and again[-1] < time.time()
    assert first == sorted(first) and again == sorted(again)
    kept = [frame.t_wall for frame in Reader(path)]
    assert stamps_s(f"replay://{path}?speed=0") == pytest.approx(kept, abs=1e-6)


@pytest.mark.slow
def test_diagnostics_take_no_frame_from_a_recording_that_waits(
    make_node: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = slow_node(make_node, tmp_path, monkeypatch)
    wait_until(lambda: len(node.published["~/values"]) >= 2)
    node.on_deactivate(None)
    for _ in range(30):
        assert diagnosed(node)[:2] == (b"\0", "the node is not active")
        time.sleep(0.01)
    assert not node.failure, "it does not play on"
    node.on_activate(None)
    wait_until(lambda: node.failure and len(node.published["~/values"]) > 25)  # of 30
