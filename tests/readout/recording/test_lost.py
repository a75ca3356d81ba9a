"""Frames that never reached a recording: how many, or that nobody knows."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from lumitip.cli import main
from lumitip.frame import Frame
from lumitip.recording import Reader, summarise

Make = Callable[..., list[Frame]]
Record = Callable[..., Path]


def test_frames_that_the_program_missed_are_lost_too(
    make_frames: Make, record: Record, capsys: pytest.CaptureFixture[str]
) -> None:
    sent = make_frames(100)
    path = record([*sent[:40], *sent[60:]])
    assert summarise(path).lost == 30
    rows = [frame.dropped_before for frame in Reader(path)]
    assert rows[40] == 22 and sum(n or 0 for n in rows) == 30
    assert info_of(path, capsys) == "30"


def test_nobody_knows_what_the_published_firmware_lost(
    make_frames: Make, record: Record, capsys: pytest.CaptureFixture[str]
) -> None:
    unnumbered = [replace(f, seq=i) for i, f in enumerate(make_frames(50, legacy=True))]
    path = record(unnumbered)
    found = summarise(path)
    assert (found.lost, found.lost_known) == (0, False)
    assert info_of(path, capsys) == "unknown"
    path = record([*unnumbered[:20], *unnumbered[25:]], name="gap.mcap")
    assert info_of(path, capsys) == "at least 5"


def info_of(path: Path, capsys: pytest.CaptureFixture[str]) -> str:
    """What `lumitip info` prints of lost frames."""
    main(["info", str(path)])
    lines = dict(line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines())
    return lines["lost"]
