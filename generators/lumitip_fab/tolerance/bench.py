"""Errors of many built fingers: their frames, and the estimates of these, as numbers by finger."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.stats import qmc

from lumitip.estimation.estimator import DIAMETER_MM, NOISE
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Model, Twin
from lumitip.twin.built import Lines, Rays
from lumitip.twin.noise import dimness
from lumitip.twin.optics import FULL, values_of_drive
from lumitip_fab.tolerance.draws import Draws, built
from lumitip_fab.tolerance.estimate import Estimates, gross
from lumitip_fab.tolerance.streams import Stream, generator

COLUMNS = ("as built", "after tare", "after self-calibration")
"""States of a finger that its errors are counted in."""
KINDS = ("edge", "cable")
POSE_SETS = 64
"""Sets of poses, of which each finger is tried at one: what a finger's errors are depends on its
poses as much as on its deviations. A power of 2, so that in a Sobol study the fingers that differ
in one deviation have the same poses."""
LEARNING = 40
"""Edges by which a finger calibrates itself."""
AGREED = (0.05, 0.2)
"""Difference of two estimates of one frame that counts as none (mm, degrees)."""
_REACH = 0.35  # of the grid's smaller extent: how far from its middle lines lie


@dataclass(frozen=True)
class Case:
    """A drawing, and the places of lines that all fingers are tried at."""

    layout: Layout
    model: Model
    poses: int
    """Of edges, and as many of cables of each diameter, in each set."""
    seed: int
    edges: bool = True
    """Whether edges are tried."""
    cables_mm: tuple[float, ...] = (DIAMETER_MM,)
    """Diameters of the cables (mm), which the estimator expects."""


@dataclass(frozen=True, eq=False)
class Frames:
    """Values of one kind of object, 255 is full light, shape `(fingers, poses, cells)`."""

    raw: Floats
    """Compared with the empty grasp of the drawing."""
    tared: Floats
    """Compared with the finger's own empty grasp."""


class Bench:
    """Tries built fingers; holds rays and tables of the drawing."""

    def __init__(self, case: Case, number: int = 0) -> None:
        """Prepare lines, noise, rays and the estimator.

        Args:
            case: the drawing.
            number: of the set of poses, below `POSE_SETS`.
        """
        self._case, self._layout, self._model = case, case.layout, case.model
        self._rays = _rays(case)
        drawn = Twin(case.layout, case.model)
        self._empty, self._dim = drawn.empty, dimness(drawn)
        self.lines = {"edge": lines(case, "edge", case.poses, number)} if case.edges else {}
        self.lines |= {
            f"cable {diameter_mm:g} mm": lines(case, "cable", case.poses, number, diameter_mm)
            for diameter_mm in case.cables_mm
        }
        """True poses."""
        self.use = lines(case, "edge", LEARNING, POSE_SETS + number)
        """Edges of self-calibration."""
        chance = generator(case.seed, Stream.NOISE, number)
        # The same noise for each of these fingers: what differs between them is how they are built.
        self._noise = {
            name: NOISE * chance.standard_normal((len(of.poses), len(case.layout)))
            for name, of in self._lines(learning=True).items()
        }

    def estimates(self, of: Lines) -> Estimates:
        """The estimates of lines: they expect the diameter of these cables."""
        return _estimates(self._case, of.diameter_mm)

    def errors(self, draws: Draws, columns: tuple[str, ...] = COLUMNS) -> Floats:
        """Errors of fingers over their poses, shape `(columns, fingers, 5)`: rms of offset (mm)
        and angle (degrees) of edges, then of cables, and the share of the poses with a gross error.
        Errors of a kind that is not tried are NaN.

        Args:
            draws: deviations of the fingers.
            columns: some of `COLUMNS`.
        """
        learning = COLUMNS[2] in columns
        frames = self.frames(draws, self._lines(learning))
        by_edges = self.estimates(self.use)
        nothing = known = by_edges.nothing_known(len(draws["gap"]))
        if learning:
            known = by_edges.learned(frames["use"].tared, self.use)
        rows = []
        for column in columns:
            missed: dict[str, list[Floats]] = {kind: [] for kind in KINDS}
            for name, of in self.lines.items():
                values = frames[name].raw if column == COLUMNS[0] else frames[name].tared
                learned = known if column == COLUMNS[2] else nothing
                missed[of.kind].append(self.estimates(of).errors(values, of, learned))
            rms = [_rms(missed[kind], len(nothing.gains)) for kind in KINDS]
            every = np.concatenate([one for each in missed.values() for one in each], axis=1)
            rows.append(np.column_stack([*rms, gross(every).mean(axis=1)]))
        return np.array(rows)

    def _lines(self, learning: bool) -> dict[str, Lines]:
        """All lines by name, with those of self-calibration or without."""
        return self.lines | ({"use": self.use} if learning else {})

    def compared(self, draws: Draws) -> dict[str, float]:
        """How the estimates compare with those of `PoseEstimator`, after a tare.

        Returns:
            Number of frames; of them the shares (%) that are not ambiguous and agree within
            `AGREED`, that `PoseEstimator` flags as ambiguous, and that have no flag but a
            gross error.
        """
        frames = self.frames(draws, self.lines)
        agreed, flagged, unseen = [], [], []
        for name, of in self.lines.items():
            tared, estimates = frames[name].tared, self.estimates(of)
            own = estimates.errors(tared, of, estimates.nothing_known(len(tared)))
            whole, ambiguous = estimates.searched(tared, of)
            agreed.append((np.abs(own - whole) <= AGREED).all(axis=2) & ~ambiguous)
            flagged.append(ambiguous)
            unseen.append(gross(whole) & ~ambiguous)
        shares = {"agree": agreed, "ambiguous": flagged, "gross": unseen}
        percent = {f"{name}_percent": 100.0 * float(np.mean(of)) for name, of in shares.items()}
        return {"frames": float(np.size(agreed)), **percent}

    def frames(self, draws: Draws, lines: dict[str, Lines]) -> dict[str, Frames]:
        """Frames of all fingers by name of the lines."""
        each = [self._finger(draws, n, lines) for n in range(len(draws["gap"]))]
        return {
            name: Frames(
                np.array([one[name].raw for one in each]),
                np.array([one[name].tared for one in each]),
            )
            for name in lines
        }

    def _finger(self, draws: Draws, finger: int, lines: dict[str, Lines]) -> dict[str, Frames]:
        """Frames of one finger, shape `(poses, cells)`."""
        pair = built(self._layout, self._model, draws, finger)
        light = self._rays.of(pair)
        full = light.full * pair.detector
        drive = self._model.gain * pair.exposure * full / full.max()
        empty = values_of_drive(drive, self._model)
        values = {}
        for name, of in lines.items():
            read = values_of_drive(light.shares(of) * drive * pair.drift, self._model)
            noise = self._dim * self._noise[name]
            noisy = (read * (FULL / by) + noise for by in (self._empty, empty))
            values[name] = Frames(*(self._codes(one) for one in noisy))
        return values

    def _codes(self, values: Floats) -> Floats:
        """Whole steps of the voltage."""
        steps = np.floor(np.clip(values, 0.0, FULL) / self._dim)
        return np.asarray(steps * self._dim)


def _rms(missed: list[Floats], fingers: int) -> Floats:
    """Rms over all poses of offset (mm) and angle (degrees), shape `(fingers, 2)`; NaN if none."""
    if not missed:
        return np.full((fingers, 2), np.nan)
    found: Floats = np.sqrt((np.concatenate(missed, axis=1) ** 2).mean(axis=1))
    return found


def lines(
    case: Case, kind: str, count: int, draw: int = 0, diameter_mm: float = DIAMETER_MM
) -> Lines:
    """Lines in any direction over the middle of the grid, evenly spread at places that the seed
    shifts."""
    reach_mm = _REACH * min(float(np.ptp(case.layout.x_mm)), float(np.ptp(case.layout.y_mm)))
    shift = generator(case.seed, Stream.POSES, KINDS.index(kind), draw).random(2)
    even = (qmc.Halton(2, scramble=False).random(count) + shift) % 1.0
    places = (2.0 * even - 1.0) * (np.pi / 2.0, reach_mm)
    return Lines(kind, places, diameter_mm)


@cache
def _rays(case: Case) -> Rays:
    return Rays(case.layout, case.model)


@cache
def _estimates(case: Case, diameter_mm: float) -> Estimates:
    return Estimates(case.layout, case.model, diameter_mm)


@cache
def bench(case: Case, number: int = 0) -> Bench:
    """The bench of a case and a set of poses, one in each process."""
    return Bench(case, number)


def errors_over(
    cases: tuple[Case, ...], number: int, draws: Draws, columns: tuple[str, ...]
) -> Floats:
    """Errors of fingers over the poses of all cases, see `Bench.errors`."""
    found = np.array([bench(case, number).errors(draws, columns) for case in cases])
    edges = np.array([float(case.edges) for case in cases])
    cables = np.array([float(len(case.cables_mm)) for case in cases])
    mean_square = [
        np.average(np.nan_to_num(found[..., some]) ** 2, axis=0, weights=counts)
        if counts.any()
        else np.full_like(found[0, ..., some], np.nan)
        for some, counts in ((slice(2), edges), (slice(2, 4), cables))
    ]
    share = np.average(found[..., 4:], axis=0, weights=edges + cables)
    return np.concatenate([*map(np.sqrt, mean_square), share], axis=-1)


def forget() -> None:
    """Drop the tables of all cases in this process."""
    for kept in (_rays, _estimates, bench):
        kept.cache_clear()
