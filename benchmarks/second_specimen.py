"""Specimens of the second optical model, and the electronics that read its light."""

from dataclasses import dataclass

import numpy as np

from second_optics import Floats


@dataclass(frozen=True)
class Specimen:
    """An edge, corner or cable in the gap.

    Lines have a direction and a signed distance from the origin along their left normal, as
    everywhere in the project; a sheet covers the right of its line.
    """

    kind: str
    """`"edge"`, `"corner"` or `"cable"`."""
    offset_mm: float = 0.0
    angle_deg: float = 0.0
    size_mm: float = 0.4
    """Thickness of a sheet, diameter of a cable (mm)."""
    clear: float = 0.0
    """Share of light that passes straight."""
    passed: float = 0.03
    """Share that passes diffusely."""
    albedo: float = 0.3
    """Share that is reflected diffusely."""
    second_offset_mm: float = 0.0
    """Of the second border of a corner, which covers the right of both (mm)."""
    second_angle_deg: float = 0.0

    def borders(self) -> Floats:
        """Cosine, sine and offset of each border, shape `(n, 3)`."""
        lines = [(self.angle_deg, self.offset_mm)]
        if self.kind == "corner":
            lines.append((self.second_angle_deg, self.second_offset_mm))
        return np.array([(np.cos(np.radians(a)), np.sin(np.radians(a)), o) for a, o in lines])


LEVEL, LEVEL_SD = 0.9, 0.03
"""Nominal level and its spread from fingertip to fingertip, see `Electronics`."""
EXPONENT, EXPONENT_SD = 1.03, 0.017
"""The same of the exponent."""


@dataclass(frozen=True, eq=False)
class Electronics:
    """Detectors, pull-ups and converter of a fingertip; arrays of shape `(cells,)`."""

    gains: Floats
    """Tolerance of each cell's LED and detector, 1 on average."""
    drift: Floats
    """Change of each cell's gain since the empty grasp was measured, 1 for none."""
    level: float = LEVEL
    """Current of the brightest cell as a share of the largest current of its pull-up."""
    exponent: float = EXPONENT
    """A phototransistor amplifies strong light a little more."""
    sharpness: float = 8.0
    """Of the onset of saturation."""
    noise: float = 1.5
    """Standard deviation of a code (counts of 255)."""

    def light(self, share: Floats, drifted: bool = True) -> Floats:
        """Complement of the codes, 0 to 255, without noise and rounding.

        Args:
            share: light of each cell, 1 for the brightest one in the empty grasp.
            drifted: after the drift.
        """
        gains = self.gains * self.drift if drifted else self.gains
        current = self.level * (gains * share) ** self.exponent
        return np.asarray(255.0 * current / (1.0 + current**self.sharpness) ** (1 / self.sharpness))

    def codes(self, share: Floats, chance: np.random.Generator, drifted: bool = True) -> Floats:
        """Complement of 8-bit codes, with noise, in whole counts."""
        light = self.light(share, drifted) + self.noise * chance.standard_normal(share.shape)
        return np.asarray(np.clip(np.floor(light), 0.0, 255.0))


def drawn_electronics(chance: np.random.Generator, cells: int, drift: float) -> Electronics:
    """Electronics with 6 % of tolerance in the cells.

    Args:
        chance: random numbers.
        cells: their number.
        drift: standard deviation of each cell's gain since the empty grasp was measured.
    """
    tolerance = np.clip(chance.standard_normal((2, cells)), -2.5, 2.5)
    return Electronics(
        1.0 + 0.06 * tolerance[0],
        1.0 + drift * tolerance[1],
        level=LEVEL + 0.05 * float(chance.uniform(-1.0, 1.0)),
        exponent=EXPONENT + 0.03 * float(chance.uniform(-1.0, 1.0)),
    )
