"""Sizes and materials of the fingertips of the second optical model, and how they differ."""

from dataclasses import dataclass, replace

import numpy as np

from second_connect import TABLE_DEG
from second_optics import Floats, Stack

_LEAST = 4e-8  # weight of most stored rays: a cell receives about 1e-3
_ROLL = 4.0  # exponent of the fall of a detector's response


@dataclass(frozen=True)
class Tips:
    """A pair of fingertips; lengths in mm."""

    gap_mm: float = 3.0
    film_mm: float = 0.1
    board_mm: float = 1.5
    """Depth of a board behind the inner face of its film."""
    led_depth_mm: float = 0.9
    """Depth of the LED die behind the inner face of the film."""
    detector_depth_mm: float = 0.9
    led_mm: float = 0.3
    """Side of the square die."""
    detector_mm: float = 0.4
    hole_mm: float = 2.5
    silicone_index: float = 1.41
    film_index: float = 1.52
    silicone_scatter_per_mm: float = 0.35
    silicone_forward: float = 0.8
    """Mean cosine of the scattering angle."""
    film_scatter_per_mm: float = 8.0
    film_forward: float = 0.5
    board_albedo: float = 0.45
    face_albedo: float = 0.06
    """Of the black faces of the films."""
    wall_albedo: float = 0.25
    emitter_x_mm: float = 0.0
    emitter_y_mm: float = 0.0
    ring: float = 0.15
    """Light of the LED in a ring at 28° above that of a Lambertian source."""
    acceptance_deg: float = 34.0
    """Angle in silicone at which a detector has half its response."""
    specimen_height: float = 0.5
    """Middle of the specimen, as a share of the gap above the receiver."""

    def stack(self) -> Stack:
        """The layers, for the kernels."""
        return Stack(
            gap=self.gap_mm,
            film=self.film_mm,
            board=self.board_mm,
            led_depth=self.led_depth_mm,
            detector_depth=self.detector_depth_mm,
            led_half=self.led_mm / 2.0,
            detector_half=self.detector_mm / 2.0,
            apothem=self.hole_mm / 2.0,
            silicone_index=self.silicone_index,
            film_index=self.film_index,
            silicone_scatter=self.silicone_scatter_per_mm,
            silicone_forward=self.silicone_forward,
            film_scatter=self.film_scatter_per_mm,
            film_forward=self.film_forward,
            board_albedo=self.board_albedo,
            film_albedo=self.face_albedo,
            wall_albedo=self.wall_albedo,
            face_albedo=self.face_albedo,
            emitter_x=self.emitter_x_mm,
            emitter_y=self.emitter_y_mm,
            specimen=self.specimen_height * self.gap_mm,
            least=_LEAST,
        )

    def lobe(self) -> Floats:
        """Light of the LED per steradian, every `TABLE_DEG` from its axis; its power is 1."""
        angle = np.arange(0.0, 90.0 + TABLE_DEG, TABLE_DEG)
        light = np.cos(np.radians(angle)) * (
            1.0 + self.ring * np.exp(-(((angle - 28.0) / 12.0) ** 2))
        )
        light[-1] = 0.0
        fine = np.radians(np.linspace(0.0, 90.0, 9001))
        shown = np.interp(np.degrees(fine), angle, light) * np.sin(fine)
        power = 2.0 * np.pi * float(np.sum(shown[1:] + shown[:-1]) / 2.0 * (fine[1] - fine[0]))
        return np.asarray(light / power)

    def response(self) -> Floats:
        """Response of a detector to light from angles of every `TABLE_DEG`."""
        angle = np.arange(0.0, 90.0 + TABLE_DEG, TABLE_DEG)
        return np.asarray(1.0 / (1.0 + (angle / self.acceptance_deg) ** _ROLL))


DEVIATIONS = {
    "gap_mm": 0.3,
    "led_depth_mm": 0.07,
    "detector_depth_mm": 0.07,
    "hole_mm": 0.06,
    "silicone_scatter_per_mm": 0.12,
    "film_scatter_per_mm": 2.5,
    "face_albedo": 0.02,
    "board_albedo": 0.12,
    "ring": 0.1,
    "acceptance_deg": 4.0,
    "emitter_x_mm": 0.1,
    "emitter_y_mm": 0.1,
    "specimen_height": 0.05,
}
"""Standard deviations of what differs from pair to pair and from grasp to grasp."""


def drawn(chance: np.random.Generator, tips: Tips | None = None) -> Tips:
    """Fingertips with random deviations, cut at two standard deviations."""
    tips = tips or Tips()
    changes = {
        name: getattr(tips, name) + sd * float(np.clip(chance.standard_normal(), -2.0, 2.0))
        for name, sd in DEVIATIONS.items()
    }
    return replace(tips, **changes)
