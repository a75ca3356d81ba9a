"""Covariance of a pose: by the noise and the optics of its fit, and by what moves a shadow."""

import numpy as np

from lumitip.estimation.fit import Fit
from lumitip.estimation.shapes import Shape
from lumitip.grid import Floats

PLACE_SD_MM = 0.2
"""Standard deviation (mm) of the line along which a cell looks: LED, detector and both holes are
each a little off."""
BORDER_SD_MM = 0.1
"""Standard deviation (mm) of the shadow of a sheet's border: how thick it is, and what passes at
its border, is unknown. The borders of a cable move its middle to both sides.

Both were tuned on fingertips of the second optical model, as a whole: its light differs from the
twin's in other ways too. `bench_second_light.py` tests them on those of another seed."""
_PLACES = frozenset({"offset_mm", "x_mm", "y_mm"})
_REGULAR = 1e-6  # else an entry that no cell sees would have an infinite deviation


def covariance(found: Fit) -> Floats:
    """Covariance of a pose: the inverse normal matrix, scaled up if the misfit is too large."""
    spare = max(int(np.count_nonzero(found.frame.scale)) - found.pose.size, 1)
    return _inverse(found) * max(found.cost / spare, 1.0)


def misplaced(shape: Shape, found: Fit, place_sd_mm: float, border_sd_mm: float) -> Floats:
    """Covariance of a pose by what moves a shadow, shape `(p, p)`: cells that are off their places,
    each by itself, and the border of a sheet.

    If the light of the cells is off by `e`, the fit moves by `C J (w e)`: `C` is the inverse normal
    matrix, `J` has the slopes of the light, `w` the weights of the fit. The light of a cell off its
    place changes as by a move of the object.

    Args:
        shape: the object.
        found: the fit.
        place_sd_mm: standard deviation of a cell's place (mm).
        border_sd_mm: standard deviation of the shadow of a sheet's border (mm).
    """
    places = [at for at, name in enumerate(shape.names) if name in _PLACES]
    frame, taken = found.frame, found.pose[-1]
    share, slopes = shape.slopes(found.pose[None])
    light = np.array([*(-taken * slope[0] for slope in slopes), np.ones(share.size), -share[0]])
    off = place_sd_mm * np.sqrt((light[places] ** 2).sum(axis=0))
    weights = frame.scale**2 * frame.huber / np.maximum(frame.misses(found.model), frame.huber)
    weights[frame.full & (frame.light <= found.model)] = 0.0  # these would read the same
    moves = _inverse(found) @ (light * weights * off)
    added = np.asarray(moves @ moves.T)
    if shape.kind != "cable":
        added[places, places] += border_sd_mm**2
    return added


def _inverse(found: Fit) -> Floats:
    return np.asarray(np.linalg.inv(found.normal + _REGULAR * np.eye(found.pose.size)))
