"""Smallest bend radius of a cable that a finger pulls along: an elastica between two ties.

The cable is taken as a thin elastic line of fixed length, in a plane, without weight or a set of
its own. Both ties hold it along the tool axis: one where the controller is, the other on the
finger, which moves across. Among all such curves it takes one of stationary bending energy (Euler's
elastica: A. E. H. Love, *A Treatise on the Mathematical Theory of Elasticity*, chapter XIX). The
angle to the tool axis is a sine series along the line, so that it is 0 at both ties; Newton's
method finds its coefficients, from the closed finger to the open one.
"""

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]

TERMS = 12
POINTS = 120
STEPS = 10
"""Places of the finger between closed and open."""
_MOST = 40  # steps of Newton's method
_ENOUGH = 1e-10


class _Line:
    """A line of length 1 by the coefficients of its angle."""

    def __init__(self) -> None:
        self.modes = np.pi * np.arange(1, TERMS + 1)
        s = (np.arange(POINTS) + 0.5) / POINTS
        self.sines = np.sin(np.outer(self.modes, s))
        self.ends = np.linspace(0.0, 1.0, POINTS + 1)
        self.slopes = self.modes[:, None] * np.cos(np.outer(self.modes, self.ends))

    def solved(self, start: Vector, run: float, across: float) -> Vector:
        """The coefficients for two ties, from those for ties nearby."""
        b, forces = start, self._forces(start)
        for _ in range(_MOST):
            angle = b @ self.sines
            cosine, sine = np.cos(angle), np.sin(angle)
            gaps = np.array([cosine.mean() - run, sine.mean() - across])
            pulls = self._pulls(cosine, sine)
            rest = self.modes**2 / 2 * b + forces @ pulls
            if max(np.abs(gaps).max(), np.abs(rest).max()) < _ENOUGH:
                break
            bent = (forces[0] * cosine + forces[1] * sine) * self.sines @ self.sines.T / POINTS
            stiff = np.diag(self.modes**2 / 2) - bent
            whole = np.block([[stiff, pulls.T], [pulls, np.zeros((2, 2))]])
            step = np.linalg.lstsq(whole, -np.concatenate([rest, gaps]), rcond=None)[0]
            step *= min(1.0, 0.5 / float(np.abs(step[:TERMS]).max(initial=1e-12)))
            b, forces = b + step[:TERMS], forces + step[TERMS:]
        return b

    def radius(self, b: Vector) -> float:
        """The smallest radius of a line."""
        return 1 / max(float(np.abs(b @ self.slopes).max()), 1e-9)

    def _pulls(self, cosine: Vector, sine: Vector) -> Vector:
        """Change of the ends' distances, along and across, with each coefficient."""
        return np.stack([-self.sines @ sine, self.sines @ cosine]) / POINTS

    def _forces(self, b: Vector) -> Vector:
        angle = b @ self.sines
        pulls = self._pulls(np.cos(angle), np.sin(angle))
        return np.asarray(np.linalg.lstsq(pulls.T, -(self.modes**2) / 2 * b, rcond=None)[0])


@lru_cache(maxsize=256)
def smallest_radius(run_mm: float, travel_mm: float, length_mm: float) -> tuple[float, float]:
    """The smallest radius, and how far across the finger then is.

    Args:
        run_mm: between the ties, along the tool axis.
        travel_mm: how far the finger moves across, from in line with the other tie.
        length_mm: of the cable between the ties, longer than their greatest distance.
    """
    line, run = _Line(), run_mm / length_mm
    b = np.zeros(TERMS)
    b[1] = _bow(run)
    found = []
    for across in np.linspace(0.0, travel_mm, STEPS + 1):
        b = line.solved(b, run, float(across) / length_mm)
        found.append((line.radius(b) * length_mm, float(across)))
    return min(found)


def _bow(run: float) -> float:
    """Amplitude of an angle of one wave, whose line of length 1 has its ends that far apart."""
    turns = np.sin(2 * math.pi * (np.arange(POINTS) + 0.5) / POINTS)
    low, high = 0.0, 2.404
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if np.cos(middle * turns).mean() > run else (low, middle)
    return low
