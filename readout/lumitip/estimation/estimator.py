"""`PoseEstimator`: the pose of what is between the fingers, from the values of a frame."""

import math
from copy import copy
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from lumitip.errors import LumitipError
from lumitip.estimation.bank import Bank, corners, lines
from lumitip.estimation.blur import ANGLE_SD_DEG, OFFSET_SD_MM, likely
from lumitip.estimation.estimate import KINDS, Estimate, without_contact
from lumitip.estimation.fit import ROUNDS, Fit, Frame, fit
from lumitip.estimation.lookup import Lookup
from lumitip.estimation.report import MISFIT_COUNTS, covariance, report, rms_counts
from lumitip.estimation.shapes import Cable, Cells, Corner, Edge, Shape
from lumitip.grid import Floats
from lumitip.layout import Layout, Optics
from lumitip.processing.processor import COVERED_BELOW, MIN_CONTRAST, ValuesError
from lumitip.twin import Model, Twin
from lumitip.twin.optics import FULL, GAP_MM, drive_of_values

DIAMETER_MM = 3.0
"""Diameter of a cable where none is told (mm)."""
NOISE = 1.5
"""Standard deviation of a value that is expected (counts of 255)."""
GAIN_ERROR = 0.01
"""Share by which a cell's light is expected to differ from its empty grasp."""
HUBER = 3.0
"""Standard deviations beyond which the loss grows linearly."""
_DOUBT = 1.3  # loss for each cell beyond which other starts are tried
_STARTS, _GLANCE = 8, 6  # how many, and the rounds of each
_LOOSE = 0.06  # share of a cell's light that is then taken to be uncertain
_RIVAL, _ELSEWHERE = 1.35, 2.0  # losses that are nearly alike; poses that are not
_HOPELESS = 2.5  # times what the best bank leaves of a frame: no fit makes up for more
_BLURRED = np.array([np.radians(ANGLE_SD_DEG), OFFSET_SD_MM])
_WORSE = 1.3  # times the misfit of the last search: then a tracker searches anew
_SIMPLER = {"edge": 1.0, "cable": 1.1, "corner": 2.0}  # a corner fits an edge's frame as well


class EstimationError(LumitipError, ValueError):
    """What an estimator cannot be asked for."""


class PoseEstimator:
    """`estimate = PoseEstimator(layout)(values)`: template bank, then least squares.

    Follows one fingertip from one thread when `tracking`; else it holds constants alone.
    """

    def __init__(
        self,
        layout: Layout,
        optics: Optics | Model | None = None,
        gap_mm: float = GAP_MM,
        diameter_mm: float = DIAMETER_MM,
        gains: ArrayLike | None = None,
        tracking: bool = False,
        noise: float = NOISE,
        gain_error: float = GAIN_ERROR,
        huber: float = HUBER,
    ) -> None:
        """Prepare tables for the optics of a design.

        Args:
            layout: where the cells are.
            optics: those of the layout if not given; or a whole model, which has its own gap.
            gap_mm: from skin to skin (mm).
            diameter_mm: of a cable; its width is found within about a third of it (mm).
            gains: light of each cell relative to its empty grasp, as `learn` finds it, shape
                `(cells,)`.
            tracking: begin where the frame before ended, and search anew when that fits badly.
            noise: standard deviation of a value (counts of 255).
            gain_error: share by which the light of a cell may differ from its empty grasp.
            huber: standard deviations beyond which the loss grows linearly.

        Raises:
            EstimationError: if gains are not those of this layout.
        """
        self.layout = layout
        self.model = _model(layout, optics, gap_mm)
        self._twin = Twin(layout, self.model)
        self._gains = np.ones(len(layout)) if gains is None else _gains(layout, gains)
        self._noise, self._gain_error, self._huber = noise, gain_error, huber
        self._tracking = tracking
        self._cells = Cells(layout.x_mm, layout.y_mm)
        self._diameter_mm = diameter_mm
        self._lines = lines(self._cells)
        self._reach_mm = float(self._lines[:, 1].max())
        self._edge_table = Lookup(self._twin.edge_table())
        self._shapes: dict[str, Shape] = {}
        self._banks: dict[str, Bank] = {}
        self._last: tuple[str, Floats, float] | None = None
        steps = np.arange(0.0, FULL + 1.0)[:, None] * (self._twin.empty / FULL)
        self._light = drive_of_values(steps, self.model) / self._twin.drive
        self._rise = np.gradient(self._light, axis=0)

    def __call__(self, values: ArrayLike, kind: str | None = None) -> Estimate:
        """What one frame says.

        Args:
            values: calibrated values, 255 is full light, shape `(cells,)`; cells whose value is
                not finite are left out.
            kind: `"edge"`, `"cable"` or `"corner"`; `None` decides.

        Raises:
            ValuesError: if the shape is another.
            EstimationError: if there is no such kind.
        """
        if kind is not None and kind not in KINDS:
            raise EstimationError(f"kind: {kind!r} given, allowed are {', '.join(KINDS)} and None")
        given: Floats = np.asarray(values, dtype=np.float64)
        if given.shape != (len(self.layout),):
            raise ValuesError(
                f"values of shape {given.shape} given, a frame of this layout has "
                f"({len(self.layout)},)"
            )
        usable = np.isfinite(given)
        told = given[usable]
        if told.size < 4 or not np.ptp(told) >= MIN_CONTRAST:
            self._last = None
            middle = float(np.median(told)) if told.size else math.inf
            return without_contact("covered" if middle < COVERED_BELOW else "none")
        frame = self._frame(given, usable)
        name, found = self._found(frame, kind)
        shape = self._shape(name)
        if name == "edge":
            deviations = np.sqrt(np.abs(np.diag(covariance(found, frame)))[:2])
            if np.any(deviations > _BLURRED):
                found = replace(found, pose=likely(shape, found.pose, deviations, frame))
        estimate = report(shape, found, frame, self._reach_mm)
        self._remember(name, found, estimate)
        return estimate

    def _remember(self, name: str, found: Fit, estimate: Estimate) -> None:
        """Begin the next frame here, unless this one went wrong."""
        fine = self._tracking and {"misfit", "ambiguous"}.issuperset(estimate.flags)
        # The misfit stays that of the last search, which later frames are held against.
        misfit = self._last[2] if self._last else estimate.rms_counts
        self._last = (name, found.pose, misfit) if fine else None

    def fitted(self, values: ArrayLike, kind: str) -> tuple[Frame, Fit]:
        """The frame as the fit sees it, and where the fit of a kind ended.

        Args:
            values: of one frame, finite, shape `(cells,)`.
            kind: `"edge"`, `"cable"` or `"corner"`.
        """
        given: Floats = np.asarray(values, dtype=np.float64)
        frame = self._frame(given, np.isfinite(given))
        return frame, self._searched(kind, self._start(kind, frame)[0], frame)

    def with_gains(self, gains: ArrayLike) -> "PoseEstimator":
        """The same estimator with other gains of the cells; tables are shared."""
        other = copy(self)
        other._gains = _gains(self.layout, gains)
        other._last = None
        return other

    def reset(self) -> None:
        """Forget the frame before."""
        self._last = None

    def _frame(self, values: Floats, usable: np.ndarray) -> Frame:
        values = np.clip(np.where(usable, values, FULL), 0.0, FULL)
        whole = np.minimum(values.astype(np.int64), int(FULL) - 1)
        each = np.arange(values.size)
        low = self._light[whole, each]
        light = low + (values - whole) * (self._light[whole + 1, each] - low)
        rise = self._rise[whole, each]
        deviation = np.hypot(self._noise * rise, self._gain_error * light)
        scale = usable * self._gains / deviation
        full = values > FULL - 1.0
        return Frame(light / self._gains, scale, self._gains / rise, full, self._huber)

    def _found(self, frame: Frame, kind: str | None) -> tuple[str, Fit]:
        if self._last is not None and kind in (None, self._last[0]):
            name, pose, misfit = self._last
            found = fit(self._shape(name), pose, frame)
            if rms_counts(found, frame) < max(0.5 * MISFIT_COUNTS, _WORSE * misfit):
                return name, found
        self._last = None
        if kind is not None:
            return kind, self._searched(kind, self._start(kind, frame)[0], frame)
        starts = {"edge": self._start("edge", frame)}
        plain = self._from("edge", starts["edge"][0][0], frame)
        if not self._doubtful(plain, frame):
            return "edge", plain
        starts |= {name: self._start(name, frame) for name in KINDS[1:]}
        most = _HOPELESS * min(left for _, left in starts.values())
        fits = {}
        for name, (poses, left) in sorted(starts.items(), key=lambda item: item[1][1]):
            if left <= most:
                fits[name] = self._searched(name, poses, frame)
                if name != "corner" and not self._doubtful(fits[name], frame):
                    break
        name = min(fits, key=lambda n: _SIMPLER[n] * (fits[n].cost + 3.0 * fits[n].pose.size))
        return name, fits[name]

    def _doubtful(self, found: Fit, frame: Frame) -> bool:
        return found.cost > _DOUBT * int(np.count_nonzero(frame.scale))

    def _start(self, kind: str, frame: Frame, starts: int = 1) -> tuple[Floats, float]:
        weights = (frame.scale > 0.0).astype(np.float64)
        return self._bank(kind).best(frame.light, weights, starts)

    def _searched(self, kind: str, starts: Floats, frame: Frame) -> Fit:
        best = self._from(kind, starts[0], frame)
        if not self._doubtful(best, frame):
            return best
        # Optics or cells are not as expected: which start is best is judged with that allowed for.
        loose = frame.looser(_LOOSE)
        starts, _ = self._start(kind, frame, _STARTS)
        fits = sorted(
            (self._from(kind, start, loose, _GLANCE) for start in starts), key=lambda f: f.cost
        )
        first, apart = fits[0], self._bank(kind).apart
        near = [f for f in fits[1:] if f.cost < _RIVAL * first.cost]
        rivals = [f for f in near if _between(kind, f.pose, first.pose) @ apart > _ELSEWHERE]
        return replace(fit(self._shape(kind), first.pose, frame), ambiguous=bool(rivals))

    def _from(self, kind: str, pose: Floats, frame: Frame, rounds: int = ROUNDS) -> Fit:
        usable = frame.light[frame.scale > 0.0]
        light = taken = float(usable.max())
        if kind == "cable":
            pose = np.append(pose, self._diameter_mm)
        else:
            taken -= float(usable.min())
        return fit(self._shape(kind), np.append(pose, [light, taken]), frame, rounds)

    def _shape(self, kind: str) -> Shape:
        if kind not in self._shapes:
            if kind == "edge":
                self._shapes[kind] = Edge(self._cells, self._edge_table)
            elif kind == "corner":
                self._shapes[kind] = Corner(self._cells, self._edge_table)
            else:
                table = Lookup(self._twin.cable_table(self._diameter_mm))
                self._shapes[kind] = Cable(self._cells, table, self._edge_table, self._diameter_mm)
        return self._shapes[kind]

    def _bank(self, kind: str) -> Bank:
        if kind not in self._banks:
            poses = corners(self._cells) if kind == "corner" else self._lines
            self._banks[kind] = Bank.of(self._shape(kind), poses, np.ones(len(self.layout)))
        return self._banks[kind]


def _between(kind: str, one: Floats, two: Floats) -> Floats:
    """How far two poses are from each other in each entry, without light and what is taken."""
    away = (one - two)[: 4 if kind == "corner" else 2]
    turn = np.pi if kind == "cable" else 2.0 * np.pi  # an edge turned round covers the other side
    turns = np.round(away[0] / turn)
    away[0] -= turns * turn
    if kind == "cable" and turns % 2.0:
        away[1] = one[1] + two[1]  # the same line the other way round
    return np.abs(away)


def _model(layout: Layout, optics: Optics | Model | None, gap_mm: float) -> Model:
    if isinstance(optics, Model):
        return optics
    return Model.from_layout(replace(layout, optics=optics) if optics else layout, gap_mm)


def _gains(layout: Layout, gains: ArrayLike) -> Floats:
    given = np.array(gains, dtype=np.float64)
    if given.shape != (len(layout),) or not (given > 0.0).all():
        raise EstimationError(f"gains: {len(layout)} numbers above 0 are needed")
    return given
