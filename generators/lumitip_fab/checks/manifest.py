"""`manifest.json` against the files it lists: their bytes, and the frames it says they are in."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lumitip_fab import manifest
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.checks.stl import corners_mm
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError
from lumitip_fab.frames import Matrix, applied

READS = ("*",)
_FILE = "manifest.json"
_PLACE_MM = 0.05


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Count files that are missing or changed; move every STL by its matrix and see it in place."""
    told = manifest.read(outputs)
    if not told.files:
        yield unreadable("manifest.files", _FILE, "missing, or not of this version: build again")
        yield unreadable("manifest.frames", _FILE, "lists no file")
        return
    changed = [p for p, e in told.files.items() if manifest.sha256_of(outputs / p) != e.sha256]
    note = ", ".join(changed[:3]) or f"of {len(told.files)}"
    yield Measurement("manifest.files", _FILE, len(changed), 0, 0, "missing or changed", note)
    for path, entry in sorted(told.files.items()):
        if path.endswith(".stl"):
            yield _frame(outputs, path, np.array(entry.to_sensor), design)


def _frame(outputs: Path, path: str, matrix: Matrix, design: Design) -> Measurement:
    """How far a part, moved by its matrix, lies from where the sensor frame has it."""
    name = f"{_FILE}: {path}"
    try:
        corners = applied(matrix, corners_mm(outputs / path))
    except OutputError as error:
        return unreadable("manifest.frames", name, str(error))
    low, high = corners.min(axis=0), corners.max(axis=0)
    if path.startswith("fit/"):  # a part of no finger: its frame is the bed's
        off = float(np.abs(matrix - np.eye(4)).max())
        return Measurement("manifest.frames", name, off, 0, _PLACE_MM, "mm", "from the bed's frame")
    stack, tip_y = design.stack, design.outline.tip_y_mm
    apart = [abs(low[0] + high[0])]
    if path.startswith("backing/"):
        apart += [abs(high[1] - tip_y), abs(high[2] - stack.rim_z_mm)]
    else:  # a mould lies under the skin, its floor `wall_mm` thick, and reaches round the tip
        apart += [abs(high[2] - (stack.silicone_z_mm + design.mould.wall_mm)),
                  max(tip_y - high[1], 0.0)]  # fmt: skip
    turn = matrix[:3, :3]
    apart.append(float(np.abs(turn @ turn.T - np.eye(3)).max()) + abs(np.linalg.det(turn) - 1))
    return Measurement("manifest.frames", name, float(max(apart)), 0, _PLACE_MM, "mm",
                       "after its matrix, from its place in the sensor frame")  # fmt: skip
