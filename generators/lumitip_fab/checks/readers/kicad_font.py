"""Words of a board in KiCad's stroke font, as areas. Places are on KiCad's page: mm, y down."""

from functools import lru_cache
from importlib.resources import files
from itertools import islice

import shapely
from gerbonara import data
from gerbonara.newstroke import Newstroke
from shapely import LineString, affinity
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.readers.kicad_silk import Word

_GLYPHS = 0x2200 - 0x20  # from space: Latin, Greek and arrows, of the font's 65 000
# Of the baseline below a word's middle: in heights, less a share of the pen; by plots of KiCad 9.
_BELOW, _LESS = 0.510238, 0.052
_STEPS = 8  # chords of a quarter circle
Glyph = tuple[float, tuple[tuple[tuple[float, float], ...], ...]]
"""Width and strokes of a letter, in heights: x to the right, y down, baseline at 0."""


def inked(word: Word) -> BaseGeometry:
    """Area that a pen covers as it writes a centred word; mirrored on the back."""
    glyphs, lines = _font(), []
    letters = [glyphs.get(letter, glyphs["?"]) for letter in word.text]
    left = -sum(width for width, _ in letters) / 2
    sign = 1 if word.front else -1
    down = _BELOW * word.height_mm - _LESS * word.stroke_mm
    for width, strokes in letters:
        for stroke in strokes:
            if stroke:
                line = [((left + x) * word.height_mm * sign, y * word.height_mm) for x, y in stroke]
                lines.append(LineString(line if len(line) > 1 else line * 2))
        left += width
    flat = affinity.translate(shapely.union_all(lines), 0, down)
    turned = affinity.rotate(flat, -word.angle_deg, origin=(0, 0))
    placed = affinity.translate(turned, *word.at)
    return placed.buffer(word.stroke_mm / 2, quad_segs=_STEPS)


@lru_cache
def _font() -> dict[str, Glyph]:
    source = files(data).joinpath("newstroke_font.cpp").read_bytes()
    return dict(islice(Newstroke.load_glyphs(source), _GLYPHS))
