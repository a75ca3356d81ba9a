"""Frames as a device gives them, and recordings of them."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lumitip import Layout
from lumitip.calibration import Calibration
from lumitip.frame import Frame
from lumitip.recording import Writer

START = 1_790_000_000.0
RATE_HZ = 55.0


def frames(count: int, bits: int = 8, legacy: bool = False, cells: int = 32) -> list[Frame]:
    """Frames of random codes at 55 Hz; every tenth had one lost before it, unless they are legacy
    ones, which are numbered as they arrive."""
    chance = np.random.default_rng(bits)
    made, seq = [], 0
    for i in range(count):
        lost = 1 if i % 10 == 9 and not legacy else 0
        seq += 1 + lost
        at = i / RATE_HZ
        raw = chance.integers(0, 1 << bits, cells).astype(np.uint8 if bits == 8 else np.uint16)
        made.append(
            Frame(
                seq=seq,
                t_device=None if legacy else 3.0 + at,
                t_host=100.0 + at,
                t=100.0 + at,
                t_wall=START + at,
                raw=raw,
                bits=bits,
                values=np.zeros(cells, np.float32),
                dropped_before=None if legacy else lost,
                device_id="C0:FF:EE",
            )
        )
    return made


@pytest.fixture
def make_frames() -> Callable[..., list[Frame]]:
    """`make_frames(count, bits=8, legacy=False, cells=32)`."""
    return frames


@pytest.fixture
def calibration(layout: Layout) -> Calibration:
    """One with both references."""
    empty = np.linspace(200.0, 250.0, 32).astype(np.float32)
    dark = np.linspace(0.0, 10.0, 32).astype(np.float32)
    return Calibration("C0:FF:EE", layout.design_hash, empty, dark)


@pytest.fixture
def record(tmp_path: Path, layout: Layout) -> Callable[..., Path]:
    """`record(frames, name="run.mcap", calibration=None)`: a whole recording of them."""

    def write(
        given: list[Frame], name: str = "run.mcap", calibration: Calibration | None = None
    ) -> Path:
        path = tmp_path / name
        with Writer(
            path, layout, device_id="C0:FF:EE", calibration=calibration, start_wall=START
        ) as writer:
            for frame in given:
                writer.write(frame)
        return path

    return write
