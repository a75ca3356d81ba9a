"""Fingertips and frames of the second optical model, and the Cramér–Rao bound of their poses."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from lumitip.calibration import Calibration
from lumitip.grid import Floats
from lumitip.layout import Layout
from poses import ANGLE_DEG, OFFSET_MM, Trial
from second_light import Light
from second_specimen import (
    EXPONENT,
    EXPONENT_SD,
    LEVEL,
    LEVEL_SD,
    Electronics,
    Specimen,
    drawn_electronics,
)
from second_tips import DEVIATIONS, Tips, drawn

TARE_FRAMES = 50
TARED = 0.002
"""Standard deviation of a cell's gain just after the empty grasp was measured (noise of it)."""
DRIFTED = 0.06
"""The same after the cells' gains have changed."""
CABLE_MM = 3.0
_CABLE_SD_MM = 0.1
_SHEET_MM, _SHEET_SD_MM = 0.4, 0.15
_PASSED, _PASSED_SD = 0.03, 0.015
_ALBEDO, _ALBEDO_SD = 0.3, 0.1
_POSE_SD = (1.0, 5.0)  # prior of offset (mm) and angle (degrees), as in bench_estimation
_POSE_STEP = (0.1, 0.5)


@dataclass(frozen=True, eq=False)
class Finger:
    """A pair of fingertips with electronics, tared with an empty grasp."""

    light: Light
    electronics: Electronics
    empty: Floats
    """Mean complement of the codes in the empty grasp, shape `(cells,)`."""

    @classmethod
    def tared(cls, light: Light, electronics: Electronics, chance: np.random.Generator) -> "Finger":
        """Measure the empty grasp as a user does, before the gains drift."""
        share = np.tile(light.full / light.full.max(), (TARE_FRAMES, 1))
        codes = electronics.codes(share, chance, drifted=False).astype(np.float32)
        reference = Calibration("second", "second").measured("empty", codes).empty
        assert reference is not None
        return cls(light, electronics, reference.astype(np.float64))

    def values(self, specimen: Specimen, chance: np.random.Generator) -> Floats:
        """Calibrated values of one frame, 0 to 255."""
        codes = self.electronics.codes(self._share(specimen), chance)
        return np.asarray(np.clip(codes * (255.0 / self.empty), 0.0, 255.0))

    def _share(self, specimen: Specimen) -> Floats:
        return np.asarray(self.light.light(specimen) / self.light.full.max())


def lights(layout: Layout, count: int, seed: int) -> list[Light]:
    """Random fingertip pairs."""
    return [
        Light.of(layout, drawn(np.random.default_rng((2, seed + n))), seed + n)
        for n in range(count)
    ]


def fingers(found: list[Light], seed: int, drift: float) -> list[Finger]:
    """Fingertips with random electronics.

    Args:
        found: their light.
        seed: of the electronics.
        drift: spread of the cells' gains after the empty grasp was measured.
    """
    chance = np.random.default_rng((4, seed))
    return [
        Finger.tared(light, drawn_electronics(chance, light.full.size, drift), chance)
        for light in found
    ]


def specimen(kind: str, pose: tuple[float, float], chance: np.random.Generator) -> Specimen:
    """A specimen of random size and material at a pose."""
    one, two, three = np.clip(chance.standard_normal(3), -1.8, 1.8)
    cable = kind == "cable"
    size_mm = CABLE_MM + _CABLE_SD_MM * one if cable else _SHEET_MM + _SHEET_SD_MM * one
    passed = 0.0 if cable else _PASSED + _PASSED_SD * two
    return Specimen(kind, *pose, size_mm, 0.0, passed, _ALBEDO + _ALBEDO_SD * three)


def trials(tips: list[Finger], kind: str, count: int, seed: int) -> list[Trial]:
    """Frames of random poses, shared evenly among fingertips."""
    chance = np.random.default_rng((3, seed))
    found = []
    for number in range(count):
        finger = tips[number * len(tips) // count]
        pose = (chance.uniform(-OFFSET_MM, OFFSET_MM), chance.uniform(-ANGLE_DEG, ANGLE_DEG))
        of = specimen(kind, pose, chance)
        found.append(Trial(pose, finger.values(of, chance)))
    return found


class Bound:
    """Cramér–Rao bound of a pose while optics, electronics, specimen and gains are unknown.

    Derivatives are differences of the second model itself, with common random numbers, at the
    nominal optics. Each unknown has a normal prior with the deviation of its draws, and is
    integrated over (Schur complement).
    """

    def __init__(self, layout: Layout, seed: int = 0) -> None:
        """Trace the nominal optics, and each deviation to either side."""
        cells = np.ones(len(layout))
        self._electronics = Electronics(cells, cells)
        tips = Tips()

        def light(**changes: float) -> Light:
            return Light.of(layout, replace(tips, **changes), seed)

        self._nominal = light()
        self._either = [
            (
                light(**{name: getattr(tips, name) - sd}),
                light(**{name: getattr(tips, name) + sd}),
            )
            for name, sd in DEVIATIONS.items()
        ]

    def __call__(
        self, kind: str, pose: tuple[float, float], gain_sds: Sequence[float]
    ) -> list[Floats]:
        """Standard deviations of offset (mm) and angle (degrees), for each spread of the gains.

        Args:
            kind: `"edge"` or `"cable"`.
            pose: offset (mm) and angle (degrees).
            gain_sds: standard deviations of each cell's gain.
        """
        cable = kind == "cable"
        of = Specimen(
            kind, *pose, CABLE_MM if cable else _SHEET_MM, 0.0, 0.0 if cable else _PASSED, _ALBEDO
        )
        rows = [(high - low) / 2.0 for low, high in self._steps(of)]
        step_mm, step_deg = _POSE_STEP
        rows[0] *= _POSE_SD[0] / step_mm
        rows[1] *= _POSE_SD[1] / step_deg
        empty = self._electronics.light(self._nominal.full / self._nominal.full.max())
        values = self._values(self._nominal, of)
        noise = np.hypot(self._electronics.noise, np.sqrt(1.0 / 12.0)) * 255.0 / empty
        found = []
        for gain_sd in gain_sds:
            # Every row is the change of the values by a standard deviation of its prior.
            jacobian = np.concatenate([rows, np.diag(gain_sd * values)]) / noise
            information = jacobian @ jacobian.T + np.eye(len(jacobian))
            found.append(np.sqrt(np.diag(self._schur(information))) * _POSE_SD)
        return found

    @staticmethod
    def _schur(information: Floats) -> Floats:
        """Covariance of the first two entries."""
        cross = information[:2, 2:]
        left = information[:2, :2] - cross @ np.linalg.solve(information[2:, 2:], cross.T)
        return np.asarray(np.linalg.inv(left))

    def _steps(self, of: Specimen) -> Iterator[tuple[Floats, Floats]]:
        """Values a step below and above, for each unknown: pose, specimen, circuit, optics."""
        step_mm, step_deg = _POSE_STEP
        cable = of.kind == "cable"
        for name, step in (
            ("offset_mm", step_mm),
            ("angle_deg", step_deg),
            ("size_mm", _CABLE_SD_MM if cable else _SHEET_SD_MM),
            *(() if cable else (("passed", _PASSED_SD),)),
            ("albedo", _ALBEDO_SD),
        ):
            at = getattr(of, name)
            yield (
                self._values(self._nominal, replace(of, **{name: at - step})),
                self._values(self._nominal, replace(of, **{name: at + step})),
            )
        circuit = self._electronics
        for low, high in (
            tuple(replace(circuit, level=LEVEL + sd) for sd in (-LEVEL_SD, LEVEL_SD)),
            tuple(replace(circuit, exponent=EXPONENT + sd) for sd in (-EXPONENT_SD, EXPONENT_SD)),
        ):
            yield self._values(self._nominal, of, low), self._values(self._nominal, of, high)
        for below, above in self._either:
            yield self._values(below, of), self._values(above, of)

    def _values(self, light: Light, of: Specimen, circuit: Electronics | None = None) -> Floats:
        """Calibrated values without noise, uncut."""
        electronics = circuit or self._electronics
        brightest = light.full.max()
        empty = electronics.light(light.full / brightest)
        return np.asarray(255.0 * electronics.light(light.light(of) / brightest) / empty)
