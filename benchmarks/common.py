"""Shared by the benchmarks: goals, layouts and designs with any number of cells, one core.

goals = Goals()
goals.at_most("slowest shape", 76.0, 100.0, "µs a frame")
sys.exit(goals.exit_code())
"""

import math
import os
import shutil
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from lumitip.grid import hexagonal_grid, hexagonal_neighbours
from lumitip.layout import Layout, Optics

PUBLISHED = (5, 4, 5, 4, 5, 4, 5)
"""Columns of the published sensor."""
_FILE = """\
extends = "published.toml"
name = "bench {cells}"

[grid]
columns = {columns}
pitch_mm = 2.5

[emitter]
led = "bench 0402"
current_ma = 5.0
max_heat_w = 20.0
resistor_side = "front"

[board]
copper_gap_mm = 0.15

[receiver]
photodetector = "bench 0402"
multiplexer = "bench 64 to 1"

[controller]
board = "bench"

[supply]
max_ma = 5000

[flange]
enabled = false

[mask]
hole_mm = 1.2

[printer]
profile = "bench"
"""


@dataclass
class Goals:
    """Measured figures and their goals."""

    _rows: list[tuple[str, str, bool]] = field(default_factory=list)

    def at_most(self, name: str, figure: float, most: float, unit: str = "") -> None:
        """Compare a figure with its largest allowed value; NaN misses the goal."""
        self._hold(name, figure, most, unit, "at most", figure <= most)

    def at_least(self, name: str, figure: float, least: float, unit: str = "") -> None:
        """Compare a figure with its smallest allowed value; NaN misses the goal."""
        self._hold(name, figure, least, unit, "at least", figure >= least)

    def not_measured(self, name: str, why: str) -> None:
        """Record a goal that could not be measured, as missed."""
        self._rows.append((name, why, False))

    def exit_code(self) -> int:
        """Print every goal; the exit code: 0 if all were met."""
        print()
        for name, against, met in self._rows:
            print(f"{'met' if met else 'MISSED':<8}{name}: {against}", flush=True)
        return 0 if all(met for *_, met in self._rows) else 1

    def _hold(self, name: str, figure: float, limit: float, unit: str, how: str, met: bool) -> None:
        against = f"{figure:,.4g} {unit}".strip() if figure < 1e4 else f"{figure:,.0f} {unit}"
        self._rows.append((name, f"{against} (goal: {how} {limit:,g})", met))


def columns_for(cells: int) -> list[int]:
    """Alternating columns of nearly this many cells in all, about as wide as long."""
    count = max(round(math.sqrt(cells * 2 / math.sqrt(3))), 3)
    high = max(round(cells / count + 0.5), 2)
    return [high - i % 2 for i in range(count)]


def write_design(cells: int, published: Path, folder: Path) -> Path:
    """Write a parameter file for about this many cells; returns its path."""
    shutil.copytree(Path(__file__).parent / "parts", folder / "parts", dirs_exist_ok=True)
    (folder / "published.toml").write_bytes(published.read_bytes())
    columns = columns_for(cells)
    file = folder / f"bench_{cells}.toml"
    file.write_text(_FILE.format(cells=cells, columns=columns), encoding="utf-8")
    return file


def layout_of(columns: Sequence[int], pitch_mm: float, optics: Optics | None = None) -> Layout:
    """A hexagonal layout with arbitrary wiring."""
    grid = hexagonal_grid(columns, pitch_mm)
    index = np.arange(grid.x_mm.size)
    return Layout(
        grid.x_mm,
        grid.y_mm,
        grid.column,
        grid.row,
        hexagonal_neighbours(columns),
        index // 8,
        index % 8,
        np.array([f"A{i}" for i in index // 8]),
        pitch_mm,
        optics or Optics(2.5, "hexagon", 0.9, 0.9, 1.0, 2.0, 1.41, 0.1, 75e3, 3.3),
    )


def on_one_core() -> None:
    """Keep this process on one core, with one thread in each library.

    Libraries read these variables when they load, so the process may restart itself. Their idle
    threads would slow down the measured code.
    """
    single = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    if not single.items() <= os.environ.items():
        os.execve(sys.executable, [sys.executable, *sys.argv], {**os.environ, **single})
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
