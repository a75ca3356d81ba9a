"""`PoseEstimator`: the pose of the object between the fingers, from the values of a frame."""

import math
from copy import copy
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumitip import arguments
from lumitip.errors import LumitipError
from lumitip.estimation.estimate import (
    FAINT_CONTRAST,
    KINDS,
    LEAST_CELLS,
    MISFIT_COUNTS,
    Estimate,
    contrast,
    report,
    rms_counts,
    without_contact,
)
from lumitip.estimation.fit import ANGLE_SD_DEG, OFFSET_SD_MM, Fit, Frame, drifting, likely
from lumitip.estimation.last import Last, after
from lumitip.estimation.search import ALPHA_SD, BENT, GAP_SD_MM, Search
from lumitip.estimation.uncertain import BORDER_SD_MM, PLACE_SD_MM, covariance, misplaced
from lumitip.grid import Floats, collinear
from lumitip.layout import Layout, Optics
from lumitip.processing.batch import usable_cells
from lumitip.processing.processor import MIN_CONTRAST, ValuesError, frame_values, is_covered
from lumitip.twin import Model, Twin
from lumitip.twin.optics import FULL, GAP_MM, drive_of_values
from lumitip.twin.scene import MOST_DIAMETER_MM

DIAMETER_MM = 3.0
"""Default diameter of a cable (mm)."""
LEAST_DIAMETER_MM = 0.3
"""Thinner cables take too little light to be found (mm)."""
NOISE = 1.5
"""Expected standard deviation of a value (counts of 255)."""
GAIN_ERROR = 0.01
"""Expected deviation of a cell's light from its empty grasp, as a share."""
HUBER = 3.0
"""Standard deviations beyond which the loss grows linearly."""
_BLURRED = np.array([np.radians(ANGLE_SD_DEG), OFFSET_SD_MM])
_MOST_COUNTS = dict.fromkeys(KINDS, 0.5 * MISFIT_COUNTS) | {BENT: 0.25 * MISFIT_COUNTS}
_END_COUNTS = 3.0  # from an end of the scale
_SAME = 0.05  # share of light by which a dead cell may change
_WORSE = 1.3  # times the least misfit since the last search, beyond which a tracker searches again


class EstimationError(LumitipError, ValueError):
    """A request that an estimator cannot fulfil."""


class PoseEstimator:
    """`estimate = PoseEstimator(layout)(values)`: template bank, then least squares.

    With `tracking` it follows one fingertip, from one thread.
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
        gap_sd_mm: float = GAP_SD_MM,
        alpha_sd: float = ALPHA_SD,
        place_sd_mm: float = PLACE_SD_MM,
        border_sd_mm: float = BORDER_SD_MM,
    ) -> None:
        """Prepare tables for the optics of a design.

        Args:
            layout: the cells.
            optics: by default those of the layout; or a whole model, which has its own gap.
            gap_mm: from skin to skin (mm).
            diameter_mm: of a cable; its width is found within about a third of it (mm).
            gains: light of each cell relative to its empty grasp, see `learn`, shape `(cells,)`.
            tracking: start from the frame before, and search again if that fits badly.
            noise: standard deviation of a value (counts of 255).
            gain_error: deviation of a cell's light from its empty grasp, as a share.
            huber: standard deviations beyond which the loss grows linearly.
            gap_sd_mm: standard deviation of the gap, 0 if it is known (mm).
            alpha_sd: standard deviation of the scattered share, 0 if it is known.
            place_sd_mm: standard deviation of a cell's place across the light, 0 if LED, detector
                and holes are exactly in line (mm).
            border_sd_mm: standard deviation of the shadow of a sheet's border, 0 if the sheet is
                thin and opaque (mm).

        Raises:
            LayoutError: if `layout` is no layout.
            EstimationError: if the layout has fewer than four cells, or another argument is
                invalid.
            TwinError: if the optics are invalid.
        """
        self.layout = arguments.layout(layout)
        if len(layout) < LEAST_CELLS:
            raise EstimationError(
                f"layout has {len(layout)} cells; a pose needs at least {LEAST_CELLS}; "
                "`Processor` works with fewer"
            )
        self._mirrored = collinear(layout.x_mm, layout.y_mm)
        self.model = _model(layout, optics, gap_mm)
        self._noise = _number(noise, "noise", above=0.0)
        self._gain_error = _number(gain_error, "gain_error")
        self._huber = _number(huber, "huber", above=0.0)
        self._moved = (
            _number(place_sd_mm, "place_sd_mm"),
            _number(border_sd_mm, "border_sd_mm"),
        )
        search_settings = (
            _number(diameter_mm, "diameter_mm", LEAST_DIAMETER_MM, MOST_DIAMETER_MM),
            _number(gap_sd_mm, "gap_sd_mm"),
            _number(alpha_sd, "alpha_sd", most=1.0),
        )
        self._gains = np.ones(len(layout)) if gains is None else _gains(layout, gains)
        twin = Twin(layout, self.model)
        self._search = Search(twin, *search_settings)
        self._tracking = tracking
        self._last: Last | None = None
        steps = np.arange(0.0, FULL + 1.0)[:, None] * (twin.empty / FULL)
        self._light = drive_of_values(steps, self.model) / twin.drive
        self._rise = np.gradient(self._light, axis=0)

    def __repr__(self) -> str:
        return f"<PoseEstimator of {self.layout!r}, tracking {self._tracking}>"

    def __call__(self, values: ArrayLike, kind: str | None = None) -> Estimate:
        """The pose in one frame.

        Args:
            values: calibrated values, 255 is full light, shape `(cells,)`; cells whose value is
                not finite, or beyond a billion, are left out: fewer than four others show nothing.
            kind: `"edge"`, `"cable"` or `"corner"`; `None` decides.

        Raises:
            ValuesError: if there is another number of values, or they are no numbers.
            EstimationError: if the kind is unknown.
        """
        if kind is not None:
            _known(kind)
        read = frame_values(values, self.layout)
        usable = usable_cells(read)
        frame = self._of_object(read, usable, kind)
        if frame is None:
            self._last = None
            return without_contact("covered" if is_covered(read[usable]) else "none", usable)
        name, found = self._found(frame, kind)
        shape = self._search.shape(name)
        free = drifting(shape, found, self._search.drifts)
        uncertain = covariance(free)
        if name == "edge":
            deviations = np.sqrt(np.abs(np.diag(uncertain))[:2])
            if np.any(deviations > _BLURRED):
                free = replace(free, pose=likely(shape, free, deviations))
        uncertain = uncertain + misplaced(shape, free, *self._moved)
        dead = usable & (found.frame.scale == 0.0)
        flags = ("dead",) if dead.any() else ()
        estimate = report(shape, free, uncertain, self._search.reach_mm, self._mirrored, flags)
        self._last = after(self._last, name, found, estimate, dead) if self._tracking else None
        return estimate

    def prepare(self, *kinds: str) -> "PoseEstimator":
        """Build the tables now and not with the first frame; of a cable this takes about a second.

        Args:
            kinds: `"edge"`, `"cable"`, `"corner"`; by default all, which `kind=None` may need.

        Returns:
            The estimator.

        Raises:
            EstimationError: if a kind is unknown.
        """
        for kind in kinds:
            _known(kind)
        for kind in kinds or KINDS:
            self._search.bank(kind)
        return self

    def fitted(self, values: ArrayLike, kind: str, free: bool = False) -> Fit:
        """The fit of a kind with the expected optics.

        Args:
            values: of one frame, as for a call.
            kind: `"edge"`, `"cable"` or `"corner"`.
            free: fit gap and scattered share as well.

        Raises:
            ValuesError: as for a call, or if fewer than four cells remain.
            EstimationError: if the kind is unknown.
        """
        _known(kind)
        read = frame_values(values, self.layout)
        usable = usable_cells(read)
        if np.count_nonzero(usable) < LEAST_CELLS:
            raise ValuesError(
                f"{np.count_nonzero(usable)} cells have finite values; at least "
                f"{LEAST_CELLS} are needed"
            )
        frame = self.frame(read, usable)
        found = self._search.best(kind, frame)
        frame = frame.without(found.frame.scale == 0.0)
        return (self._search.free if free else self._search.expected)(kind, found, frame)

    def optics_at(self, drift: Floats) -> Model:
        """Optics of a drift of a free fit, shape `(drifts,)`."""
        return self._search.optics_at(drift)

    def with_gains(self, gains: ArrayLike) -> "PoseEstimator":
        """An estimator with other gains of the cells, which shares the tables."""
        other = copy(self)
        other._gains = _gains(self.layout, gains)
        other.reset()
        return other

    def reset(self) -> None:
        """Forget the frame before."""
        self._last = None

    @property
    def search(self) -> Search:
        """Tables and shapes of the expected optics."""
        return self._search

    def frame(self, values: Floats, usable: NDArray[np.bool_]) -> Frame:
        """Values of one frame or of several, shape `(..., cells)`, as a fit needs them."""
        values = np.clip(np.where(usable, values, FULL), 0.0, FULL)
        whole = np.minimum(values.astype(np.int64), int(FULL) - 1)
        each = np.arange(values.shape[-1])
        low = self._light[whole, each]
        light = low + (values - whole) * (self._light[whole + 1, each] - low)
        rise = self._rise[whole, each]
        deviation = np.hypot(self._noise * rise, self._gain_error * light)
        scale = usable * self._gains / deviation
        full = values > FULL - 1.0
        stuck = (values <= _END_COUNTS) | (values >= FULL - _END_COUNTS)
        counts = self._gains / rise
        return Frame(light / self._gains, scale, counts, full, self._huber, stuck)

    def _of_object(self, read: Floats, usable: NDArray[np.bool_], kind: str | None) -> Frame | None:
        """The frame if it shows an object: by its contrast or, where that is faint, by its likeness
        to a cable of the bank."""
        known = read[usable]
        seen = contrast(known) if known.size >= LEAST_CELLS else 0.0
        if seen < FAINT_CONTRAST:
            return None
        frame = self.frame(read, usable)
        if seen >= MIN_CONTRAST:
            return frame
        faint = not is_covered(known) and self._search.resembles(kind, frame)
        return frame if faint else None

    def _found(self, frame: Frame, kind: str | None) -> tuple[str, Fit]:
        search, last = self._search, self._last
        if last is not None and kind in (None, search.shape(last.name).kind):
            same = np.abs(frame.light - last.light) < _SAME
            alive = frame.without(last.dead & same)
            followed = search.near(last.name, last.pose, alive, last.rivals)
            bearable = max(_MOST_COUNTS[last.name], _WORSE * last.misfit_counts)
            if rms_counts(followed) < bearable:
                return last.name, followed
            self._last = None
            if kind is not None:
                return search.again(last.name, last.pose, followed, alive)
        self._last = None
        return (kind, search.best(kind, frame)) if kind else search.decided(frame)


def _known(kind: str) -> None:
    if kind not in KINDS:
        raise EstimationError(f"kind is {kind!r}; allowed are {', '.join(KINDS)} and None")


def _number(
    value: object, name: str, least: float = 0.0, most: float = math.inf, above: float = -math.inf
) -> float:
    return arguments.number(value, name, least, most, above=above, error=EstimationError)


def _model(layout: Layout, optics: Optics | Model | None, gap_mm: float) -> Model:
    if isinstance(optics, Model):
        return optics
    if optics is not None and not isinstance(optics, Optics):
        raise EstimationError(f"optics is {optics!r:.40}; a layout's optics or a Model is needed")
    return Model.from_layout(replace(layout, optics=optics) if optics else layout, gap_mm)


def _gains(layout: Layout, gains: ArrayLike) -> Floats:
    numbers = arguments.numbers(gains, "gains", EstimationError)
    if numbers.shape != (len(layout),) or not (np.isfinite(numbers) & (numbers > 0.0)).all():
        raise EstimationError(f"gains is {gains!r:.40}; {len(layout)} numbers above 0 are needed")
    return numbers.copy()
