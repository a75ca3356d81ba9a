"""README's animation: the script that draws it writes the same bytes each time."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

ROOT = Path(__file__).parents[2]
SCRIPT = ROOT / "docs/cable_animation.py"
COMMITTED = ROOT / "docs/images/cable.webp"
MOST_BYTES, MOST_DIFFERENCE = 600_000, 2.0


def _draw(file: Path) -> bytes:
    subprocess.run([sys.executable, SCRIPT, file], check=True, timeout=120)
    return file.read_bytes()


def _pictures(file: Path) -> np.ndarray:
    """All frames, shape `(frames, height, width, 3)`."""
    with Image.open(file) as animation:
        frames = []
        for number in range(animation.n_frames):
            animation.seek(number)
            frames.append(np.asarray(animation.convert("RGB"), np.float32))
    return np.stack(frames)


@pytest.mark.slow
def test_the_same_code_draws_the_same_bytes_and_the_committed_animation(tmp_path: Path) -> None:
    first, second = tmp_path / "first.webp", tmp_path / "second.webp"
    assert _draw(first) == _draw(second)
    drawn, committed = _pictures(first), _pictures(COMMITTED)
    assert drawn.shape == committed.shape
    assert np.abs(drawn - committed).mean() < MOST_DIFFERENCE
    assert np.abs(drawn - committed[::-1]).mean() > MOST_DIFFERENCE, "another order is noticed"


def test_the_animation_moves_and_is_small() -> None:
    pictures = _pictures(COMMITTED)
    assert len(pictures) == 48
    assert np.abs(np.diff(pictures, axis=0)).mean(axis=(1, 2, 3)).min() > 0.1
    assert COMMITTED.stat().st_size < MOST_BYTES
