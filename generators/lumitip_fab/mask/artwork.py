"""The artwork of one finger's mask in its sensor frame, for film, printed sheet and plotter alike,
and where it stands on a page."""

import math
from dataclasses import dataclass

import numpy as np

from lumitip_fab.design import Box, Design, Finger, Mask, Point
from lumitip_fab.mask.flaps import Flap, make_flaps
from lumitip_fab.mask.outline import Finished, grown

Segment = tuple[Point, ...]
"""A straight line to one point, or a cubic over two control points to a third."""

NAME_WIDTH = 0.75  # of a bold capital, in font sizes
_ROUND = 4 / 3 * (math.sqrt(2) - 1)  # handle of a cubic that follows a quarter circle

# The letter F in a box of 0.7 x 1, counter-clockwise from its foot: the simplest shape that is
# its own image under no mirror and no turn.
_F = (
    (0.0, 0.0),
    (0.22, 0.0),
    (0.22, 0.4),
    (0.56, 0.4),
    (0.56, 0.6),
    (0.22, 0.6),
    (0.22, 0.8),
    (0.7, 0.8),
    (0.7, 1.0),
    (0.0, 1.0),
)


@dataclass(frozen=True)
class Path:
    """A closed path."""

    start: Point
    segments: tuple[Segment, ...]

    @property
    def corners(self) -> tuple[Point, ...]:
        """Start and ends of the segments, without repeating the start."""
        return self.start, *(s[-1] for s in self.segments if s[-1] != self.start)


@dataclass(frozen=True)
class Artwork:
    """Everything on the film."""

    name: str
    """Name of the finger."""
    black: Path
    """Edge of the black."""
    window: Path
    apertures: tuple[Path, ...]
    flaps: tuple[Flap, ...]
    cut: Path
    """Edge of the film."""
    mark: Path
    """The letter F."""
    name_at: Point
    """Left end of the finger's name's base line, beside the letter F on the tip flap."""
    name_mm: float
    """Its font size."""


def artwork_of(design: Design, finger: Finger, mask: Mask) -> Artwork:
    """The artwork of a finger of a design, with a mask that may have other holes."""
    wrapped = Finished(
        finger,
        design.outline,
        design.stack,
        design.tip,
        design.mould,
        design.mount,
        design.interfaces,
    )
    return make_artwork(wrapped, mask)


def make_artwork(finished: Finished, mask: Mask) -> Artwork:
    """Draw the mask of a finger.

    Args:
        finished: the finger to wrap.
        mask: apertures, allowance, flaps and marks.
    """
    finger, outline = finished.finger, finished.outline
    flaps = make_flaps(finished, mask)
    name_x = mask.mark.x_max_mm + 0.3 * mask.mark.length_mm
    room = -mask.mark.x_min_mm - name_x
    aperture = _circle if mask.hole_shape == "circle" else _hexagon
    return Artwork(
        name=finger.name.upper(),
        black=_polygon([(x, y) for x, y in grown(outline, mask.allowance_mm).tolist()]),
        window=_rectangle(finger.window),
        apertures=tuple(map(aperture, finger.cells, mask.holes_mm)),
        flaps=flaps,
        cut=_polygon([corner for flap in flaps for corner in flap.corners]),
        mark=_letter(mask.mark),
        name_at=(name_x, mask.mark.y_min_mm),
        name_mm=min(room / (NAME_WIDTH * len(finger.name)), mask.mark.length_mm),
    )


def _polygon(corners: list[Point]) -> Path:
    kept = [
        p
        for p, before in zip(corners, corners[-1:] + corners[:-1], strict=True)
        if math.dist(p, before) > 1e-9
    ]
    return Path(kept[0], tuple((p,) for p in kept[1:]))


def _rectangle(box: Box) -> Path:
    left, right, low, high = box.x_min_mm, box.x_max_mm, box.y_min_mm, box.y_max_mm
    return _polygon([(left, low), (right, low), (right, high), (left, high)])


def _letter(box: Box) -> Path:
    return _polygon(
        [(box.x_min_mm + u * box.length_mm, box.y_min_mm + v * box.length_mm) for u, v in _F]
    )


def _hexagon(centre: Point, across_flats_mm: float) -> Path:
    """Flats at the top and at the bottom, so that they face the tip."""
    radius = across_flats_mm / math.sqrt(3)
    return _polygon(
        [
            (centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle))
            for angle in np.radians(range(0, 360, 60)).tolist()
        ]
    )


def _circle(centre: Point, diameter_mm: float) -> Path:
    r = diameter_mm / 2
    handle = _ROUND * r

    def at(u: float, v: float) -> Point:
        return centre[0] + u, centre[1] + v

    return Path(
        at(r, 0),
        (
            (at(r, handle), at(handle, r), at(0, r)),
            (at(-handle, r), at(-r, handle), at(-r, 0)),
            (at(-r, -handle), at(-handle, -r), at(0, -r)),
            (at(handle, -r), at(r, -handle), at(r, 0)),
        ),
    )


PAPERS_MM = {"a4": (210.0, 297.0), "letter": (215.9, 279.4)}
RULER_MM = 100.0
HEADING_MM = 13.0  # above the artwork: two lines
FOOT_MM = 37.0  # below it: level ruler and notes
LEVEL_GAP_MM = 10.0  # artwork to level ruler
UPRIGHT_GAP_MM = 7.0  # artwork to upright ruler
NOTES_GAP_MM = 11.0  # level ruler to first note
LINE_MM = 4.4


@dataclass(frozen=True)
class Places:
    """Origins of the parts of a page."""

    artwork: Point
    """The sensor frame's origin; x is mirrored about it."""
    heading: Point
    level_ruler: Point
    """Its left end."""
    upright_ruler: Point
    """Its lower end."""
    notes: Point
    """Middle of the first line."""


def arrange(mask: Mask) -> Places:
    """Centre artwork, rulers and texts on the page, as compact as the rulers allow."""
    xs, ys = zip(*mask.registration, strict=True)
    half_height = max(max(ys) - min(ys), RULER_MM + 10.0) / 2
    middle = (FOOT_MM - HEADING_MM) / 2
    level = middle - half_height - LEVEL_GAP_MM
    return Places(
        artwork=(0.0, middle - (max(ys) + min(ys)) / 2),
        heading=(0.0, middle + half_height + HEADING_MM - LINE_MM),
        level_ruler=(-RULER_MM / 2, level),
        upright_ruler=(min(xs) - UPRIGHT_GAP_MM, middle - RULER_MM / 2),
        notes=(0.0, level - NOTES_GAP_MM),
    )
