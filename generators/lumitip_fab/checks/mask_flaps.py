"""The flaps of a mask, from its cut and fold lines: flat, folded onto the back, and their black
bands."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely

from lumitip_fab.checks.mask_holes import Placed
from lumitip_fab.checks.readers.mask_page import Page, PageError, Points
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Box, Design, Finger
from lumitip_fab.design.making import FOLD_OFF_MM

FILLETS_MM = 2.0  # at the foot of the coupling
NOTCH_MM = 0.25
REACH_MM = 0.8  # onto the back, less than which holds nothing
OVERLAP_MM2 = 0.01
_SAME_MM = 1e-3
GLUE_MM = 1.9  # of clear film at the end of each flap
SHORT_MM = 2.0  # of a flap may be clear though it covers the side, for the glue
LEAK_MM2 = 0.01
_GRAZE_MM = 0.01
_CROSS_MM = 1.0  # from a mark to the middle of its cross's lines


@dataclass(frozen=True, eq=False)
class Flap:
    """One flap in the sensor frame."""

    fold: Points
    corners: Points
    """From one end of the fold round to the other."""

    @property
    def outward(self) -> Points:
        """Unit vector away from the fold."""
        across = self.fold[1] - self.fold[0]
        normal: Points = np.array([across[1], -across[0]]) / np.hypot(*across)
        side = ((self.corners - self.fold[0]) @ normal).sum()
        return normal if side > 0 else -normal

    @property
    def length_mm(self) -> float:
        """From the fold to its outer edge."""
        return float(((self.corners - self.fold[0]) @ self.outward).max())


def flaps_of(cut: Points, folds: tuple[Points, ...]) -> tuple[Flap, ...]:
    """The flaps: what the cut goes round between the two ends of each fold.

    Raises:
        PageError: if a fold does not end at corners of the cut.
    """
    if not folds:
        raise PageError("no folds")
    flaps = []
    for fold in folds:
        apart = np.hypot(*(cut[:, None] - fold[None]).transpose(2, 0, 1))
        distance, at = apart.min(axis=0), apart.argmin(axis=0)
        if distance.max() > _SAME_MM:
            raise PageError("a fold does not end on the cut")
        first, last = sorted(int(i) for i in at)
        inner, outer = cut[first : last + 1], np.concatenate([cut[last:], cut[: first + 1]])
        flap = Flap(fold, min(inner, outer, key=len))
        if len(flap.corners) < 4:
            raise PageError("there is no flap on a fold")
        flaps.append(flap)
    return tuple(flaps)


def measure_flaps(
    subject: str,
    flaps: tuple[Flap, ...],
    corners: int,
    edge: Points,
    finger: Finger,
    design: Design,
) -> Iterator[Measurement]:
    """Flaps that overlap flat, folds off the black's edge, and what folded flaps come to cover.

    Args:
        subject: the file.
        flaps: in the sensor frame.
        corners: of the cut: neighbouring flaps share one.
        edge: of the black, in the same file.
        finger: whose back it is.
        design: for the heights of its sides and the coupling.
    """
    odd = abs(3 * len(flaps) + 1 - corners)
    note = f"of the cut more or less than {len(flaps)} flaps have"
    yield Measurement("mask.folds", f"{subject} count", odd, 0, 0, "corners", note)
    note = f"of {len(flaps)} flaps laid flat"
    yield Measurement("mask.flaps", subject, _overlap(flaps), 0, OVERLAP_MM2, "mm²", note)
    sagitta = max(_sagitta(flap.fold, edge) for flap in flaps)
    yield Measurement("mask.folds", subject, sagitta, 0, FOLD_OFF_MM, "mm", "chord to black's edge")
    sides = [float(side_mm(flap.fold, design).min()) for flap in flaps]
    back = shapely.union_all(
        [_on_back(f, s, design.mask.allowance_mm) for f, s in zip(flaps, sides, strict=True)]
    )
    keep = [("coupling", _coupling(design), FILLETS_MM), ("notch", finger.notch, NOTCH_MM)]
    keep += [("interface", interface.box, NOTCH_MM) for interface in design.interfaces]
    for name, box, least in keep:
        apart = float(shapely.distance(back, _area(box)))
        note = f"folded flaps to the {name}"
        yield Measurement("mask.folds", f"{subject} {name}", apart, least, math.inf, "mm", note)
    for relief in finger.reliefs:
        apart = float(shapely.distance(back, _area(relief.box)))
        note = "flaps to a window behind parts; for information"
        yield Measurement("mask.folds", f"{subject} window", apart, unit="mm", note=note)
    reaches = [
        f.length_mm + design.mask.allowance_mm - side for f, side in zip(flaps, sides, strict=True)
    ]
    yield Measurement(
        "mask.reach", subject, min(reaches), REACH_MM, math.inf, "mm", "shortest flap onto the back"
    )


def _overlap(flaps: tuple[Flap, ...]) -> float:
    """Area that two flaps share when the film is flat (mm²)."""
    areas = [shapely.Polygon(flap.corners).buffer(0) for flap in flaps]
    tree = shapely.STRtree(areas)
    pairs = tree.query(areas, predicate="intersects")
    ordered = pairs[:, pairs[0] < pairs[1]]
    each = np.array(areas, dtype=object)
    return float(shapely.area(shapely.intersection(each[ordered[0]], each[ordered[1]])).sum())


def _sagitta(fold: Points, edge: Points) -> float:
    """Greatest distance between a fold and the stretch of the edge beside it."""
    ring = shapely.LinearRing(edge)
    ends = [ring.project(shapely.Point(p)) for p in fold]
    low, high = min(ends), max(ends)
    there, line = np.array(ring.coords), shapely.LineString(fold)
    passed = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(there, axis=0).T))])
    inside = (passed >= low) & (passed <= high)
    if high - low > ring.length / 2:  # the fold spans the ring's first point
        inside = ~inside
    off = [float(shapely.distance(shapely.points(there[inside]), line).max(initial=0.0))]
    return max(*off, *(float(ring.distance(shapely.Point(p))) for p in fold))


def side_mm(fold: Points, design: Design) -> Points:
    """Heights of the finger's side along a fold; where it is least a flap reaches farthest."""
    outline, tip, mould, stack = design.outline, design.tip, design.mould, design.stack
    y = np.linspace(fold[0, 1], fold[1, 1], 17)
    plate = np.interp(y, [tip.slant_start_y_mm, outline.tip_y_mm], [stack.plate_mm, tip.edge_mm])
    for prop in design.props:  # the silicone round the tip stands higher than the back there
        plate = np.maximum(plate, prop.level_mm(y))
    tapered = [outline.tip_y_mm - mould.taper_length_mm, outline.tip_y_mm]
    silicone = np.interp(y, tapered, [stack.cover_mm, mould.tip_silicone_mm])
    return np.asarray(plate + silicone)


def _on_back(flap: Flap, side_mm: float, allowance_mm: float) -> shapely.Geometry:
    """Length of a flap on the back, when it is drawn tight over allowance and side."""
    outward, start = flap.outward, flap.fold[0]
    out = (flap.corners - start) @ outward
    along = flap.corners - out[:, None] * outward
    inward = out + allowance_mm - side_mm  # from the finger's edge, which is inside the fold
    laid = shapely.Polygon(along - (inward + allowance_mm)[:, None] * outward)
    edge = np.array([np.array([outward[1], -outward[0]]) * s for s in (-1e3, 1e3)]) + start
    edge = edge - allowance_mm * outward
    beyond = shapely.Polygon([*edge, edge[1] - 1e3 * outward, edge[0] - 1e3 * outward])
    return laid.buffer(0).intersection(beyond)


def _coupling(design: Design) -> Box:
    """Block, ramp and flare where they stand on the plate's back, without fillets."""
    mount, stack, half = design.mount, design.stack, design.mount.block_width_mm / 2
    end = mount.ramp_end_y_mm(stack.back_z_mm, stack.rim_z_mm) + mount.flare_mm
    return Box(-half, half, mount.origin_y_mm, end)


def _area(box: Box) -> shapely.Geometry:
    return shapely.box(*box.bounds_mm)


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
    note = "clear film at the end of a flap"
    yield Measurement("mask.bands", f"{subject} glue", min(ends), GLUE_MM, math.inf, "mm", note)


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
