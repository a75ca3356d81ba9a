"""Nodes that are slowed down, asked how they are, and fed from a recording."""

import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from lumitip import Fingertip
from lumitip.recording import Writer


def delay(node: Any, monkeypatch: pytest.MonkeyPatch, work_s: float) -> None:
    track = node._track

    def slowly(values: Any) -> Any:
        time.sleep(work_s)
        return track(values)

    monkeypatch.setattr(node, "_track", slowly)


def diagnosed(node: Any) -> tuple[bytes, str, dict[str, str]]:
    """Level, text and figures."""
    node.diagnose()
    (status,) = node.published["/diagnostics"][-1].status
    return status.level, status.message, {pair.key: pair.value for pair in status.values}


def wait_until(true: Callable[[], Any]) -> None:
    until = time.monotonic() + 20.0
    while not true():
        assert time.monotonic() < until
        time.sleep(0.01)


def alive() -> list[str]:
    return [t.name for t in threading.enumerate() if t.name == "lumitip-publisher"]


def recorded(path: Path, number: int, gap_s: float = 0.0) -> Path:
    """A recording of so many frames, 20 ms apart; the last one comes later by `gap_s`."""
    with Fingertip.open("twin://cable") as tip, Writer(path, tip.layout, device_id="x") as writer:
        frame = tip.read(timeout=5.0)
        for seq in range(number):
            later_s = seq * 0.02 + (gap_s if seq == number - 1 else 0.0)
            t, t_wall = frame.t + later_s, frame.t_wall + later_s
            writer.write(replace(frame, seq=seq, t=t, t_wall=t_wall))
    return path
