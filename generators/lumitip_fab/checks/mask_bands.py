"""The black bands and the numbers of the flaps, as a page has them."""

import math
from collections.abc import Iterator

import numpy as np
import shapely

from lumitip_fab.checks.mask_flaps import Flap, side_mm
from lumitip_fab.checks.mask_holes import Placed
from lumitip_fab.checks.readers.mask_page import Page, PageError, Points
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Design

GLUE_MM = 1.9  # of clear film at the end of each flap
SHORT_MM = 2.0  # of a flap may be clear though it covers the side, for the glue
LEAK_MM2 = 0.01
_GRAZE_MM = 0.01
_SAME_MM = 0.01
_MIRROR_MM = 0.05
_CROSS_MM = 1.0  # from a mark to the middle of its cross's lines


def folds_of(page: Page, placed: Placed, registration: Points) -> tuple[Points, ...]:
    """The fold lines of a page: single straight lines but for the crosses of the marks.

    Args:
        page: the page.
        placed: where the sensor frame lies on it.
        registration: places of the marks, in the sensor frame.
    """
    lines = [
        placed.points(p.subpaths[0].corners)
        for p in page.painted
        if p.stroked
        and not p.filled
        and len(p.subpaths) == 1
        and len(p.subpaths[0].corners) == 2
        and not len(p.subpaths[0].controls)
    ]
    return tuple(
        line for line in lines if np.hypot(*(registration - line.mean(axis=0)).T).min() > _CROSS_MM
    )


def bands_of(page: Page, placed: Placed) -> tuple[Points, ...]:
    """The bands of a page: a black fill of nothing but four-cornered runs.

    Raises:
        PageError: if there is none.
    """
    fills = [
        p.subpaths
        for p in page.painted
        if p.filled
        and p.black
        and not p.even_odd
        and all(len(s.corners) == 4 and not len(s.controls) for s in p.subpaths)
    ]
    if not fills:
        raise PageError("no black bands on the flaps")
    return tuple(placed.points(s.corners) for s in max(fills, key=len))


def measure_bands(
    subject: str, flaps: tuple[Flap, ...], bands: tuple[Points, ...], edge: Points, design: Design
) -> Iterator[Measurement]:
    """Film over the finger's side that lets light through, and film that is left for the glue.

    Args:
        subject: the file.
        flaps: in the sensor frame.
        bands: in the sensor frame.
        edge: of the black.
        design: for the heights of the finger's sides.
    """
    black = shapely.union_all([shapely.Polygon(ring).buffer(_GRAZE_MM) for ring in (edge, *bands)])
    clear = [_on_side(flap, design).difference(black).area for flap in flaps]
    note = f"clear film over the finger's side, worst of {len(flaps)} flaps"
    yield Measurement("mask.bands", f"{subject} light", max(clear), 0, LEAK_MM2, "mm²", note)
    whole = shapely.union_all([shapely.Polygon(ring) for ring in bands])
    ends = [_end_mm(flap, whole) for flap in flaps]
    yield Measurement(
        "mask.bands",
        f"{subject} glue",
        min(ends),
        GLUE_MM,
        math.inf,
        "mm",
        "clear film at the end of a flap",
    )


def numbers_of(page: Page, placed: Placed, flaps: tuple[Flap, ...]) -> tuple[int, ...]:
    """The number printed on each flap; 0 where there is not exactly one."""
    middles = placed.points(page.texts.reshape(-1, 4, 2).mean(axis=1))
    numbers = [
        (int(word), shapely.Point(at))
        for word, at in zip(page.words, middles, strict=True)
        if word.isdecimal()
    ]
    found = []
    for flap in flaps:
        area = shapely.Polygon(flap.corners)
        on_it = [number for number, at in numbers if area.contains(at)]
        found.append(on_it[0] if len(on_it) == 1 else 0)
    return tuple(found)


def measure_numbers(subject: str, flaps: tuple[Flap, ...], numbers: tuple[int, ...]) -> Measurement:
    """Flaps out of order: the tip, the gripper end, then both sides from wide to narrow."""
    at = dict(zip(numbers, flaps, strict=True))
    wrong = len(set(range(1, len(flaps) + 1)) - at.keys())
    if not wrong:
        middles = {n: flap.fold.mean(axis=0) for n, flap in at.items()}
        up_mm = {n: float(middle[1]) for n, middle in middles.items()}
        wrong += max(up_mm, key=up_mm.__getitem__) != 1
        # A wide gripper end has more flaps than two, at the same height.
        wrong += sum(up_mm[n] > min(up_mm.values()) + _MIRROR_MM for n in (2, 3))
        for n in range(2, len(flaps), 2):
            wrong += not np.allclose(middles[n] * (-1.0, 1.0), middles[n + 1], atol=_MIRROR_MM)
            wrong += n > 4 and _width_mm(at[n]) > _width_mm(at[n - 1]) + _SAME_MM
    return Measurement("mask.numbers", subject, wrong, 0, 0, "flaps", "out of order")


def _width_mm(flap: Flap) -> float:
    return float(np.hypot(*(flap.fold[1] - flap.fold[0])))


def _on_side(flap: Flap, design: Design) -> shapely.Geometry:
    """The part of a flap, flat, that comes to lie on the finger's side when it is taut, but for
    what a flap shorter than the side's height lacks."""
    allowance = design.mask.allowance_mm
    height = float(side_mm(flap.fold, design).max()) - allowance
    reach = max(min(height, flap.length_mm - SHORT_MM), 0.0)
    strip = shapely.Polygon(np.concatenate([flap.fold, flap.fold[::-1] + reach * flap.outward]))
    return shapely.Polygon(flap.corners).intersection(strip)


def _end_mm(flap: Flap, bands: shapely.Geometry) -> float:
    """From the farthest black on a flap to its end."""
    inside = shapely.Polygon(flap.corners).buffer(-_GRAZE_MM).intersection(bands)
    corners = shapely.get_coordinates(inside)
    reached = float(((corners - flap.fold[0]) @ flap.outward).max()) if len(corners) else 0.0
    return flap.length_mm - reached
