"""Whether a pair of fingers is accepted, and what is wrong with one that is not."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from lumitip import arguments
from lumitip.acceptance.cells import faults_of_cells, level, odd_cells, swap
from lumitip.acceptance.findings import ODD, ODD_MOVING, Finding
from lumitip.acceptance.fingers import faults_of_fingers
from lumitip.acceptance.fit import Fitted, fit
from lumitip.acceptance.gauge import Gauge, GaugeError
from lumitip.acceptance.places import Places
from lumitip.acceptance.response import Response, named
from lumitip.acceptance.stage import Trace, trace
from lumitip.acceptance.steps import Frames
from lumitip.errors import ArgumentError
from lumitip.frame import Values
from lumitip.grid import Floats
from lumitip.health.swaps import Mask
from lumitip.layout import Layout
from lumitip.twin.optics import FULL
from lumitip.values import one_line

LEAST_CELLS = 8
"""Fewer do not tell the deviations apart."""


@dataclass(frozen=True, eq=False)
class Verdict:
    """The result of `Judge`."""

    findings: tuple[Finding, ...]
    """Those that others may follow from come first; none if the fingers are accepted."""
    deviations: dict[str, float]
    """Of the fingers, see `lumitip.acceptance.response.DEVIATIONS`; empty if too few cells work."""
    sd: dict[str, float]
    """Standard deviation of each, by the spread of the single parts."""
    misfit: float
    """Rms difference from the twin with these deviations (counts of 255); NaN without them."""
    empty: Values
    """Mean light of each cell in the empty grasp (counts of 255), shape `(cells,)`."""
    dark: Values
    """The same behind sheet metal."""
    unseen: str | None
    """Why swapped cells could not be found, for the builder; `None` if they could."""
    traces: tuple[Trace, ...] = ()
    """How exactly the edge was found that a stage moved."""

    @property
    def accepted(self) -> bool:
        """Whether nothing is out of tolerance and everything was seen."""
        return not self.findings and self.unseen is None

    def __repr__(self) -> str:
        return one_line(self)


class Judge:
    """Judges pairs of fingers of one design."""

    def __init__(self, layout: Layout, gauge: Gauge) -> None:
        """Prepare the tables, which takes seconds.

        Args:
            layout: the cells.
            gauge: of the same design.

        Raises:
            LayoutError: if `layout` is no layout.
            GaugeError: if the gauge belongs to another design, or there are too few cells.
        """
        self._layout, self._gauge = arguments.layout(layout), gauge
        if gauge.design_hash != layout.design_hash:
            raise GaugeError(
                f"the gauge is of design {gauge.design_hash[:16]}, the fingertip of "
                f"{layout.design_hash[:16]}. Use the gauge.json that was built with its firmware"
            )
        if len(layout) < LEAST_CELLS:
            raise GaugeError(
                f"the fingertip has {len(layout)} cells; {LEAST_CELLS} are needed to judge it"
            )
        self._response = Response(layout, gauge)
        self._places = Places(layout, gauge.gap_mm)

    def __call__(
        self,
        frames: Frames,
        reference: Mapping[str, float] | None = None,
        thicker_mm: tuple[float, float] | None = None,
    ) -> Verdict:
        """Judge a pair of fingers by its frames.

        Args:
            frames: of all steps.
            reference: mean deviations of fingers that are known to be good, with whose scattered
                share this one is compared; by default that of the drawing.
            thicker_mm: silicone of receiver and emitter beyond the drawing, as a calliper measures
                it; without it thickness is not judged.

        Raises:
            ArgumentError: if the frames are not of these cells and placements, or not finite.
        """
        _check(frames, self._layout, self._gauge)
        findings = faults_of_cells(frames, self._layout)
        usable = self._usable(findings)
        moved = _calibrated(frames.moving, frames)
        places = self._places(moved, usable)
        findings += [swap(pair) for pair in places.swapped]
        usable = self._usable(findings)
        fitted = None
        if usable.sum() >= LEAST_CELLS and not any(f.cells == () for f in findings):
            fitted = self._fit(frames, usable, thicker_mm)
            odd = odd_cells(np.sqrt(np.mean(fitted.residual**2, axis=0)), ODD, usable)
            # If many cells misfit, it is no fault of cells.
            if 0 < len(odd) <= usable.sum() // 4:
                findings += odd
                usable = self._usable(findings)
                fitted = self._fit(frames, usable, thicker_mm)
            whole = faults_of_fingers(fitted, reference, thicker_mm)
            if not whole and places.misfit is not None:
                findings += odd_cells(places.misfit, ODD_MOVING, usable)
            findings = sorted([*findings, *whole], key=_is_consequence)
        elif not findings:
            findings.append(Finding("unexplained", f"{usable.sum()} cells are too few"))
        return Verdict(
            tuple(findings),
            named(fitted.deviations) if fitted else {},
            named(fitted.sd) if fitted else {},
            fitted.rms if fitted else math.nan,
            level(frames.empty),
            level(frames.sheet),
            places.unseen,
            tuple(self._traces(frames, usable)),
        )

    def unseen(self, empty: Values, sheet: Values, moving: Values) -> str | None:
        """Why swapped cells cannot be found in the frames of these steps; `None` if they can.

        Cells with a fault of their own, such as dead ones, need not be seen.
        """
        frames = Frames(empty, sheet, moving, ())
        usable = self._usable(faults_of_cells(frames, self._layout))
        return self._places(_calibrated(moving, frames), usable).unseen

    def _fit(self, frames: Frames, usable: Mask, thicker_mm: tuple[float, float] | None) -> Fitted:
        values = np.array([_calibrated(level(part), frames) for part in frames.gauge])
        empty = level(frames.empty).astype(np.float64)
        return fit(self._response, values, empty, usable, thicker_mm)

    def _traces(self, frames: Frames, usable: Mask) -> Iterator[Trace]:
        for traverse in frames.traverses:
            light = traverse.light.mean(axis=1)
            values = np.where(usable, _calibrated(light, frames), np.nan)
            yield trace(traverse, values, self._layout, self._places.estimate)

    def _usable(self, findings: list[Finding]) -> Mask:
        """Cells without a finding, shape `(cells,)`."""
        faulty = {cell for finding in findings for cell in finding.cells}
        usable: Mask = ~np.isin(np.arange(len(self._layout)), list(faulty))
        return usable


def _is_consequence(finding: Finding) -> bool:
    """Whether it may follow from a mask beside its place, which is then named first."""
    return finding.kind in ("weak", "odd", "unexplained")


def _calibrated(light: Values, frames: Frames) -> Floats:
    """Values between those of the sheet, 0, and of the empty grasp, 255."""
    empty, dark = level(frames.empty), level(frames.sheet)
    span = np.maximum((empty - dark).astype(np.float64), 1.0)
    return np.asarray((light - dark) * (FULL / span))


def _check(frames: Frames, layout: Layout, gauge: Gauge) -> None:
    if len(frames.gauge) != len(gauge.placements):
        raise ArgumentError(
            f"frames of {len(frames.gauge)} placements; the gauge has {len(gauge.placements)}"
        )
    parts = {"empty": frames.empty, "sheet": frames.sheet, "moving": frames.moving}
    for name, part in (parts | {f"gauge[{n}]": g for n, g in enumerate(frames.gauge)}).items():
        numbers = arguments.numbers(part, name)
        shape = np.shape(numbers)
        if len(shape) != 2 or shape[0] < 2 or shape[1] != len(layout):
            raise ArgumentError(f"{name} has shape {shape}; (2 or more, {len(layout)}) is needed")
        if not np.isfinite(numbers).all():
            raise ArgumentError(f"{name} has values that are not finite; light is needed")
