"""A layout as the published sensor's, wired in order."""

import json
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from lumitip import Layout, Optics
from lumitip.grid import hexagonal_grid, hexagonal_neighbours

PUBLISHED_FRAMES = Path(__file__).with_name("published_frames.json")
OPTICS = Optics(
    hole_mm=2.5,
    hole_shape="hexagon",
    emitter_depth_mm=0.9,
    detector_depth_mm=0.9,
    emitter_exponent=1.0,
    detector_exponent=2.0,
    silicone_index=1.41,
    film_mm=0.1,
    pull_up_ohm=75e3,
    supply_v=3.3,
)


def _layout(columns: tuple[int, ...] = (5, 4, 5, 4, 5, 4, 5), pitch_mm: float = 6.0) -> Layout:
    grid = hexagonal_grid(columns, pitch_mm)
    index = np.arange(grid.x_mm.size)
    return Layout(
        x_mm=grid.x_mm,
        y_mm=grid.y_mm,
        column=grid.column,
        row=grid.row,
        neighbours=hexagonal_neighbours(columns),
        mux=index // 8,
        channel=index % 8,
        adc_pin=np.array([f"A{i}" for i in index // 8]),
        pitch_mm=pitch_mm,
        optics=OPTICS,
    )


@pytest.fixture(autouse=True)
def _own_user_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "user"))


@pytest.fixture(scope="session")
def make_layout() -> Callable[..., Layout]:
    """`make_layout((4, 5, 6, 5), 5.0)`: a layout of that grid, wired in order."""
    return _layout


@pytest.fixture
def layout() -> Layout:
    """The published grid, wired in order."""
    return _layout()


@pytest.fixture(scope="session")
def published_frames() -> dict[str, dict[str, Any]]:
    """The real frames of the publication by name, with what is known of each."""
    frames: dict[str, dict[str, Any]] = json.loads(PUBLISHED_FRAMES.read_text("utf-8"))["frames"]
    return frames


@pytest.fixture(scope="session")
def published_values(
    published_frames: dict[str, dict[str, Any]],
) -> Callable[[str], NDArray[np.uint8]]:
    """`published_values("cable")`: values of a real frame in cell order, shape `(32,)`."""

    def values(name: str) -> NDArray[np.uint8]:
        return np.concatenate(published_frames[name]["columns"]).astype(np.uint8)

    return values


@pytest.fixture
def hangups() -> Iterator[None]:
    """Programs that are started get SIGHUP, also where the tests run under `nohup`."""
    before = signal.signal(signal.SIGHUP, signal.SIG_DFL)
    yield
    signal.signal(signal.SIGHUP, before)
