"""Rays from one LED to one detector, through both holes of the mask.

Light starts at the die (share 1 − alpha) or anywhere in the hole (alpha, scattered by silicone and
film), and ends at the detector in the same way. Each pair of points is a ray of weight
cos(angle) ** (m + n + 2) / D² with D the distance along the axis. LEDs at the same displacement
from their detector, behind the same holes, have the same rays, so a hexagonal grid of any size with
equal holes needs about twenty bundles.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from lumitip.grid import Floats
from lumitip.twin.optics import Model

REACH_MM = 12.6
"""LEDs further than this from a detector are neglected (mm)."""
ACROSS = 6
"""Points across half of a hole. Values at edges and cables differ by 0.15 counts rms, at most 1.3,
from those with 8 points."""
_SIN60 = np.sqrt(3.0) / 2.0


@dataclass(frozen=True, eq=False)
class Bundle:
    """Rays from an LED to a detector at the origin; arrays of shape `(rays,)`."""

    x_mm: Floats
    """Place where each ray crosses the receiver's mask (mm)."""
    y_mm: Floats
    across: Floats
    """Slope dx/dz, towards the emitter."""
    along: Floats
    """Slope dy/dz."""
    weight: Floats
    """Light that reaches the detector, on a scale common to all bundles."""

    def at(self, height_mm: float) -> tuple[Floats, Floats]:
        """Places where the rays cross a plane at this height above the receiver's mask (mm)."""
        return self.x_mm + height_mm * self.across, self.y_mm + height_mm * self.along


@lru_cache(maxsize=512)
def bundle(
    model: Model,
    dx_mm: float,
    dy_mm: float,
    holes: tuple[float, float] = (1.0, 1.0),
    across: int = ACROSS,
) -> Bundle:
    """Rays from an LED that is displaced by `(dx_mm, dy_mm)` from its detector (sensor frame).

    Args:
        model: optics; its gap is the distance of the masks.
        dx_mm: LED minus detector, in x (mm).
        dy_mm: in y (mm).
        holes: of the LED and of the detector, relative to the model's; see `Layout.hole_share`.
        across: points across half of a hole.
    """
    x, y = hole_points(model, across)
    spread = np.full(x.size, model.alpha / x.size)
    die = (np.zeros(1), np.zeros(1), np.array([1.0 - model.alpha]))
    led_hole, cell_hole = (
        (share * x, share * y, spread * relative_light(model, share, *die_of))
        for share, die_of in zip(holes, dies(model), strict=True)
    )
    parts = [
        _rays(model, (dx_mm, dy_mm), holes, (*source, up), (*target, down))
        for source, up in ((die, model.emitter_depth_mm), (led_hole, 0.0))
        for target, down in ((die, model.detector_depth_mm), (cell_hole, 0.0))
    ]
    return Bundle(*np.concatenate(parts, axis=1))


End = tuple[Floats, Floats, Floats, float]


def _rays(
    model: Model,
    shift_mm: tuple[float, float],
    holes: tuple[float, float],
    source: End,
    target: End,
) -> Floats:
    """Rays from points behind the emitter's mask to points behind the receiver's, as rows."""
    way_mm = source[3] + model.gap_mm + target[3]
    across = ((source[0] + shift_mm[0])[:, None] - target[0]).ravel() / way_mm
    along = ((source[1] + shift_mm[1])[:, None] - target[1]).ravel() / way_mm
    x = np.tile(target[0], source[0].size) + across * target[3]
    y = np.tile(target[1], source[1].size) + along * target[3]
    power = (model.led_exponent + model.detector_exponent + 2.0) / 2.0
    weight = np.outer(source[2], target[2]).ravel() / way_mm**2
    weight *= (1.0 + across**2 + along**2) ** -power
    from_hole, to_hole = (in_hole(model, share) for share in holes)
    through = to_hole(x, y) & from_hole(
        x + model.gap_mm * across - shift_mm[0], y + model.gap_mm * along - shift_mm[1]
    )
    return np.stack([x, y, across, along, weight])[:, through]


def dies(model: Model) -> tuple[tuple[float, float], tuple[float, float]]:
    """Equivalent depth (mm) and exponent of the lobe, of the LED and of the detector."""
    return (
        (model.emitter_depth_mm, model.led_exponent),
        (model.detector_depth_mm, model.detector_exponent),
    )


def relative_light(model: Model, share: float, depth_mm: float, exponent: float) -> float:
    """Light that falls from a die on a hole, relative to that on one of the model's size.

    What a hole scatters is in proportion to it. Of a lobe cos(angle) ** m, a circle seen under the
    half angle a holds 1 - cos(a) ** (m + 1).

    Args:
        model: optics; for the size of its hole, which counts as a circle here.
        share: size of the hole, relative to the model's.
        depth_mm: of the die, equivalent.
        exponent: of its lobe.
    """

    def held(radius_mm: float) -> float:
        return 1.0 - float((1.0 + (radius_mm / depth_mm) ** 2) ** (-(exponent + 1.0) / 2.0))

    return held(share * model.hole_mm / 2.0) / held(model.hole_mm / 2.0)


def in_hole(model: Model, share: float = 1.0) -> Callable[[Floats, Floats], np.ndarray]:
    """A function that finds the points (mm from the centre of a hole) within the hole, which has
    this share of the model's size."""
    apothem = share * model.hole_mm / 2.0 + 1e-9
    if model.hole_shape == "circle":
        return lambda x, y: x * x + y * y <= apothem**2
    return lambda x, y: (np.abs(y) <= apothem) & (_SIN60 * np.abs(x) + 0.5 * np.abs(y) <= apothem)


@lru_cache(maxsize=64)
def hole_points(model: Model, across: int = ACROSS) -> tuple[Floats, Floats]:
    """Points of equal areas of a hole, symmetric about both axes (mm)."""
    step = model.hole_mm / 2.0 / across
    # A hexagon is wider along x than across its flats.
    half = (np.arange(int(1.2 * across) + 1) + 0.5) * step
    line = np.concatenate([-half[::-1], half])
    x, y = (a.ravel() for a in np.meshgrid(line, line))
    within = in_hole(model)(x, y)
    return x[within], y[within]
