"""Whether a pair of fingers is accepted, and what is wrong with one that is not."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lumitip import arguments
from lumitip.acceptance.fit import Fitted, fit
from lumitip.acceptance.gauge import Gauge, GaugeError
from lumitip.acceptance.places import Places
from lumitip.acceptance.response import Response, named
from lumitip.acceptance.steps import Frames
from lumitip.errors import ArgumentError
from lumitip.frame import Values
from lumitip.grid import Floats
from lumitip.health.doctor import examine
from lumitip.health.swaps import Mask
from lumitip.layout import Layout
from lumitip.twin.optics import FULL
from lumitip.values import one_line

MASK_MM, MASK_DEG = 1.0, 2.5
"""Most that a mask may be beside its place: four deviations of one that is laid by eye. The gauge
measures it within 0.2 mm, since the board may lie beside its place, too."""
GAP_MM = 0.6
"""Most that the skins may be from the gauge's gap: less closes on it, more is a bent finger."""
SCATTER, SCATTER_ALONE = 0.4, 0.5
"""Most by which the scattered share of the light may differ from that of good fingers, and without
these from that of the drawing, which nobody has measured: a second optical model has 0.4 less."""
HOLE_MM = 0.4
"""Most by which the holes may be wider or narrower."""
MISFIT = 6.0
"""Most rms difference from the twin (counts of 255). The published sensor's frames differ by 9 to
20, of cloth and cable that nobody measured."""
WEAK = 0.4
"""Least light of a cell in the empty grasp, as a share of the median."""
LEAK = 25.5
"""Most light behind sheet metal (counts of 255)."""
_ROUNDED = 0.5  # an ADC rounds down, so a code is read half a step low
_LEAST_CELLS = 8


@dataclass(frozen=True)
class Finding:
    """Something that is out of tolerance."""

    kind: str
    """`"dark"`, `"saturated"`, `"stuck"`, `"noisy"`, `"swapped"`, `"astray"`, `"weak"`, `"leak"`
    for cells; `"receiver mask"`, `"emitter mask"`, `"gap"`, `"silicone"`, `"holes"`,
    `"unexplained"` for the fingers."""
    text: str
    """Observation and remedy, for the builder."""
    cells: tuple[int, ...] = ()
    """Their numbers; empty where it is a matter of all."""
    times_limit: float = math.inf
    """How large it is; infinite for a fault of cells."""


@dataclass(frozen=True, eq=False)
class Verdict:
    """The result of `Judge`."""

    findings: tuple[Finding, ...]
    """First those of cells, then the largest; none if the fingers are accepted."""
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
            GaugeError: if the gauge belongs to another design.
        """
        self._layout, self._gauge = arguments.layout(layout), gauge
        if gauge.design_hash != layout.design_hash:
            raise GaugeError(
                f"the gauge is of design {gauge.design_hash[:16]}, the fingertip of "
                f"{layout.design_hash[:16]}. Use the gauge.json that was built with its firmware"
            )
        self._response = Response(layout, gauge)
        self._places = Places(layout, gauge.gap_mm)

    def __call__(self, frames: Frames, reference: Mapping[str, float] | None = None) -> Verdict:
        """Judge a pair of fingers by its frames.

        Args:
            frames: of all steps.
            reference: mean deviations of fingers that are known to be good, with whose scattered
                share this one is compared; by default that of the drawing.

        Raises:
            ArgumentError: if the frames are not of these cells and placements.
        """
        _check(frames, self._layout, self._gauge)
        empty, dark = (_level(part) for part in (frames.empty, frames.sheet))
        seen = examine(frames.moving, self._layout)
        findings = [
            Finding(f.kind, f"{_cells(f.cells)}: {f.detail}", f.cells)
            for f in seen.findings
            if f.sure and f.kind != "swapped"
        ]
        findings += _levels(empty, dark, {cell for f in findings for cell in f.cells})
        usable = _usable(findings, len(self._layout))
        span = np.maximum((empty - dark).astype(np.float64), 1.0)

        def calibrated(light: Values) -> Floats:
            return np.asarray((light - dark) * (FULL / span))

        moved = calibrated(frames.moving).astype(np.float32)
        findings += [_swap(pair) for pair in self._places.swapped(moved, usable)]
        usable = _usable(findings, len(self._layout))
        fitted = None
        if usable.sum() >= _LEAST_CELLS and not any(f.kind == "astray" for f in findings):
            values = np.array([calibrated(_level(part)) for part in frames.gauge])
            light = empty.astype(np.float64) + _ROUNDED
            fitted = fit(self._response, values, light, usable)
            findings += _whole(fitted, reference)
        elif not findings:
            findings.append(Finding("unexplained", f"{usable.sum()} cells are too few"))
        return Verdict(
            tuple(findings),
            named(fitted.deviations) if fitted else {},
            named(fitted.sd) if fitted else {},
            fitted.rms if fitted else math.nan,
            empty,
            dark,
            seen.unseen,
        )


def _usable(findings: list[Finding], cells: int) -> Mask:
    """Cells without a finding, shape `(cells,)`."""
    faulty = {cell for finding in findings for cell in finding.cells}
    usable: Mask = ~np.isin(np.arange(cells), list(faulty))
    return usable


def _swap(pair: tuple[int, int]) -> Finding:
    text = (
        f"{_cells(pair)}: each reads what the other should. Is the layout.json that of this board, "
        "and the wiring as in it?"
    )
    return Finding("swapped", text, pair)


def _check(frames: Frames, layout: Layout, gauge: Gauge) -> None:
    if len(frames.gauge) != len(gauge.placements):
        raise ArgumentError(
            f"frames of {len(frames.gauge)} placements; the gauge has {len(gauge.placements)}"
        )
    parts = {"empty": frames.empty, "sheet": frames.sheet, "moving": frames.moving}
    for name, part in (parts | {f"gauge[{n}]": g for n, g in enumerate(frames.gauge)}).items():
        shape = np.shape(arguments.numbers(part, name))
        if len(shape) != 2 or shape[0] < 2 or shape[1] != len(layout):
            raise ArgumentError(f"{name} has shape {shape}; (2 or more, {len(layout)}) is needed")


def _level(frames: Values) -> Values:
    level: Values = frames.mean(axis=0, dtype=np.float64).astype(np.float32)
    return level


def _levels(empty: Values, dark: Values, known: set[int]) -> list[Finding]:
    """Faults of single cells that the steady steps show."""
    findings, typical = list[Finding](), float(np.median(empty))
    for cell in sorted(set(range(empty.size)) - known):
        if empty[cell] < WEAK * typical:
            text = (
                f"{empty[cell]:.0f} of 255 in the empty grasp, where the median is {typical:.0f}: "
                "LED dead or turned, a poor joint, or a hole that is covered"
            )
            findings.append(Finding("weak", f"cell {cell}: {text}", (cell,)))
        elif dark[cell] > LEAK:
            text = (
                f"{dark[cell]:.0f} of 255 behind sheet metal: ambient light, or the mask is not "
                "opaque (lumitip doctor --opacity)"
            )
            findings.append(Finding("leak", f"cell {cell}: {text}", (cell,)))
    return findings


def _whole(fitted: Fitted, reference: Mapping[str, float] | None) -> list[Finding]:
    """What is wrong with the fingers as a whole."""
    of, findings = named(fitted.deviations), list[Finding]()
    for finger in ("receiver", "emitter"):
        x, y, turn = (of[f"{finger}_{way}"] for way in ("x", "y", "turn"))
        times = max(math.hypot(x, y) / MASK_MM, abs(turn) / MASK_DEG)
        text = (
            f"{finger}'s mask: {_way(x, y)}, turned by {abs(turn):.1f}° to the "
            f"{'left' if turn > 0 else 'right'}, seen on the receiver with the tip up; at most "
            f"{MASK_MM:g} mm and {MASK_DEG:g}°. Lay it anew"
        )
        findings.append(Finding(f"{finger} mask", text, times_limit=times))
    findings.append(
        Finding(
            "gap",
            f"gap: {of['gap']:+.2f} mm beyond the gauge's; at most {GAP_MM:g} mm. Does something "
            "lie between gauge and skin, is a finger bent or not parallel?",
            times_limit=abs(of["gap"]) / GAP_MM,
        )
    )
    good, most = ("good fingers", SCATTER) if reference else ("the drawing", SCATTER_ALONE)
    scatter, hole = of["scatter"] - (reference or {}).get("scatter", 0.0), of["hole"]
    findings.append(
        Finding(
            "silicone",
            f"silicone: scattered share {scatter:+.2f} from {good}; at most {most:g}. Is it the "
            "silicone of the bill, free of bubbles, and the film's back clear?",
            times_limit=abs(scatter) / most,
        )
    )
    findings.append(
        Finding(
            "holes",
            f"holes: {hole:+.2f} mm wider than the drawing's; at most {HOLE_MM:g} mm. Measure the "
            "mask's rulers and holes",
            times_limit=abs(hole) / HOLE_MM,
        )
    )
    found = sorted((f for f in findings if f.times_limit > 1.0), key=lambda f: -f.times_limit)
    if fitted.rms > MISFIT:
        text = (
            f"the cells differ by {fitted.rms:.1f} of 255 from any finger with such faults; at "
            f"most {MISFIT:g}. Was the gauge pressed against its stop, and the right way round?"
        )
        found.append(Finding("unexplained", text, times_limit=fitted.rms / MISFIT))
    return found


def _way(x_mm: float, y_mm: float) -> str:
    side = "right" if x_mm > 0 else "left"
    along = "towards the tip" if y_mm > 0 else "towards the gripper"
    return f"{abs(x_mm):.2f} mm to the {side}, {abs(y_mm):.2f} mm {along}"


def _cells(cells: tuple[int, ...]) -> str:
    return f"cell {' and '.join(map(str, cells))}" if cells else "all cells"
