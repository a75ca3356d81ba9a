"""The holes of a printed mask: where each is, how large and how round."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from lumitip_fab.checks.readers.mask_page import Page, PageError, Points, Subpath
from lumitip_fab.design import Mask

Sizes = NDArray[np.float64]
_MARKS = 4


@dataclass(frozen=True, eq=False)
class Placed:
    """How sensor coordinates became sheet coordinates: x mirrored, two scales and a shift."""

    scale: tuple[float, float]
    origin: tuple[float, float]
    """Origin of the sensor frame, on the sheet."""
    residual_mm: float
    """Residual of the worst mark: turned or skewed sheets show here."""

    def points(self, sheet: Points) -> Points:
        """Points of the sheet in the sensor frame."""
        across, up = self.scale
        return (sheet - self.origin) / (-across, up)

    def subpath(self, on_sheet: Subpath) -> Subpath:
        """A run of the sheet in the sensor frame."""
        corners, controls = self.points(on_sheet.corners), self.points(on_sheet.controls)
        return replace(on_sheet, corners=corners, controls=controls)


def sizes_at(centres: Points, cells: Points, mask: Mask) -> Sizes:
    """Aperture of the cell nearest to each place, shape `(places,)` (mm)."""
    sizes = np.array(mask.holes_mm)
    return np.asarray(sizes[cKDTree(cells).query(centres)[1]]) if len(centres) else np.zeros(0)


def registration_of(page: Page) -> Points:
    """Centres of the marks of a page: circles of four cubics, stroked by themselves."""
    rings = [
        p.subpaths[0].corners.mean(axis=0)
        for p in page.painted
        if p.stroked
        and not p.filled
        and len(p.subpaths) == 1
        and len(p.subpaths[0].corners) == 4
        and len(p.subpaths[0].controls) == 8
    ]
    return np.array(rings).reshape(-1, 2)


def place(found: Points, mask: Mask) -> Placed:
    """Fit the sheet to its marks.

    Args:
        found: centres of the marks on the sheet, in any order.
        mask: for the places where they should be.

    Raises:
        PageError: if there are not four marks round a middle.
    """
    wanted = np.array(mask.registration)
    if len(found) != _MARKS:
        raise PageError(f"{len(found)} registration marks, {_MARKS} are needed")
    found, wanted = found[_corner_order(found)], wanted[_corner_order(wanted)]
    middle, nominal = found.mean(axis=0), wanted.mean(axis=0)
    off, reach = found - middle, wanted - nominal
    scale = (off * reach).sum(axis=0) / (reach * reach).sum(axis=0)
    if not (scale > 0).all():
        raise PageError("the registration marks are not at four corners")
    residual = float(np.hypot(*((off / scale) - reach).T).max())
    # The marks are the same in x and -x, so that their middle is the frame's origin in x.
    origin = middle - scale * nominal
    across, up = scale.tolist()
    return Placed((across, up), (float(origin[0]), float(origin[1])), residual)


def _corner_order(points: Points) -> list[int]:
    right, above = (points > points.mean(axis=0)).T
    return sorted(range(len(points)), key=lambda i: (bool(right[i]), bool(above[i])))


_HEXAGON = np.radians(np.arange(0, 360, 60))
_HANDLE = 0.5522847498  # of a cubic that follows a quarter circle, in radii
_CIRCLE_STEPS = 8  # of each cubic, for distances


@dataclass(frozen=True, eq=False)
class Black:
    """Edge, window and apertures."""

    edge: Points
    window: Points
    """Corners; none if there is no window."""
    centres: Points
    size_mm: Points
    """Across flats of a hexagon, diameter of a circle."""
    misshape_mm: Points
    """Worst corner of each, from a regular hexagon with flats to the tip, or from a circle."""
    round_: bool
    """Whether every aperture is a circle."""
    rings: tuple[Points, ...]
    """The apertures with their curves as short chords."""


def black_of(page: Page, placed: Placed) -> Black:
    """The black of a page: the black even-odd fill with the most runs.

    Raises:
        PageError: if there is none.
    """
    fills = [p.subpaths for p in page.painted if p.filled and p.black and p.even_odd]
    if not fills:
        raise PageError("no black even-odd fill")
    return sort_out(placed.subpath(s) for s in max(fills, key=len))


def cut_of(page: Page, placed: Placed) -> Points:
    """The cut line of a page: the stroked closed path, by itself, with the most corners.

    Raises:
        PageError: if there is none.
    """
    lines = [
        p.subpaths[0].corners
        for p in page.painted
        if p.stroked
        and not p.filled
        and len(p.subpaths) == 1
        and p.subpaths[0].closed
        and not len(p.subpaths[0].controls)
    ]
    if not lines or len(max(lines, key=len)) < 3:
        raise PageError("no line to cut along")
    return placed.points(max(lines, key=len))


def sort_out(runs: Iterable[Subpath]) -> Black:
    """Tell edge, window and apertures apart: the widest, the one of four straight sides, the rest.

    Raises:
        PageError: if nothing is left for apertures.
    """
    every = list(runs)
    if not every or min(len(run.corners) for run in every) < 3:
        raise PageError("the black is empty or has runs without area")
    edge = max(every, key=_spread)
    rest = [run for run in every if run is not edge]
    square = [r for r in rest if len(r.corners) == 4 and not len(r.controls)]
    holes = [r for r in rest if len(r.corners) != 4 or len(r.controls)]
    if not holes:
        raise PageError("the black has no apertures")
    centres = np.array([r.corners.mean(axis=0) for r in holes])
    sizes, misshapes = zip(*(_measured(r) for r in holes), strict=True)
    return Black(
        edge=edge.corners,
        window=square[0].corners if square else np.zeros((0, 2)),
        centres=centres,
        size_mm=np.array(sizes),
        misshape_mm=np.array(misshapes),
        round_=all(len(r.controls) for r in holes),
        rings=tuple(_flattened(r) for r in holes),
    )


def apart(a: Points, b: Points) -> float:
    """Greatest distance from any point of either set to the nearest of the other."""
    return max(_farthest(a, b), _farthest(b, a))


def _farthest(a: Points, b: Points) -> float:
    tree = shapely.STRtree(shapely.points(b))
    _, distance = tree.query_nearest(shapely.points(a), return_distance=True, all_matches=False)
    return float(distance.max())


def edges_apart(a: Points, b: Points) -> float:
    """Greatest distance from any corner of either ring to the other ring."""
    one, other = shapely.LinearRing(a), shapely.LinearRing(b)
    forth = shapely.distance(shapely.points(a), other).max()
    return float(max(forth, shapely.distance(shapely.points(b), one).max()))


def _spread(run: Subpath) -> float:
    left, low, right, high = run.extent
    return (right - left) * (high - low)


def _measured(run: Subpath) -> tuple[float, float]:
    """Size, and distance of the worst point from where the ideal shape of that size has it."""
    off = run.corners - run.corners.mean(axis=0)
    radius = float(np.hypot(*off.T).mean())
    if len(run.controls):
        reach = np.hypot(*(run.controls - run.corners.mean(axis=0)).T)
        handle = radius * np.hypot(1.0, _HANDLE)
        worst = max(np.abs(np.hypot(*off.T) - radius).max(), np.abs(reach - handle).max())
        return 2 * radius, float(worst) if len(off) == 4 else radius
    if len(off) != len(_HEXAGON):
        return 2 * radius, radius
    ideal = radius * np.stack([np.cos(_HEXAGON), np.sin(_HEXAGON)], axis=1)
    worst = np.hypot(*(off[:, None] - ideal[None]).transpose(2, 0, 1)).min(axis=0).max()
    return radius * float(np.sqrt(3)), float(worst)


def _flattened(run: Subpath) -> Points:
    if not len(run.controls):
        return run.corners
    t = np.linspace(0, 1, _CIRCLE_STEPS, endpoint=False)[:, None]
    ends = np.roll(run.corners, -1, axis=0)
    return np.concatenate(
        [
            (1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t * t * (1 - t) * c + t**3 * d
            for a, b, c, d in zip(
                run.corners, run.controls[::2], run.controls[1::2], ends, strict=True
            )
        ]
    )
