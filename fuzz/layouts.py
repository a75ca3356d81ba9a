"""Texts of `layout.json`."""

from functools import cache

import numpy as np

from lumitip import Layout, Optics
from lumitip.grid import hexagonal_grid, hexagonal_neighbours


@cache
def layouts() -> tuple[bytes, ...]:
    """Texts of `layout.json`."""
    optics = Optics(2.5, "hexagon", 0.9, 0.9, 1.0, 2.0, 1.41, 0.1, 75e3, 3.3)
    made = []
    for columns in ((2, 1), (2, 3, 2)):
        grid = hexagonal_grid(columns, 6.0)
        index = np.arange(grid.x_mm.size)
        pins = np.array([f"A{i}" for i in index // 4])
        pairs = hexagonal_neighbours(columns)
        layout = Layout(
            grid.x_mm,
            grid.y_mm,
            grid.column,
            grid.row,
            pairs,
            index // 4,
            index % 4,
            pins,
            6.0,
            optics,
        )
        made.append(layout.to_json().encode())
    return tuple(made)


def read_layout(data: bytes) -> None:
    """Read a layout; what is accepted is written and read again as the same."""
    layout = Layout.from_json(data.decode(errors="surrogateescape"))
    assert Layout.from_json(layout.to_json()) == layout
