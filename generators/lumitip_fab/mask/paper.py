"""Where things stand on a page, before it is stretched: mm from the page's centre, y up."""

from dataclasses import dataclass

from lumitip_fab.design import Mask, Point

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
