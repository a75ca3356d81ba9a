"""`layout.json` against the readout's own cell map, neighbours and wiring."""

import math
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

import numpy as np

from lumitip.errors import LayoutError
from lumitip.grid import hexagonal_grid, hexagonal_neighbours
from lumitip.layout import Layout
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.design import Design

READS = ("layout.json",)
_FILE = "layout.json"
_NAMES = ("layout.cells", "layout.order", "layout.neighbours", "layout.wiring", "layout.facing",
          "layout.optics")  # fmt: skip


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Hold `layout.json` against the grid, the design's hash and the two fingers."""
    try:
        layout = Layout.load(outputs / _FILE)
    except LayoutError as error:
        yield from (unreadable(name, _FILE, str(error)) for name in (*_NAMES, "layout.hash"))
        return
    same_hash = layout.design_hash == design.layout.design_hash
    yield Measurement("layout.hash", _FILE, float(same_hash), 1, 1, note="equals design.json's")
    grid = hexagonal_grid(design.grid.columns, design.grid.pitch_mm)
    if len(layout) != grid.x_mm.size:
        reason = f"{len(layout)} cells, the grid has {grid.x_mm.size}"
        yield from (unreadable(name, _FILE, reason) for name in _NAMES)
        return
    apart = np.hypot(layout.x_mm - grid.x_mm, layout.y_mm - grid.y_mm).max()
    yield Measurement("layout.cells", _FILE, float(apart), 0, 1e-5, "mm", "worst cell centre")
    misplaced = (layout.column != grid.column) | (layout.row != grid.row)
    yield Measurement("layout.order", _FILE, float(misplaced.sum()), 0, 0, "cells", "column, row")
    wanted = set(map(tuple, hexagonal_neighbours(design.grid.columns).tolist()))
    found = set(map(tuple, layout.neighbours.tolist()))
    yield Measurement("layout.neighbours", _FILE, float(len(wanted ^ found)), 0, 0, "pairs",
                      f"of {len(wanted)} that differ")  # fmt: skip
    yield _optics(layout, design)
    yield _wiring(layout, design)
    yield _facing(layout, design)


def _optics(layout: Layout, design: Design) -> Measurement:
    """What the twin and the estimator reckon with: pitch, holes, depths, circuit."""
    told = {**asdict(layout.optics), "pitch_mm": layout.pitch_mm}
    wanted = {**asdict(design.layout.optics), "pitch_mm": design.grid.pitch_mm}
    wrong = [name for name, value in wanted.items() if not _same(told[name], value)]
    note = f"that differ: {', '.join(wrong) or 'none'}"
    return Measurement("layout.optics", _FILE, float(len(wrong)), 0, 0, "figures", note)


def _same(told: object, wanted: object) -> bool:
    if isinstance(told, float) and isinstance(wanted, float):
        return math.isclose(told, wanted, abs_tol=1e-5)
    return told == wanted


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
    return Measurement("layout.facing", _FILE, float(worst), 0, 1e-5, "mm", "LED to detector")
