"""`Search`: from a frame to the best fit of a kind, over the whole fingertip or near a pose.

A frame that the expected optics explain is fitted with them. Where they do not, the fingertip is
another than was expected: then the optics are free within what is known of them, and some of each
cell's light is taken to be uncertain, so that neither is mistaken for another pose.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from lumitip.estimation.bank import Bank, corners, lines
from lumitip.estimation.fit import Fit, Frame, bounded, fit
from lumitip.estimation.lookup import Lookup
from lumitip.estimation.report import rms_counts
from lumitip.estimation.shapes import Bent, Cable, Cells, Corner, Edge, Shape
from lumitip.grid import Floats
from lumitip.twin import LineTable, Model, Twin

GAP_SD_MM, ALPHA_SD = 0.4, 0.12
"""Standard deviations of gap (mm) and scattered share. The gap stands for the exponents and the
hole as well, which widen shadows alike."""
LOOSE = 0.06
"""Share of a cell's light that is uncertain on a fingertip that is not as expected."""
BENT = "bent"
"""A cable along an arc, which a tracker may find where a straight one was."""
_LEAST_GAP_MM = 0.5
_BENDS_PER_MM = (-1.0 / 60.0, 0.0, 1.0 / 60.0)  # where the fit of a bent cable begins
_DOUBT = 1.3  # loss for each cell beyond which the fingertip is not as expected
_STARTS = 8  # how many are then tried
_GLANCE, _LOOK, _BEHIND = 2, 5, 20.0  # rounds of each and of the best; loss of the others
_RIVAL, _ELSEWHERE = 6.0, 2.0  # loss by which poses are nearly alike; poses that are not
_CLEARLY = 2.5  # times its loss that a bend must save: what no line explains looks bent a little


class Search:
    """Fits to frames of one fingertip; holds its tables and banks."""

    def __init__(self, twin: Twin, diameter_mm: float, gap_sd_mm: float, alpha_sd: float) -> None:
        """Prepare for the optics of a twin.

        Args:
            twin: as the fingertip is expected to be.
            diameter_mm: of cables (mm).
            gap_sd_mm: standard deviation of its gap (mm); 0 if it is known.
            alpha_sd: standard deviation of its scattered share; 0 if it is known.
        """
        self._twin, self._diameter_mm = twin, diameter_mm
        self._drifted = [Twin(twin.layout, m) for m in _drifted(twin.model, gap_sd_mm, alpha_sd)]
        self.drifts = len(self._drifted)
        """Things about the optics that may be off."""
        self._cells = Cells(twin.layout.x_mm, twin.layout.y_mm)
        self._lines = lines(self._cells)
        self.reach_mm = float(self._lines[:, 1].max())
        """Distance from the origin beyond which no cell sees a line (mm)."""
        self._edge_table = self._lookup(Twin.edge_table)
        self._shapes: dict[str, Shape] = {}
        self._banks: dict[str, Bank] = {}

    def prepare(self, kind: str) -> None:
        """Build shape and bank of a kind, which else its first frame waits for."""
        self._bank(kind)

    def start(self, kind: str, frame: Frame) -> tuple[Floats, float]:
        """The best pose of the bank of a kind, and the share of the frame that it leaves: see
        `Bank.best`."""
        return self._bank(kind).best(frame.light, (frame.scale > 0.0).astype(np.float64))

    def plain(self, kind: str, pose: Floats, frame: Frame) -> Fit:
        """The fit with the expected optics from a pose of the bank."""
        return fit(self.shape(kind), self._whole(kind, pose, frame), frame)

    def best(self, kind: str, frame: Frame, pose: Floats | None = None) -> Fit:
        """The best fit of a kind.

        Args:
            kind: what to fit.
            frame: what was read.
            pose: the bank's best, if it was asked already.
        """
        first = self.start(kind, frame)[0] if pose is None else pose
        found = self.plain(kind, first, frame)
        return self._loose(kind, frame, found) if doubtful(found) else found

    def _loose(self, kind: str, frame: Frame, plain: Fit, before: Floats | None = None) -> Fit:
        """The best fit of a kind to a fingertip that is not as expected.

        Args:
            kind: what to fit.
            frame: what was read.
            plain: from the bank's best, which a wild cell misleads less than the closest poses.
            before: pose of the frame before, which decides between poses that are nearly alike.
        """
        shape, loose = self.shape(kind), frame.looser(LOOSE)
        starts = self._bank(kind).closest(loose.light, loose.scale, _STARTS)
        whole = [self._whole(kind, pose, frame, self.drifts) for pose in starts]
        seen = [fit(shape, pose, loose, _GLANCE) for pose in whole]
        seen.append(self.loosely(kind, plain, frame))
        losses = [bounded(found) for found in seen]
        going = [f for f, loss in zip(seen, losses, strict=True) if loss < min(losses) + _BEHIND]
        fits = [fit(shape, found.pose, loose, _LOOK) for found in going]
        losses = [bounded(found) for found in fits]
        first, apart = fits[int(np.argmin(losses))], self._bank(kind).apart
        rivals = [
            f
            for f, loss in zip(fits, losses, strict=True)
            if loss < min(losses) + _RIVAL
            and _between(kind, f.pose, first.pose) @ apart > _ELSEWHERE
        ]
        if before is not None:
            first = min([first, *rivals], key=lambda f: _between(kind, f.pose, before) @ apart)
        return replace(fit(shape, first.pose, loose), ambiguous=bool(rivals))

    def bent(self, starts: Sequence[tuple[str, Floats]], frame: Frame) -> Fit:
        """The best fit of a cable that may bend, near one of several poses.

        Args:
            starts: names, `"cable"` or `BENT`, and poses.
            frame: what was read.
        """
        shape, loose, straight = self.shape(BENT), frame.looser(LOOSE), len(Cable.names)
        seen = []
        for name, pose in starts:
            end = len(self.shape(name).names)
            for bend in (*_BENDS_PER_MM, *pose[straight:end]):
                start = np.concatenate([pose[:straight], [bend], pose[end:]])
                seen.append(fit(shape, start, loose, _LOOK))  # which is led astray less
        return self.near(BENT, min(seen, key=bounded).pose, frame)

    def again(self, name: str, before: Floats, followed: Fit, frame: Frame) -> tuple[str, Fit]:
        """The best fit where one that followed the line got worse, and what it is of.

        If the bank knows nothing better the line is where it was followed to, and bends. Of a
        cable the bend is found: a straight line elsewhere must explain the frame as well.

        Args:
            name: what was followed: a kind, or `BENT`.
            before: its pose in the frame before.
            followed: the fit from there.
            frame: what was read.
        """
        kind = self.shape(name).kind
        found = self.plain(kind, self.start(kind, frame)[0], frame)
        if not doubtful(found):
            return kind, found
        if rms_counts(found) < rms_counts(followed):
            other = kind, self._loose(kind, frame, found, before)
        else:
            other = name, followed
        if kind != "cable":
            return other
        starts = [(name, before), (name, followed.pose), (kind, found.pose)]
        bent = self.bent(starts, frame)
        bends, stays = (bounded(self.loosely(*of, frame)) for of in ((BENT, bent), other))
        least = _RIVAL if other[0] == BENT else max(_RIVAL, _CLEARLY * bends)
        return (BENT, bent) if stays - bends > least else other

    def near(self, kind: str, pose: Floats, frame: Frame) -> Fit:
        """The fit from where another frame's fit ended, with the optics free if they were there."""
        shape = self.shape(kind)
        free = pose.size > len(shape.names) + 2
        return fit(shape, pose, frame.looser(LOOSE) if free else frame)

    def loosely(self, kind: str, found: Fit, frame: Frame) -> Fit:
        """The same fit with all as free as where the fingertip is not as expected, so that fits
        of several kinds compare."""
        if found.frame is not frame:
            return found
        names = len(self.shape(kind).names)
        start = np.insert(found.pose, [names] * self.drifts, 0.0)
        return fit(self.shape(kind), start, frame.looser(LOOSE))

    def expected(self, kind: str, found: Fit, frame: Frame) -> Fit:
        """The same fit with the expected optics."""
        if found.frame is frame:
            return found
        names = len(self.shape(kind).names)
        return fit(self.shape(kind), np.append(found.pose[:names], found.pose[-2:]), frame)

    def free(self, kind: str, found: Fit, frame: Frame) -> Fit:
        """The same fit with free optics, and each cell counting as much as the frame says."""
        names = len(self.shape(kind).names)
        pose = found.pose
        if pose.size == names + 2:
            pose = np.insert(pose, [names] * self.drifts, 0.0)
        return fit(self.shape(kind), pose, frame)

    def optics_at(self, drift: Floats) -> Model:
        """The optics that a drift stands for, shape `(drifts,)`."""
        model = self._twin.model
        steps = [
            (other.model.gap_mm - model.gap_mm, other.model.alpha - model.alpha)
            for other in self._drifted
        ]
        gap_mm, alpha = np.array([model.gap_mm, model.alpha]) + drift @ np.reshape(steps, (-1, 2))
        return model.changed(
            gap_mm=max(float(gap_mm), _LEAST_GAP_MM), alpha=min(max(float(alpha), 0.0), 1.0)
        )

    def shape(self, kind: str) -> Shape:
        """Effect of a kind of object on the cells."""
        if kind not in self._shapes:
            if kind == "edge":
                self._shapes[kind] = Edge(self._cells, self._edge_table)
            elif kind == "corner":
                self._shapes[kind] = Corner(self._cells, self._edge_table)
            else:
                table = self._lookup(lambda twin: twin.cable_table(self._diameter_mm))
                arguments = self._cells, table, self._edge_table, self._diameter_mm
                self._shapes |= {"cable": Cable(*arguments), BENT: Bent(*arguments)}
        return self._shapes[kind]

    def _bank(self, kind: str) -> Bank:
        if kind not in self._banks:
            poses = corners(self._cells) if kind == "corner" else self._lines
            every = np.ones(self._cells.x_mm.size)
            self._banks[kind] = Bank.of(self.shape(kind), poses, every)
        return self._banks[kind]

    def _lookup(self, table: Callable[[Twin], LineTable]) -> Lookup:
        return Lookup(table(self._twin), [table(twin) for twin in self._drifted])

    def _whole(self, kind: str, pose: Floats, frame: Frame, drifts: int = 0) -> Floats:
        """A pose of the bank with all that a fit needs."""
        usable = frame.light[frame.scale > 0.0]
        light = taken = float(usable.max())
        if kind == "cable":
            pose = np.append(pose, self._diameter_mm)
        else:
            taken -= float(usable.min())
        return np.concatenate([pose, np.zeros(drifts), [light, taken]])


def doubtful(found: Fit) -> bool:
    """Whether a fit leaves more than the expected optics would."""
    return found.cost > _DOUBT * int(np.count_nonzero(found.frame.scale))


def _drifted(model: Model, gap_sd_mm: float, alpha_sd: float) -> list[Model]:
    """The model with one thing off at a time, towards where it can be."""
    models = []
    if gap_sd_mm:
        models.append(model.changed(gap_mm=model.gap_mm + gap_sd_mm))
    if alpha_sd:
        step = alpha_sd if model.alpha + alpha_sd <= 1.0 else -alpha_sd
        models.append(model.changed(alpha=model.alpha + step))
    return models


def _between(kind: str, one: Floats, two: Floats) -> Floats:
    """How far two poses are from each other in each entry that a bank has."""
    entries = 4 if kind == "corner" else 2
    away = one[:entries] - two[:entries]
    turn = np.pi if kind == "cable" else 2.0 * np.pi  # an edge turned round covers the other side
    turns = np.round(away[0] / turn)
    away[0] -= turns * turn
    if kind == "cable" and turns % 2.0:
        away[1] = one[1] + two[1]  # the same line the other way round
    return np.abs(away)
