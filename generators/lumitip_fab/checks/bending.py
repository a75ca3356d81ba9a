"""Bend radius of the fingers' cables over the stroke, from the written list of wires.

A chain of stiff links with springs between them is put between both ties, and its bending energy is
made least for several places of the finger. Its ends lie along the tool axis, one along the gripper
as far as the wiring says, the other in line with it where the gripper is closed.
"""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from scipy.optimize import minimize

from lumitip_fab.checks.cables import read_list
from lumitip_fab.checks.readers.kicad_board import read_board
from lumitip_fab.checks.readers.solids import Vectors
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.checks.wire_ways import reach_mm, run_mm
from lumitip_fab.design import Design
from lumitip_fab.design.cabling import outer_mm
from lumitip_fab.errors import OutputError

READS = ("wiring/cables.csv", "boards/*.kicad_pcb")
LINKS = 24
PLACES = (0.0, 0.2, 0.6, 1.0)  # of the finger's travel
AGREE = 0.03  # of the figure in the design: links are short, not endless
MARGIN = 0.97  # of the least radius, for the same reason
_FINGERS = ("emitter", "receiver")
_LIST = "wiring/cables.csv"


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """The smallest radius of each cable that moves with a finger."""
    try:
        rows = read_list(outputs / _LIST)
        ends = [b.name for b in design.auxiliary_boards if b.name == "breakout"]
        boards = {b: read_board(outputs / f"boards/{b}/{b}.kicad_pcb") for b in (*_FINGERS, *ends)}
    except OutputError as error:
        yield unreadable("bending.readable", _LIST, str(error))
        return
    figures = {loop.cable: loop.radius_mm for loop in design.cabling.loops}
    cables = {row.cable: row for row in rows if row.start[0] in _FINGERS}
    yield Measurement("bending.readable", _LIST, len(cables), len(figures), len(figures), "cables")
    for name, row in cables.items():
        shortest = min(each.length_mm for each in rows if each.cable == name)
        free_mm = shortest - reach_mm(boards[row.start[0]], design)
        radius = _radius_mm(run_mm(row, boards.get("breakout"), design), free_mm, design)
        stated = 0 < row.section_mm2 < math.inf
        wide = outer_mm(row.section_mm2) if stated else math.inf
        least = MARGIN * design.cabling.bend_ratio * wide
        subject = f"{_LIST}: {name}"
        note = f"{free_mm:.0f} mm between the ties; an estimate"
        yield Measurement("bending.radius", subject, radius, least, math.inf, "mm", note)
        off = radius / figures.get(name, math.nan) - 1
        note = "from the figure in the design"
        yield Measurement(
            "bending.figure", subject, 100 * off, -100 * AGREE, 100 * AGREE, "%", note
        )


def _radius_mm(run_mm: float, free_mm: float, design: Design) -> float:
    """The smallest radius at any place; NaN if the cable does not reach, or no rest is found."""
    travel_mm = design.mount.stroke_mm / 2
    if not math.hypot(run_mm, travel_mm) < free_mm < math.inf:
        return math.nan
    turn = 1.5 * np.sin(2 * np.pi * (np.arange(LINKS) + 0.5) / LINKS)
    found = []
    for place in PLACES:
        turn = _at_rest(turn, run_mm / free_mm, place * travel_mm / free_mm)
        found.append(free_mm / float(np.abs(_bends(turn)).max()))
    return float(np.min(found))


def _at_rest(start: Vectors, run: float, across: float) -> Vectors:
    """Angles of the links of a chain of length 1, with the least bending energy found."""

    def energy(turn: Vectors) -> float:
        bends = _bends(turn)
        return float((bends[1:-1] ** 2).sum() + (bends[0] ** 2 + bends[-1] ** 2) / 2) / 2 / LINKS

    def slope(turn: Vectors) -> Vectors:
        bends = _bends(turn)
        return np.asarray(bends[:-1] - bends[1:])

    ends = [
        {
            "type": "eq",
            "fun": lambda turn: np.cos(turn).mean() - run,
            "jac": lambda turn: -np.sin(turn) / LINKS,
        },
        {
            "type": "eq",
            "fun": lambda turn: np.sin(turn).mean() - across,
            "jac": lambda turn: np.cos(turn) / LINKS,
        },
    ]
    options = {"maxiter": 500, "ftol": 1e-9}
    found = minimize(energy, start, jac=slope, constraints=ends, method="SLSQP", options=options)
    return np.asarray(found.x) if found.success else np.full(LINKS, np.nan)


def _bends(turn: Vectors) -> Vectors:
    """Curvature between links, and at both ties, half a link from the first and the last."""
    inner = np.diff(turn) * LINKS
    return np.concatenate([[2 * LINKS * turn[0]], inner, [-2 * LINKS * turn[-1]]])
