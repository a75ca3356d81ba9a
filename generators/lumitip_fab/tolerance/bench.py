"""Errors of many built fingers: their frames, and the estimates of these, as numbers by finger."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.stats import qmc

from lumitip.estimation.estimator import DIAMETER_MM, NOISE
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Model, Twin
from lumitip.twin.built import Lines, Rays
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
    """Of edges, and as many of cables, in each set."""
    seed: int


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
        self._layout, self._model = case.layout, case.model
        self._rays = _rays(case)
        self.estimates = _estimates(case)
        self._empty = Twin(case.layout, case.model).empty
        self.lines = {kind: lines(case, kind, case.poses, number) for kind in KINDS}
        """True poses."""
        self.use = {"use": lines(case, "edge", LEARNING, POSE_SETS + number)}
        """Edges of self-calibration."""
        chance = generator(case.seed, Stream.NOISE, number)
        # The same noise for each of these fingers: what differs between them is how they are built.
        self._noise = {
            name: NOISE * chance.standard_normal((len(of.poses), len(case.layout)))
            for name, of in (self.lines | self.use).items()
        }

    def errors(self, draws: Draws, columns: tuple[str, ...] = COLUMNS) -> Floats:
        """Errors of fingers over their poses, shape `(columns, fingers, 5)`: rms of offset (mm)
        and angle (degrees) of edges, then of cables, and the share of the poses with a gross error.

        Args:
            draws: deviations of the fingers.
            columns: some of `COLUMNS`.
        """
        learning = COLUMNS[2] in columns
        frames = self.frames(draws, self.lines | (self.use if learning else {}))
        nothing = known = self.estimates.nothing_known(len(draws["gap"]))
        if learning:
            known = self.estimates.learned(frames["use"].tared, self.use["use"])
        rows = []
        for column in columns:
            missed = [
                self.estimates.errors(
                    frames[kind].raw if column == COLUMNS[0] else frames[kind].tared,
                    self.lines[kind],
                    known if column == COLUMNS[2] else nothing,
                )
                for kind in KINDS
            ]
            rms = [np.sqrt((one**2).mean(axis=1)) for one in missed]
            share = np.mean([gross(one).mean(axis=1) for one in missed], axis=0)
            rows.append(np.column_stack([*rms, share]))
        return np.array(rows)

    def compared(self, draws: Draws) -> dict[str, float]:
        """How the estimates compare with those of `PoseEstimator`, after a tare.

        Returns:
            Number of frames; of them the shares (%) that are not ambiguous and agree within
            `AGREED`, that `PoseEstimator` flags as ambiguous, and that have no flag but a
            gross error.
        """
        frames, known = self.frames(draws, self.lines), self.estimates.nothing_known
        agreed, flagged, unseen = [], [], []
        for kind, of in self.lines.items():
            tared = frames[kind].tared
            own = self.estimates.errors(tared, of, known(len(tared)))
            whole, ambiguous = self.estimates.searched(tared, of)
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
            noisy = (read * (FULL / by) + self._noise[name] for by in (self._empty, empty))
            values[name] = Frames(*(np.floor(np.clip(one, 0.0, FULL)) for one in noisy))
        return values


def lines(case: Case, kind: str, count: int, draw: int = 0) -> Lines:
    """Lines in any direction over the middle of the grid, evenly spread at places that the seed
    shifts."""
    reach_mm = _REACH * min(float(np.ptp(case.layout.x_mm)), float(np.ptp(case.layout.y_mm)))
    shift = generator(case.seed, Stream.POSES, KINDS.index(kind), draw).random(2)
    even = (qmc.Halton(2, scramble=False).random(count) + shift) % 1.0
    places = (2.0 * even - 1.0) * (np.pi / 2.0, reach_mm)
    return Lines(kind, places, DIAMETER_MM)


@lru_cache(maxsize=2)
def _rays(case: Case) -> Rays:
    return Rays(case.layout, case.model)


@lru_cache(maxsize=2)
def _estimates(case: Case) -> Estimates:
    return Estimates(case.layout, case.model)


@lru_cache(maxsize=2 * POSE_SETS)
def bench(case: Case, number: int = 0) -> Bench:
    """The bench of a case and a set of poses, one in each process."""
    return Bench(case, number)
