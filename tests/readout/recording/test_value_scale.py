"""Raw codes are high in the dark, values are high in the light: no reader mixes them up.

A real frame is recorded as the raw codes that a device would send, of 8 and of 12 bits. Whatever
reads the recording must find the dark centre that the definition gives for its values.
"""

import csv
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from lumitip import Fingertip
from lumitip.cli import main
from lumitip.frame import Frame
from lumitip.processing import Processor
from lumitip.recording import Reader
from lumitip.view.wire import encode

ROOT = Path(__file__).parents[3]
NAMES = ("cloth_edge", "cloth_corner", "cable")
Make = Callable[..., list[Frame]]
Record = Callable[..., Path]
Expected = tuple[Path, NDArray[np.uint8], list[float]]


@pytest.fixture(params=[(name, bits) for name in NAMES for bits in (8, 12)], ids=str)
def recorded(
    request: pytest.FixtureRequest,
    make_frames: Make,
    record: Record,
    published_frames: dict[str, dict[str, Any]],
    published_values: Callable[[str], NDArray[np.uint8]],
) -> Expected:
    """A recording of raw codes, the values that they stand for, and their dark centre (mm)."""
    name, bits = request.param
    values = published_values(name)
    full = (1 << bits) - 1
    raw = np.round(full * (1.0 - values / 255.0)).astype(np.uint8 if bits == 8 else np.uint16)
    path = record([replace(frame, raw=raw) for frame in make_frames(30, bits)])
    return path, values, published_frames[name]["dark_centre_mm"]


def test_a_replayed_frame_has_the_values_and_the_dark_centre(recorded: Expected) -> None:
    path, values, centre_mm = recorded
    with Fingertip.open(f"replay://{path}?speed=0") as tip:
        frame = tip.read(timeout=5.0)
        processor = Processor(tip.layout)
    assert frame.values == pytest.approx(values, abs=0.05)
    contact = processor(frame.values)
    assert contact.centre_mm == pytest.approx(centre_mm, abs=0.02)
    read = np.frombuffer(encode(1, 1, [frame], contact), "<f4", 20, 32)
    assert read[3:5] == pytest.approx(centre_mm, abs=0.02)


def test_the_replay_command_prints_the_dark_centre(
    recorded: Expected, capsys: pytest.CaptureFixture[str]
) -> None:
    path, _, centre_mm = recorded
    assert main(["replay", str(path), "--speed", "0"]) == 0
    printed = re.findall(r"centre +([-\d.]+) +([-\d.]+) mm", capsys.readouterr().out)
    assert len(printed) == 30
    assert np.array(printed, float) == pytest.approx(np.tile(centre_mm, (30, 1)), abs=0.02)


def test_exported_tables_keep_codes_and_values_apart(recorded: Expected, tmp_path: Path) -> None:
    path, values, _ = recorded
    assert main(["export", str(path), str(tmp_path / "table.csv")]) == 0
    with (tmp_path / "table.csv").open(encoding="utf-8") as file:
        row = next(csv.DictReader(file))
    read = [float(row[f"value_{cell}"]) for cell in range(32)]
    assert read == pytest.approx(values.astype(float), abs=0.05)
    codes = np.array([float(row[f"raw_{cell}"]) for cell in range(32)])
    assert np.corrcoef(codes, values)[0, 1] == pytest.approx(-1.0, abs=1e-4)


def test_the_batch_of_a_recording_is_on_the_values(recorded: Expected) -> None:
    path, _, centre_mm = recorded
    reader = Reader(path)
    values = np.stack([reader.metadata.values(frame) for frame in reader])
    batch = Processor(reader.layout).batch(values)
    assert batch.centres_mm == pytest.approx(np.tile(centre_mm, (30, 1)), abs=0.02)
