"""A layout as the published sensor's, wired in order."""

from collections.abc import Callable

import numpy as np
import pytest

from lumitip import Layout, Optics
from lumitip.grid import hexagonal_grid, hexagonal_neighbours

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


@pytest.fixture(scope="session")
def make_layout() -> Callable[..., Layout]:
    """`make_layout((4, 5, 6, 5), 5.0)`: a layout of that grid, wired in order."""
    return _layout


@pytest.fixture
def layout() -> Layout:
    """The published grid, wired in order."""
    return _layout()
