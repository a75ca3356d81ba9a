"""Faults of single cells, from the light at each step."""

import numpy as np

from lumitip.acceptance.findings import (
    LEAK,
    LEAST_LIGHT,
    MOST_LIGHT,
    NOISE,
    WEAK,
    Finding,
    cell_names,
)
from lumitip.acceptance.steps import Frames
from lumitip.frame import Values
from lumitip.grid import Floats
from lumitip.health.doctor import examine
from lumitip.health.swaps import Mask
from lumitip.layout import Layout


def level(frames: Values) -> Values:
    """Mean light of each cell, shape `(cells,)`."""
    mean: Values = frames.mean(axis=0, dtype=np.float64).astype(np.float32)
    return mean


def faults_of_cells(frames: Frames, layout: Layout) -> list[Finding]:
    """Cells that are dead, stuck, noisy, weak or lit from elsewhere, and too much or little light.

    Args:
        frames: of all steps.
        layout: the cells.
    """
    findings = [
        Finding(f.kind, f"{cell_names(f.cells)}: {f.detail}", f.cells)
        for f in examine(frames.moving, layout).findings
        if f.sure and f.kind != "swapped"
    ]
    known = {cell for f in findings for cell in f.cells}
    empty, dark = level(frames.empty), level(frames.sheet)
    findings += _exposure(empty)
    if np.median(dark) > LEAK:
        text = (
            f"the median cell has {np.median(dark):.0f} of 255 behind sheet metal: ambient light, "
            "a mask that is not opaque (lumitip doctor --opacity), or steps 1 and 2 were exchanged"
        )
        return [*findings, Finding("leak", text)]
    noise = np.maximum(frames.empty.std(axis=0), frames.sheet.std(axis=0))
    for cell in sorted(set(range(len(layout))) - known):
        fault = _fault(empty[cell], dark[cell], noise[cell], float(np.median(empty - dark)))
        if fault:
            findings.append(Finding(fault[0], f"cell {cell}: {fault[1]}", (cell,)))
    return findings


def _fault(empty: float, dark: float, noise: float, typical: float) -> tuple[str, str] | None:
    """Kind and text of a cell's fault in the steady steps."""
    if empty - dark < WEAK * typical:
        return "weak", (
            f"the empty grasp is {empty - dark:.0f} of 255 lighter than the sheet, where the "
            f"median is {typical:.0f}: LED dead or turned, a poor joint, or a hole that is covered"
        )
    if dark > LEAK:
        return "leak", (
            f"{dark:.0f} of 255 behind sheet metal: ambient light, or the mask is not opaque "
            "(lumitip doctor --opacity)"
        )
    if noise > NOISE:
        return "noisy", f"noise of {noise:.0f} of 255 while nothing moves: loose joint, or flicker"
    return None


def _exposure(empty: Values) -> list[Finding]:
    median = float(np.median(empty))
    if LEAST_LIGHT <= median <= MOST_LIGHT:
        return []
    much = median > MOST_LIGHT
    text = (
        f"the median cell has {median:.0f} of 255 in the empty grasp; {LEAST_LIGHT:g} to "
        f"{MOST_LIGHT:g} is needed: LED current or pull-ups too {'large' if much else 'small'}"
    )
    return [Finding("exposure", text)]


def swap(pair: tuple[int, int]) -> Finding:
    """The finding of two swapped cells."""
    text = (
        f"{cell_names(pair)}: each reads what the other should. Is the layout.json that of this "
        "board, and the wiring as in it?"
    )
    return Finding("swapped", text, pair)


def odd_cells(off: Floats, most: float, usable: Mask) -> list[Finding]:
    """Cells that do not fit, where others do.

    Args:
        off: difference of each cell from the light at its place (counts), shape `(cells,)`.
        most: limit of it.
        usable: cells without another fault, shape `(cells,)`.
    """
    return [
        Finding(
            "odd",
            f"cell {cell}: differs by {off[cell]:.0f} of 255 from what its place should read; at "
            f"most {most:g}. A bridge to another cell, a part beside its land, or a poor joint",
            (int(cell),),
        )
        for cell in np.flatnonzero(usable & (off > most))
    ]
