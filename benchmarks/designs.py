"""Designs with any number of cells, for measuring growth."""

import math
import shutil
from pathlib import Path

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
