"""A mask's page: paper, scale, marks, and the black area with its apertures; the wrapping note with
the figures of its flaps."""

import math
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray

from lumitip_fab.checks.mask_flaps import Flap, side_mm
from lumitip_fab.checks.mask_holes import Black, Placed, apart, edges_apart, sizes_at
from lumitip_fab.checks.readers.mask_page import Page, PageError, Painted, Points
from lumitip_fab.checks.result import Measurement, Subject, unreadable
from lumitip_fab.design import Box, Design, Finger, Mask

Shapes = NDArray[np.object_]

PAPER_MM = 0.1
PRINTABLE_MM = 5.0  # from every edge of the paper
SCALE = 0.001
RULER_MM = 0.02
MARK_MM = 0.05
PLACE_MM = 0.01
EDGE_MM = 0.05
WEB_MM = 0.4  # less tears, and leaks light
_TICKS = 101
ROUNDED_MM = 0.051  # the note has one decimal
TENTH_MM = 0.1  # reach: of the least height, which is sampled
_ROW = re.compile(r"^\| (\d+) \| ([\d.]+) \| ([\d.]+) \| (-?[\d.]+) \|$", re.MULTILINE)
_COUNT = re.compile(r"The (\d+) apertures")
_SIDE = re.compile(r"\(([\d.]+) mm of silicone and\s+plate\)")
_READINGS = re.compile(r"made for\s+`\[([\d.]+), ([\d.]+)\]`")
_F_CORNERS = 10


def measure_page(
    subject: str, page: Page, placed: Placed, paper_mm: tuple[float, float], mask: Mask
) -> Iterator[Measurement]:
    """Paper, margins, registration, scale, rulers, the letter F and fonts."""
    for side, got, wanted in zip(("width", "height"), page.size_mm, paper_mm, strict=True):
        yield Subject("mask", f"{subject} {side}").near("page", got, wanted, PAPER_MM)
    left, low, right, high = page.extent
    margin = min(left, low, page.size_mm[0] - right, page.size_mm[1] - high)
    note = "to the nearest edge"
    yield Measurement("mask.page", f"{subject} margin", margin, PRINTABLE_MM, math.inf, "mm", note)
    note = "worst of four registration marks"
    yield Measurement("mask.marks", subject, placed.residual_mm, 0, PLACE_MM, "mm", note)
    for axis, got, reading in zip("xy", placed.scale, mask.measured_ruler_mm, strict=True):
        wanted = 100 / reading
        note = f"a ruler measured {reading:g}"
        yield Measurement(
            f"mask.scale_{axis}", subject, got, wanted * (1 - SCALE), wanted * (1 + SCALE), "", note
        )
    yield from _rulers(subject, page, placed)
    yield from _letter(subject, page, placed, mask.mark)
    note = ", ".join(page.lacking) or "that are not embedded"
    yield Measurement("mask.fonts", subject, len(page.lacking), 0, 0, "fonts", note)


def measure_black(
    subject: str, page: Page, placed: Placed, black: Black, finger: Finger, design: Design
) -> Iterator[Measurement]:
    """The apertures against the cells, and the edge and the window against the finger."""
    mask, cells = design.mask, np.array(finger.cells)
    count = len(black.centres)
    yield Measurement("mask.count", subject, count, len(cells), len(cells), "apertures")
    worst = apart(black.centres, cells)
    yield Measurement("mask.position", subject, worst, 0, PLACE_MM, "mm", "worst aperture or cell")
    off = float(np.abs(black.size_mm - sizes_at(black.centres, cells, mask)).max())
    yield Measurement("mask.size", subject, off, 0, PLACE_MM, "mm", f"off {mask.sizes_text}")
    wrong = black.round_ != (mask.hole_shape == "circle")
    shape = math.inf if wrong else float(black.misshape_mm.max())
    yield Measurement("mask.shape", subject, shape, 0, PLACE_MM, "mm", f"off a {mask.hole_shape}")
    shapes = np.array([shapely.Polygon(ring) for ring in black.rings])
    web = _web(black, shapes, design.grid.pitch_mm)
    yield Measurement("mask.web", subject, web, WEB_MM, math.inf, "mm", "least between openings")
    outline = shapely.Polygon(design.outline.polygon(96)).buffer(mask.allowance_mm, 64)
    edge = edges_apart(black.edge, np.array(outline.exterior.coords)[:-1])
    note = f"off the finger's outline grown by {mask.allowance_mm:g}"
    yield Measurement("mask.outline", subject, edge, 0, EDGE_MM, "mm", note)
    if len(black.window):
        window = apart(black.window, _corners(finger.window))
        yield Measurement("mask.window", subject, window, 0, PLACE_MM, "mm", "worst corner")
    else:
        yield unreadable("mask.window", subject, "the black has no window for the connector")
    note = "other print to the nearest aperture"
    yield Measurement(
        "mask.clear", subject, _nearest_other(page, placed, shapes), 0.1, math.inf, "mm", note
    )


def measure_note(
    outputs: Path,
    subject: str,
    flaps: tuple[Flap, ...],
    numbers: tuple[int, ...],
    finger: Finger,
    design: Design,
) -> Iterator[Measurement]:
    """The table of flaps against the page's, and the other figures against the design.

    Raises:
        PageError: if the note is missing or does not state them.
    """
    try:
        text = (outputs / subject).read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise PageError(f"cannot be read: {error!r:.200}") from error
    count, side, readings = _COUNT.search(text), _SIDE.search(text), _READINGS.search(text)
    if not count or not side or (not readings and design.mask.route == "film"):
        raise PageError("does not state apertures, height of the side or readings")
    try:
        rows = {int(n): (float(w), float(h), float(r)) for n, w, h, r in _ROW.findall(text)}
        printed = np.array([float(v) for v in (count[1], side[1], *_groups(readings))])
    except ValueError as error:
        raise PageError(f"has a figure that is none: {error}") from error
    if not rows:
        raise PageError("does not state flaps")
    odd = len(set(numbers) ^ rows.keys())
    yield Measurement("mask.note", f"{subject} rows", odd, 0, 0, "flaps", "missing or too many")
    off = np.array(
        [
            np.abs(np.array(rows[n]) - _figures(flap, design))
            for n, flap in zip(numbers, flaps, strict=True)
            if n in rows
        ]
    ).reshape(-1, 3)
    for name, column, limit in (
        ("width", 0, ROUNDED_MM),
        ("length", 1, ROUNDED_MM),
        ("reach", 2, TENTH_MM),
    ):
        worst = float(off[:, column].max()) if len(off) else np.nan
        of = Subject("mask", f"{subject} {name}")
        yield of.figure("note", worst, 0, limit, note="worst row against the A4 page")
    whole = design.stack.plate_mm + design.stack.cover_mm
    wanted = np.array([len(finger.cells), whole, *design.mask.measured_ruler_mm])[: len(printed)]
    off_most, note = np.abs(printed - wanted).max(), "apertures, height of the side, readings"
    yield Subject("mask", f"{subject} figures").figure("note", off_most, 0, ROUNDED_MM, "", note)


def _groups(found: re.Match[str] | None) -> tuple[str, ...]:
    return found.groups() if found else ()


def _figures(flap: Flap, design: Design) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Width of the fold, length, and how far it lies onto the back, mm."""
    width = float(np.hypot(*(flap.fold[1] - flap.fold[0])))
    onto = flap.length_mm + design.mask.allowance_mm - float(side_mm(flap.fold, design).min())
    return np.array([width, flap.length_mm, onto])


def _rulers(subject: str, page: Page, placed: Placed) -> Iterator[Measurement]:
    """Length of both rulers by the scale of the marks."""
    lengths: dict[int, float] = {}
    for painted in page.painted:
        if painted.filled or len(painted.subpaths) < _TICKS:
            continue
        feet = np.array([placed.points(s.corners)[0] for s in painted.subpaths])
        spans = np.ptp(feet, axis=0)
        lengths[int(spans.argmax())] = float(spans.max())
    for axis, name in enumerate(("horizontal", "vertical")):
        if axis in lengths:
            of = Subject("mask", f"{subject} {name}")
            yield of.near("ruler", lengths[axis], 100, RULER_MM, "by the marks' scale")
        else:
            yield unreadable("mask.ruler", f"{subject} {name}", "no such ruler")


def _letter(subject: str, page: Page, placed: Placed, box: Box) -> Iterator[Measurement]:
    """The letter F reads right in the sensor frame: it is in place, stem left and arms up."""
    found = [
        placed.points(p.subpaths[0].corners)
        for p in page.painted
        if p.filled and len(p.subpaths) == 1 and len(p.subpaths[0].corners) == _F_CORNERS
    ]
    if len(found) != 1:
        yield unreadable("mask.mirrored", subject, f"{len(found)} letters F, one is needed")
        return
    letter = found[0]
    extent = np.array([letter.min(axis=0), letter.max(axis=0)])
    nominal = np.array([(box.x_min_mm, box.y_min_mm), (box.x_max_mm, box.y_max_mm)])
    place = float(np.abs(extent - nominal).max())
    yield Measurement("mask.mirrored", f"{subject} place", place, 0, MARK_MM, "mm", "of the F")
    middle = shapely.Polygon(letter).centroid
    left, up = extent.mean(axis=0) - (middle.x, middle.y)
    for name, share in (("stem", left / box.width_mm), ("arms", -up / box.length_mm)):
        note = f"the F's {name} by its centre of area"
        yield Measurement("mask.mirrored", f"{subject} {name}", float(share), 0.03, 0.5, "", note)


def _web(black: Black, shapes: Shapes, within_mm: float) -> float:
    """Least distance between two apertures, or from one to the window or the edge."""
    tree = shapely.STRtree(shapes)
    pairs = tree.query(shapes, predicate="dwithin", distance=within_mm)
    one, other = pairs[:, pairs[0] < pairs[1]]
    between = shapely.distance(shapes[one], shapes[other]).min(initial=within_mm)
    rings = [black.edge, black.window] if len(black.window) else [black.edge]
    around = min(float(shapely.distance(shapes, shapely.LinearRing(r)).min()) for r in rings)
    return min(float(between), around)


def _nearest_other(page: Page, placed: Placed, shapes: Shapes) -> float:
    """Least distance from an aperture to anything printed that is not the black."""
    most = max(len(p.subpaths) for p in page.painted if p.filled and p.even_odd and p.black)
    others = [
        _geometry(placed.points(run.corners), painted)
        for painted in page.painted
        if not (painted.even_odd and painted.black and len(painted.subpaths) == most)
        for run in painted.subpaths
    ]
    texts = placed.points(page.texts).reshape(-1, 4, 2)
    others += [shapely.Polygon(box) for box in texts]
    tree = shapely.STRtree(shapes)
    _, distance = tree.query_nearest(others, return_distance=True, all_matches=False)
    return float(distance.min(initial=math.inf))


def _geometry(corners: Points, painted: Painted) -> shapely.Geometry:
    if painted.filled and len(corners) > 2:
        return shapely.Polygon(corners).buffer(0)
    return shapely.LineString(corners) if len(corners) > 1 else shapely.Point(corners[0])


def _corners(box: Box) -> Points:
    return np.array(
        [(x, y) for x in (box.x_min_mm, box.x_max_mm) for y in (box.y_min_mm, box.y_max_mm)]
    )
