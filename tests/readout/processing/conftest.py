"""Objects of known pose over the cells of a layout, and the published cloth edge."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

from lumitip import Layout

Floats = NDArray[np.float64]


@pytest.fixture
def cloth_edge(published_values: Callable[[str], NDArray[np.uint8]]) -> NDArray[np.uint8]:
    """The published frame of a cloth edge, shape `(32,)`."""
    return published_values("cloth_edge")


@dataclass(frozen=True)
class Scene:
    """Light at each cell when an object of known pose lies between the fingers.

    A border is a step blurred by a Gaussian; `blur_mm` is its width from 10 to 90 %.
    """

    layout: Layout
    blur_mm: float

    def edge(self, angle_deg: float, offset_mm: float) -> Floats:
        """A half-plane, dark to the right of a line `offset_mm` to the left of the origin."""
        return 255.0 * (1.0 - self._inside(offset_mm - self._left_of((0.0, 0.0), angle_deg)))

    def cable(self, angle_deg: float, offset_mm: float, width_mm: float) -> Floats:
        """A strip about a line `offset_mm` to the left of the origin."""
        left_mm = self._left_of((0.0, 0.0), angle_deg) - offset_mm
        half = width_mm / 2.0
        return 255.0 * (1.0 - self._inside(half - left_mm) + self._inside(-half - left_mm))

    def corner(
        self,
        vertex_mm: tuple[float, float],
        angle_deg: float,
        opening_deg: float,
        dark: bool = True,
    ) -> Floats:
        """A wedge from its first ray counter-clockwise to its second, dark or the only light."""
        covered = self._inside(self._left_of(vertex_mm, angle_deg)) * self._inside(
            -self._left_of(vertex_mm, angle_deg + opening_deg)
        )
        return 255.0 * (1.0 - covered if dark else covered)

    def disc(self, centre_mm: tuple[float, float], radius_mm: float, dark: bool = True) -> Floats:
        """A disc, dark or the only light."""
        far_mm = np.hypot(self.layout.x_mm - centre_mm[0], self.layout.y_mm - centre_mm[1])
        covered = self._inside(radius_mm - far_mm)
        return 255.0 * (1.0 - covered if dark else covered)

    def _left_of(self, at_mm: tuple[float, float], angle_deg: float) -> Floats:
        angle = math.radians(angle_deg)
        return (self.layout.y_mm - at_mm[1]) * math.cos(angle) - (
            self.layout.x_mm - at_mm[0]
        ) * math.sin(angle)

    def _inside(self, depth_mm: Floats) -> Floats:
        sigmas = depth_mm / (self.blur_mm / 2.5631)
        return np.array([0.5 + 0.5 * math.erf(d / math.sqrt(2.0)) for d in sigmas])


@pytest.fixture
def scene() -> Callable[..., Scene]:
    """`scene(layout, blur_mm)`."""
    return Scene
