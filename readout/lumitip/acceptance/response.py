"""Values that a pair of fingers with some deviations reads of the gauge."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from lumitip.acceptance.gauge import Gauge, in_gap
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Model
from lumitip.twin.built import Built, Light, Piece, Rays, turned
from lumitip.twin.optics import FULL, values_of_drive

_LEAST_GAP_MM, _LEAST_DEPTH_MM, _LEAST_HOLE_MM = 0.5, 0.05, 0.5
_LEAST_SCATTER = 0.05  # some light reaches every cell, wherever its hole is


@dataclass(frozen=True)
class Deviation:
    """One way in which fingers may differ from their drawing."""

    name: str
    title: str
    unit: str
    prior: float
    """Standard deviation that is expected before the gauge is measured: several times what
    making does, so that the gauge decides."""
    step: float
    """For the derivative."""


DEVIATIONS = (
    Deviation("receiver_x", "receiver's mask to the right", "mm", 1.0, 0.1),
    Deviation("receiver_y", "receiver's mask towards the tip", "mm", 1.0, 0.1),
    Deviation("receiver_turn", "receiver's mask turned left", "deg", 5.0, 0.5),
    Deviation("emitter_x", "emitter's mask to the right", "mm", 1.0, 0.1),
    Deviation("emitter_y", "emitter's mask towards the tip", "mm", 1.0, 0.1),
    Deviation("emitter_turn", "emitter's mask turned left", "deg", 5.0, 0.5),
    Deviation("gap", "gap beyond the gauge's", "mm", 1.5, 0.2),
    Deviation("tilt", "gap grows towards the tip", "deg", 1.0, 0.3),
    Deviation("scatter", "scattered share of the light", "", 0.4, 0.1),
    Deviation("receiver_silicone", "receiver's silicone thicker", "mm", 0.1, 0.14),
    Deviation("emitter_silicone", "emitter's silicone thicker", "mm", 0.1, 0.14),
    Deviation("hole", "holes wider", "mm", 0.3, 0.1),
    Deviation("finger_x", "emitter's finger to the right", "mm", 0.3, 0.1),
    Deviation("finger_y", "emitter's finger towards the tip", "mm", 0.3, 0.1),
)
"""Directions are those of the receiver's sensor frame."""
NAMES = tuple(each.name for each in DEVIATIONS)
PLAY_MM = 0.1
"""Standard deviation of a piece of the gauge across its line, of the play on its finger."""
PLAY_DEG = 0.3
"""That of its direction."""
CALLIPER_MM = 0.05
"""Standard deviation of a thickness that was measured with a calliper."""
_STEPS = np.array([each.step for each in DEVIATIONS])
_PLAY_STEP = 0.05  # mm or degrees


class Response:
    """The twin of fingers that are closed on each placement of a gauge.

    Arrays of deviations have the order of `DEVIATIONS`; after these comes the play of each
    placement across its line, to the left (mm), and then its turn to the left (degrees).
    """

    def __init__(self, layout: Layout, gauge: Gauge) -> None:
        """Choose the rays.

        Args:
            layout: of the design.
            gauge: of the same design.
        """
        self._layout, self._gauge = layout, gauge
        self.model = Model.from_layout(layout, gauge.gap_mm)
        self.rays = Rays(layout, self.model)
        self.priors: Floats = np.array(
            [each.prior for each in DEVIATIONS]
            + [PLAY_MM] * len(gauge.placements)
            + [PLAY_DEG] * len(gauge.placements)
        )
        """Standard deviations that are expected before the gauge is measured."""
        full = self._light(np.zeros(len(NAMES))).full
        self.drive: Floats = self.model.gain * full / full.max()
        """Photocurrent of each cell in the empty grasp of the drawing, see `values_of_drive`."""

    def likely(self, thicker_mm: tuple[float, float] | None) -> tuple[Floats, Floats]:
        """Deviations that are expected before the gauge is measured, and their standard deviations.

        Args:
            thicker_mm: silicone of receiver and emitter beyond the drawing, if it was measured.
        """
        expected, priors = np.zeros(len(self.priors)), self.priors.copy()
        if thicker_mm is not None:
            at = [NAMES.index(f"{end}_silicone") for end in ("receiver", "emitter")]
            expected[at], priors[at] = thicker_mm, CALLIPER_MM
        return expected, priors

    @property
    def scatter_range(self) -> tuple[float, float]:
        """Least and most deviation of the scattered share: beyond them nothing changes."""
        return _LEAST_SCATTER - self.model.alpha, 1.0 - self.model.alpha

    def values(self, deviations: Floats, drive: Floats) -> Floats:
        """Values without noise, 255 is the empty grasp, shape `(placements, cells)`.

        Args:
            deviations: of the fingers.
            drive: photocurrent of each cell in the empty grasp at this gap, shape `(cells,)`.
        """
        return self._read(deviations, self._light(deviations), drive)

    def jacobian(self, deviations: Floats, drive: Floats) -> Floats:
        """Change of the values per unit of each deviation, shape `(placements, cells, n)`."""
        light = self._light(deviations)
        columns = []
        for number in range(len(deviations)):
            own = number < len(NAMES)
            step = _STEPS[number] if own else _PLAY_STEP
            either = []
            for sign in (1.0, -1.0):
                moved = deviations.copy()
                moved[number] += sign * step
                either.append(self._read(moved, self._light(moved) if own else light, drive))
            columns.append((either[0] - either[1]) / (2.0 * step))
        return np.stack(columns, axis=-1)

    def pieces(self, deviations: Floats) -> list[Piece]:
        """The gauge in each placement, between fingers with these deviations."""
        of = named(deviations[: len(NAMES)])
        placed = []
        plays = deviations[len(NAMES) :].reshape(2, -1).T.tolist()
        for placement, (play_mm, turn_deg) in zip(self._gauge.placements, plays, strict=True):
            piece = in_gap(placement, self._gauge, self._gap_mm(deviations))
            left_mm = play_mm
            if placement.on == "emitter":
                angle = np.radians(piece.angle_deg)
                left_mm += of["finger_y"] * np.cos(angle) - of["finger_x"] * np.sin(angle)
            offset_mm, angle_deg = piece.offset_mm + float(left_mm), piece.angle_deg + turn_deg
            placed.append(replace(piece, offset_mm=offset_mm, angle_deg=angle_deg))
        return placed

    def _read(self, deviations: Floats, light: Light, drive: Floats) -> Floats:
        empty = np.maximum(values_of_drive(drive, self.model), 1.0)
        rows = [
            values_of_drive(drive * light.behind(piece), self.model)
            for piece in self.pieces(deviations)
        ]
        return np.asarray(np.array(rows) * (FULL / empty))

    @cached_property
    def nominal_jacobian(self) -> Floats:
        """That of the drawing."""
        return self.jacobian(np.zeros(len(self.priors)), self.drive)

    def _gap_mm(self, deviations: Floats) -> float:
        return max(self._gauge.gap_mm + float(deviations[NAMES.index("gap")]), _LEAST_GAP_MM)

    def _light(self, deviations: Floats) -> Light:
        return self.rays.of(self.built(deviations))

    def built(self, deviations: Floats) -> Built:
        """Fingers with these deviations."""
        of = named(deviations[: len(NAMES)])
        model, cells = self.model, np.stack([self._layout.x_mm, self._layout.y_mm])
        each = np.ones(cells.shape[1])
        beside = np.array([[of["finger_x"]], [of["finger_y"]]])
        masks = [
            turned(cells, of[f"{end}_turn"]) + np.array([[of[f"{end}_x"]], [of[f"{end}_y"]]])
            for end in ("emitter", "receiver")
        ]
        depths = [
            max(nominal + of[f"{end}_silicone"] / model.silicone_index, _LEAST_DEPTH_MM) * each
            for end, nominal in (
                ("emitter", model.emitter_depth_mm),
                ("receiver", model.detector_depth_mm),
            )
        ]
        tilted = np.tan(np.radians(of["tilt"])) * self._layout.y_mm
        half = np.maximum(self._gap_mm(deviations) + tilted, _LEAST_GAP_MM) / 2.0
        holes = np.maximum(model.hole_mm * self._layout.hole_share + of["hole"], _LEAST_HOLE_MM)
        return Built(
            led_mm=cells + beside,
            emitter_hole_mm=masks[0] + beside,
            receiver_hole_mm=masks[1],
            detector_mm=cells,
            hole_mm=np.stack([holes, holes]),
            led_depth_mm=depths[0],
            detector_depth_mm=depths[1],
            led_gap_mm=half,
            detector_gap_mm=half,
            alpha=float(np.clip(model.alpha + of["scatter"], _LEAST_SCATTER, 1.0)),
            led=each,
            detector=each,
            drift=each,
            exposure=1.0,
        )


def named(values: Floats | Sequence[float]) -> dict[str, float]:
    """Numbers in the order of `DEVIATIONS` by their names."""
    return dict(zip(NAMES, (float(v) for v in values), strict=True))
