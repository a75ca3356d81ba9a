"""`Search`: the best fit of a kind to a frame, over the whole fingertip or near a pose.

If the expected optics explain a frame, the fit uses them. Else the fingertip differs from the
expected one: the optics are free within their deviations, and a share of each cell's light is
uncertain, so that neither is mistaken for another pose.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from lumitip.estimation.bank import Bank, corners, lines
from lumitip.estimation.dead import without_dead
from lumitip.estimation.estimate import KINDS, rms_counts
from lumitip.estimation.fit import RIVAL, Fit, Frame, bounded, doubtful, fit, fits, poses_of
from lumitip.estimation.lookup import Lookup, between_borders
from lumitip.estimation.optics import at_drift, drifted
from lumitip.estimation.shapes import Bent, Cable, Cells, Corner, Edge, Shape
from lumitip.grid import Floats
from lumitip.twin import LineTable, Model, Twin

GAP_SD_MM, ALPHA_SD = 0.4, 0.12
"""Standard deviations of gap (mm) and scattered share. The gap also stands for the exponents and
the hole, which widen shadows in the same way."""
LOOSE = 0.06
"""Uncertain share of a cell's light on a fingertip that differs from the expected one."""
BENT = "bent"
"""A cable along an arc, which a tracker may find after a straight one."""
_BENDS_PER_MM = (-1.0 / 60.0, 0.0, 1.0 / 60.0)  # starts of the fit of a bent cable
_STARTS = 8  # poses of the bank that are then tried
_REFUTED = 15.0  # loss behind a tracked line, beyond which a rival of it is dropped
_GLANCE, _LOOK = 2, 5  # rounds of all starts, and of the best of them
_BEHIND = 20.0  # loss behind the best, beyond which a start is dropped
_FAINT_LEFT = 0.25  # share of a faint frame's variance that its best likeness may leave
_HOPELESS = 2.5  # times the residual of the best bank, beyond which a kind is not fitted
_SIMPLER = {"edge": 1.0, "cable": 1.1, "corner": 2.0}  # a corner also fits the frame of an edge
_CLEARLY = 2.5  # times its loss that a bend must save, since any misfit looks slightly bent


class Search:
    """Fits to frames of one fingertip; holds its tables and banks."""

    def __init__(self, twin: Twin, diameter_mm: float, gap_sd_mm: float, alpha_sd: float) -> None:
        """Prepare for the optics of a twin.

        Args:
            twin: of the expected fingertip.
            diameter_mm: of cables (mm).
            gap_sd_mm: standard deviation of the gap (mm); 0 if it is known.
            alpha_sd: standard deviation of the scattered share; 0 if it is known.
        """
        self._twin, self._diameter_mm = twin, diameter_mm
        self._drifted = drifted(twin.model, gap_sd_mm, alpha_sd)
        self.drifts = len(self._drifted)
        """Number of uncertain parameters of the optics."""
        self._cells = Cells(twin.layout.x_mm, twin.layout.y_mm)
        self._lines = lines(self._cells)
        self.reach_mm = float(self._lines[:, 1].max())
        """Distance from the origin beyond which no cell sees a line (mm)."""
        self._edge_table = Lookup([one.edge_table() for one in self._twins()])
        self._shapes: dict[str, Shape] = {}
        self._banks: dict[str, Bank] = {}

    def start(self, kind: str, frame: Frame) -> tuple[Floats, float]:
        """The best pose in the bank of a kind, see `Bank.best`."""
        return self.bank(kind).best(frame.light, (frame.scale > 0.0).astype(np.float64))

    def resembles(self, kind: str | None, frame: Frame) -> bool:
        """Whether a faint frame is like that of a cable. No edge is faint: what looks like one is a
        slope of the light, as after one side has drifted."""
        return kind in (None, "cable") and self.start("cable", frame)[1] < _FAINT_LEFT

    def plain(self, kind: str, pose: Floats, frame: Frame) -> Fit:
        """The fit with the expected optics from a pose of the bank."""
        return fit(self.shape(kind), self._full_pose(kind, pose, frame), frame)

    def best(self, kind: str, frame: Frame) -> Fit:
        """The best fit of a kind."""
        return self.alive(kind, self._best(kind, frame, self.start(kind, frame)[0]))

    def _best(self, kind: str, frame: Frame, pose: Floats) -> Fit:
        """The best fit of a kind to all cells, from the best pose of the bank."""
        found = self.plain(kind, pose, frame)
        if doubtful(found):
            return self._loose(kind, frame, found)
        # Cells see little of a thin cable: one elsewhere may look much the same.
        return self._of_several(kind, frame, found, found.pose) if kind == "cable" else found

    def alive(self, kind: str, found: Fit) -> Fit:
        """A fit to all cells or, if that is bad, without a few that nothing explains."""
        if not doubtful(found):
            return found
        full = partial(self._full_pose, kind)
        return without_dead(self.shape(kind), self.bank(kind), found, full) or found

    def _loose(self, kind: str, frame: Frame, plain: Fit, before: Floats | None = None) -> Fit:
        """The best fit of a kind to a fingertip that differs from the expected one.

        Args:
            kind: of the object.
            frame: the values.
            plain: the fit from the best pose of the bank; outliers mislead it less than the
                closest poses.
            before: pose of the frame before, which decides between similar fits.
        """
        loose = frame.looser(LOOSE)
        return self._of_several(kind, loose, self.loosely(kind, plain, frame), before)

    def _of_several(self, kind: str, frame: Frame, one: Fit, likely: Floats | None = None) -> Fit:
        """The best of the fits from the closest poses of the bank and of another one, with the
        optics as free as in that, and its rivals; of similar ones the closest to a likely pose."""
        shape, bank = self.shape(kind), self.bank(kind)
        starts = bank.closest(frame.light, frame.scale, _STARTS)
        poses = [self._full_pose(kind, pose, frame, one.drifts) for pose in starts]
        kept = self._kept([*fits(shape, np.array(poses), frame, _GLANCE), one])
        if not bank.elsewhere(one, kept):
            return fit(shape, kept[int(bounded(kept).argmin())].pose, frame)
        looked = fits(shape, np.array(poses_of(kept)), frame, _LOOK)
        losses = bounded(looked)
        first = looked[int(losses.argmin())]
        near = losses < losses.min() + RIVAL
        rivals = bank.elsewhere(first, [f for f, is_so in zip(looked, near, strict=True) if is_so])
        if likely is not None:
            similar = [first, *rivals]
            first = min(similar, key=lambda f: bank.distance(f.pose, likely))
            rivals = bank.elsewhere(first, similar)
        return replace(fit(shape, first.pose, frame), rivals=poses_of(rivals))

    def decided(self, frame: Frame) -> tuple[str, Fit]:
        """The kind that explains a frame best, and its fit; an edge is preferred."""
        starts = {"edge": self.start("edge", frame)}
        plain = self.plain("edge", starts["edge"][0], frame)
        if not doubtful(plain):
            return "edge", plain
        starts |= {name: self.start(name, frame) for name in KINDS[1:]}
        # If a template is equal to the frame, the residual is 0, or below it by rounding.
        most = _HOPELESS * max(min(left for _, left in starts.values()), 0.0)
        found = {}
        for name, (pose, left) in sorted(starts.items(), key=lambda item: item[1][1]):
            if left <= most:
                found[name] = self._best(name, frame, pose)
                if name != "corner" and not doubtful(found[name]):
                    return name, found[name]
        loose = {name: self.loosely(name, each, frame) for name, each in found.items()}
        likely = sorted(
            found, key=lambda n: _SIMPLER[n] * (loose[n].cost + 3.0 * found[n].pose.size)
        )
        best = likely[0], self.alive(likely[0], found[likely[0]])
        for name in likely[1:]:
            if not doubtful(best[1]):
                break
            other = self.alive(name, found[name])
            best = best if doubtful(other) else (name, other)
        return best

    @staticmethod
    def _kept(tried: list[Fit]) -> list[Fit]:
        """The fits that are not far behind the best."""
        losses = bounded(tried)
        return [tried[number] for number in np.flatnonzero(losses < losses.min() + _BEHIND)]

    def bent(self, starts: Sequence[tuple[str, Floats]], frame: Frame) -> Fit:
        """The best fit of a bent cable near one of several poses of `"cable"` or `BENT`."""
        shape, loose, straight = self.shape(BENT), frame.looser(LOOSE), len(Cable.names)
        tried: list[Fit] = []
        for name, pose in starts:
            end = len(self.shape(name).names)
            bends = (*_BENDS_PER_MM, *pose[straight:end])
            each = [np.concatenate([pose[:straight], [bend], pose[end:]]) for bend in bends]
            tried += fits(shape, np.array(each), loose, _LOOK)  # the loose frame misleads less
        return self.near(BENT, tried[int(bounded(tried).argmin())].pose, frame)

    def again(self, name: str, before: Floats, followed: Fit, frame: Frame) -> tuple[str, Fit]:
        """The best fit after the fit of a tracked line got worse: its name and itself.

        If the bank has no better pose, the line is where it was tracked, and bends. The bend of a
        cable is fitted if no straight line elsewhere explains the frame equally well.

        Args:
            name: of the tracked line: a kind, or `BENT`.
            before: its pose in the frame before.
            followed: the fit from there.
            frame: the values.
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
            return other[0], self.alive(*other)
        starts = [(name, before), (name, followed.pose), (kind, found.pose)]
        bent = self.bent(starts, frame)
        bends, stays = (
            float(bounded([self.loosely(*of, frame)])[0]) for of in ((BENT, bent), other)
        )
        least = RIVAL if other[0] == BENT else max(RIVAL, _CLEARLY * bends)
        if stays - bends > least:
            return BENT, bent
        return other if other[0] == BENT else (other[0], self.alive(*other))

    def near(self, kind: str, pose: Floats, frame: Frame, rivals: tuple[Floats, ...] = ()) -> Fit:
        """The fit from the pose of another frame, with free optics if they were free there.

        Args:
            kind: of the object.
            pose: in the other frame.
            frame: the values.
            rivals: of the pose there. They are followed too until the frames refute them, or one
                of them refutes the pose.
        """
        shape = self.shape(kind)
        free = pose.size > len(shape.names) + 2
        frame = frame.looser(LOOSE) if free else frame
        if not rivals:
            return fit(shape, pose, frame)
        followed = fits(shape, np.array([pose, *rivals]), frame)
        losses = bounded(followed)
        at = 0 if losses[0] < losses.min() + RIVAL else int(losses.argmin())
        left = [f for f, loss in zip(followed, losses, strict=True) if loss < losses[at] + _REFUTED]
        others = self.bank(shape.kind).elsewhere(followed[at], left)
        return replace(followed[at], rivals=poses_of(others))

    def loosely(self, kind: str, found: Fit, frame: Frame) -> Fit:
        """The same fit with free optics and uncertain light, to compare fits of several kinds."""
        return self.free(kind, found, frame.looser(LOOSE)) if found.frame is frame else found

    def expected(self, kind: str, found: Fit, frame: Frame) -> Fit:
        """The same fit with the expected optics."""
        if found.frame is frame:
            return found
        names = len(self.shape(kind).names)
        return fit(self.shape(kind), np.append(found.pose[:names], found.pose[-2:]), frame)

    def free(self, kind: str, found: Fit, frame: Frame) -> Fit:
        """The same fit with free optics."""
        return fit(self.shape(kind), self._free_pose(kind, found.pose), frame)

    def _free_pose(self, kind: str, pose: Floats) -> Floats:
        """A pose with drifts of the optics, which are 0 if it had none."""
        names = len(self.shape(kind).names)
        expected = pose.size == names + 2
        return np.insert(pose, [names] * self.drifts, 0.0) if expected else pose

    def optics_at(self, drift: Floats) -> Model:
        """Optics of a drift, shape `(drifts,)`."""
        return at_drift(self._twin.model, self._drifted, drift)

    def shape(self, kind: str) -> Shape:
        """The shape of a kind of object."""
        if kind not in self._shapes:
            if kind == "edge":
                self._shapes[kind] = Edge(self._cells, self._edge_table)
            elif kind == "corner":
                self._shapes[kind] = Corner(self._cells, self._edge_table)
            else:
                diameter_mm, beyond, edges = self._diameter_mm, list[LineTable](), list[LineTable]()
                for one in self._twins():
                    edges.append(one.edge_table())
                    cable = one.cable_table(diameter_mm)
                    beyond.append(between_borders(cable, edges[-1], diameter_mm))
                table = Lookup(beyond, edges)
                self._shapes |= {
                    "cable": Cable(self._cells, table, diameter_mm),
                    BENT: Bent(self._cells, table, diameter_mm),
                }
        return self._shapes[kind]

    def bank(self, kind: str) -> Bank:
        """The bank of a kind, built with its tables on first use."""
        if kind not in self._banks:
            poses = corners(self._cells) if kind == "corner" else self._lines
            every = np.ones(self._cells.x_mm.size)
            self._banks[kind] = Bank.of(self.shape(kind), poses, every)
        return self._banks[kind]

    def _twins(self) -> Iterator[Twin]:
        """Twins of the expected optics and of each drift, one at a time: they keep their tables."""
        for model in (self._twin.model, *self._drifted):
            yield Twin(self._twin.layout, model)

    def _full_pose(self, kind: str, pose: Floats, frame: Frame, drifts: int = 0) -> Floats:
        """A pose of the bank with all entries that a fit needs."""
        usable = frame.light[frame.scale > 0.0]
        light = taken = float(usable.max())
        if kind == "cable":
            pose = np.append(pose, self._diameter_mm)
        else:
            taken -= float(usable.min())
        return np.concatenate([pose, np.zeros(drifts), [light, taken]])
