"""Panels against the boards that they have copies of, and against the figures of PCB fabs."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lumitip_fab.checks.board_read import path_of
from lumitip_fab.checks.panel_copies import measure_copper, measure_holes, measure_parts
from lumitip_fab.checks.panel_frame import (
    measure_gaps,
    measure_marks,
    measure_profile,
    measure_rails,
    measure_tooling,
)
from lumitip_fab.checks.panel_read import PanelBoard, read_panel
from lumitip_fab.checks.panel_tabs import measure_bites, measure_room, measure_tabs
from lumitip_fab.checks.result import Measure, Measurement, measured, unreadable
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError

READS = ("boards/*.kicad_pcb", "boards/*_panel/order/*.zip")
OUTLINE_MM = 0.002


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every figure of every panel."""
    for panel in design.panels:
        yield from measure_board(outputs, design, panel.name)


def measure_board(outputs: Path, design: Design, name: str) -> Iterator[Measurement]:
    """Every figure of one panel."""
    panel = next(panel for panel in design.panels if panel.name == name)
    try:
        read = read_panel(outputs, design, panel)
    except OutputError as error:
        yield unreadable("panels.readable", path_of(name), str(error))
        return
    yield from measured(MEASURES, read)
    yield from measure_profile(read, (outputs / path_of(name)).parent / "order")


def measure_size(read: PanelBoard) -> Iterator[Measurement]:
    """Its sides, within what PCB fabs assemble and as the design has them."""
    left, low, right, high = read.body.bounds
    rules, box = read.rules, read.panel.box
    for side, size, least, most in zip(
        ("width", "length"), (right - left, high - low), rules.least_mm, rules.most_mm, strict=True
    ):
        yield read.figure(side, size, least, most)
    off = np.abs(np.subtract((left, low, right, high), box.bounds_mm)).max()
    yield read.figure("outline", off, 0, OUTLINE_MM, note="from the design's")


MEASURES: tuple[Measure[PanelBoard], ...] = (
    measure_size,
    measure_copper,
    measure_parts,
    measure_holes,
    measure_tabs,
    measure_room,
    measure_bites,
    measure_gaps,
    measure_rails,
    measure_marks,
    measure_tooling,
)
