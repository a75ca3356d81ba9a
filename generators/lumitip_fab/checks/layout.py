"""`layout.json` against cells and neighbours worked out anew, and against the wiring."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from itertools import pairwise
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from lumitip.errors import LayoutError
from lumitip.layout import Layout
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.design import Design

READS = ("layout.json",)
_NEAR = 1e-5  # mm
_FILE = "layout.json"
_NAMES = (
    "layout.cells",
    "layout.order",
    "layout.neighbours",
    "layout.wiring",
    "layout.facing",
    "layout.optics",
)


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Hold `layout.json` against the grid, the design's hash and the two fingers."""
    try:
        layout = Layout.load(outputs / _FILE)
    except LayoutError as error:
        yield from (unreadable(name, _FILE, str(error)) for name in (*_NAMES, "layout.hash"))
        return
    same_hash = layout.design_hash == design.layout.design_hash
    yield Measurement("layout.hash", _FILE, float(same_hash), 1, 1, note="equals design.json's")
    cells = _cells(design.grid.columns, design.grid.pitch_mm)
    if len(layout) != len(cells):
        reason = f"{len(layout)} cells, the grid has {len(cells)}"
        yield from (unreadable(name, _FILE, reason) for name in _NAMES)
        return
    column, row, x_mm, y_mm = np.array(cells).T
    apart = np.hypot(layout.x_mm - x_mm, layout.y_mm - y_mm).max()
    yield Measurement("layout.cells", _FILE, float(apart), 0, _NEAR, "mm", "worst cell centre")
    misplaced = (layout.column != column) | (layout.row != row)
    yield Measurement("layout.order", _FILE, float(misplaced.sum()), 0, 0, "cells", "column, row")
    # Cells of a hexagonal lattice are one pitch apart, or 1.73 pitches and more.
    near = cKDTree(np.stack([x_mm, y_mm], axis=1)).query_pairs(1.3 * design.grid.pitch_mm)
    found = set(map(tuple, layout.neighbours.tolist()))
    note = f"of {len(near)} that differ"
    yield Measurement("layout.neighbours", _FILE, float(len(near ^ found)), 0, 0, "pairs", note)
    yield _optics(layout, design)
    yield _wiring(layout, design)
    yield _facing(layout, design)


def _cells(columns: Sequence[int], pitch_mm: float) -> list[tuple[int, int, float, float]]:
    """Column, row, x and y of each cell.

    From one column to the next the lattice moves by half a pitch. Centred columns move so by
    themselves where one length is odd and the other even; otherwise they are a quarter of the pitch
    off, to opposite sides.
    """
    alike = [(a - b) % 2 == 0 for a, b in pairwise(columns)]
    side = 1.0 if any(alike) else 0.0
    middle = sum(c * n for c, n in enumerate(columns)) / sum(columns)
    cells = []
    for column, count in enumerate(columns):
        side = -side if column and alike[column - 1] else side
        top_mm = ((count - 1) / 2.0 + side / 4.0) * pitch_mm
        x_mm = (column - middle) * pitch_mm * math.sin(math.pi / 3.0)
        cells += [(column, row, x_mm, top_mm - row * pitch_mm) for row in range(count)]
    return cells


def _optics(layout: Layout, design: Design) -> Measurement:
    """Figures of the twin and the estimator: pitch, holes, depths, circuit."""
    optics = {**asdict(layout.optics), "pitch_mm": layout.pitch_mm}
    wanted = {**asdict(design.layout.optics), "pitch_mm": design.grid.pitch_mm}
    wrong = [name for name, value in wanted.items() if not _same(optics[name], value)]
    drawn = np.array(design.mask.holes_mm)
    if drawn.shape != layout.hole_mm.shape or np.abs(layout.hole_mm - drawn).max() > _NEAR:
        wrong.append("hole_mm of single cells")
    note = f"that differ: {', '.join(wrong) or 'none'}"
    return Measurement("layout.optics", _FILE, float(len(wrong)), 0, 0, "figures", note)


def _same(found: object, wanted: object) -> bool:
    if isinstance(found, float) and isinstance(wanted, float):
        return math.isclose(found, wanted, abs_tol=_NEAR)
    return found == wanted


def _wiring(layout: Layout, design: Design) -> Measurement:
    """Every detector on an input of its own, every multiplexer on a pin of its own."""
    inputs = set(zip(layout.mux.tolist(), layout.channel.tolist(), strict=True))
    pins = set(zip(layout.mux.tolist(), layout.adc_pin.tolist(), strict=True))
    wanted = set(enumerate(design.wiring.adc_pins))
    reachable = 2 ** len(design.wiring.select_pins)
    faults = len(layout) - len(inputs) + len(pins ^ wanted)
    faults += int((layout.channel >= reachable).sum())
    note = f"{len(layout)} cells on {len(pins)} multiplexers"
    return Measurement("layout.wiring", _FILE, float(faults), 0, 0, "faults", note)


def _facing(layout: Layout, design: Design) -> Measurement:
    """Detector i at cell i; LED i at (-x_i, y_i) of the emitter's own frame."""
    cells = np.stack([layout.x_mm, layout.y_mm], axis=1)
    seen = np.array(design.receiver.cells)
    shone = np.array(design.emitter.cells) * (-1.0, 1.0)
    if not seen.shape == shone.shape == cells.shape:
        return unreadable("layout.facing", _FILE, "the fingers have another number of cells")
    worst = max(np.abs(seen - cells).max(), np.abs(shone - cells).max())
    return Measurement("layout.facing", _FILE, float(worst), 0, _NEAR, "mm", "LED to detector")
