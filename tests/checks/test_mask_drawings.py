"""Damage the masks' drawings, and exactly the right checks fail."""

import re
from collections.abc import Callable
from pathlib import Path

import ezdxf
import pytest

from damages import cut_short, failing, passing
from hidden_drawings import HIDDEN, redrawn

pytestmark = pytest.mark.slow

LETTER = "mask/emitter_mask_letter.pdf"
SVG, DXF = "mask/emitter_mask.svg", "mask/emitter_mask.dxf"
NOTE = "mask/emitter_wrapping.md"
FLAPS = {"flaps", "folds", "reach"}


def cut_corner_moved(file: Path, corner: int, share: float) -> None:
    """Move two outer corners of a flap along its sides: longer above 1, shorter below."""
    document = ezdxf.readfile(file)
    cut = next(iter(document.modelspace().query('LWPOLYLINE[layer=="CUT"]')))
    points = [tuple(p) for p in cut.get_points()]
    for inner, outer in ((corner - 1, corner), (corner + 2, corner + 1)):
        (x0, y0), (x1, y1) = points[inner][:2], points[outer][:2]
        points[outer] = (x0 + share * (x1 - x0), y0 + share * (y1 - y0), *points[outer][2:])
    cut.set_points(points)
    document.saveas(file)


def flaps_overlapping(out: Path) -> None:
    document = ezdxf.readfile(out / DXF)
    cut = next(iter(document.modelspace().query('LWPOLYLINE[layer=="CUT"]')))
    points = [tuple(p) for p in cut.get_points()]
    at = 3 * 4 + 2  # second outer corner of the flap at the waist, over to its neighbour
    points[at] = (points[at][0], points[at][1] + 8, *points[at][2:])
    cut.set_points(points)
    document.saveas(out / DXF)


def fold_astray(out: Path) -> None:
    """A fold from the start of one flap to the end of the next: a chord too long."""
    document = ezdxf.readfile(out / DXF)
    one, other = list(document.modelspace().query('LINE[layer=="FOLD"]'))[1:3]
    one.dxf.end = other.dxf.end
    other.destroy()
    document.saveas(out / DXF)


def dxf_in_inches(out: Path) -> None:
    document = ezdxf.readfile(out / DXF)
    document.units = ezdxf.units.IN
    document.saveas(out / DXF)


def svg_hole_moved(out: Path) -> None:
    lines = (out / SVG).read_text().splitlines()
    first = next(i for i, line in enumerate(lines) if 'id="black"' in line)
    x = re.match(r"M([\d.]+)", lines[first + 5])
    assert x
    lines[first + 5] = lines[first + 5].replace(x[1], f"{float(x[1]) + 0.3:.5f}", 1)
    (out / SVG).write_text("\n".join(lines))


def svg_in_inches(out: Path) -> None:
    text = (out / SVG).read_text()
    (out / SVG).write_text(re.sub(r'width="([\d.]+)mm"', r'width="\1in"', text, count=1))


def svg_band_moved(out: Path) -> None:
    text = (out / SVG).read_text()
    start = text.index('id="bands"')
    (out / SVG).write_text(text[:start] + re.sub(r"L([\d.]+)", "L50", text[start:], count=1))


def note_edited(before: str, after: str) -> Callable[[Path], None]:
    def edit(out: Path) -> None:
        text = (out / NOTE).read_text(encoding="utf-8")
        assert re.search(before, text)
        (out / NOTE).write_text(re.sub(before, after, text, count=1), encoding="utf-8")

    return edit


def truncated(file: str) -> Callable[[Path], None]:
    return lambda out: cut_short(out / file)


DAMAGES: dict[str, tuple[Callable[[Path], None], set[str]]] = {
    "flap over coupling": (lambda out: cut_corner_moved(out / DXF, 10, 1.8), {"folds", "dxf"}),
    "flap too short": (lambda out: cut_corner_moved(out / DXF, 10, 0.3), {"reach", "dxf"}),
    "flaps overlap": (flaps_overlapping, {"flaps", "dxf"}),
    "fold astray": (fold_astray, {"folds", "dxf"}),
    "drawing in inches": (dxf_in_inches, {"dxf", *FLAPS}),
    "drawing truncated": (truncated(DXF), {"dxf", *FLAPS}),
    "drawing missing": (lambda out: (out / DXF).unlink(), {"dxf", *FLAPS}),
    **{change.__name__: (redrawn(DXF, change), {"dxf", *FLAPS}) for change in HIDDEN},
    "SVG hole moved": (svg_hole_moved, {"svg"}),
    "SVG in inches": (svg_in_inches, {"svg"}),
    "SVG band moved": (svg_band_moved, {"svg"}),
    "note: fold wider": (note_edited(r"\| 4 \| [\d.]+", "| 4 | 13.9"), {"note"}),
    "note: flap longer": (note_edited(r"(\| 1 \| [\d.]+ \|) 13.0", r"\1 13.2"), {"note"}),
    "note: less onto the back": (note_edited(r"[\d.]+ \|\n\| 2 ", "9.0 |\n| 2 "), {"note"}),
    "note: row missing": (note_edited(r"\| 7 \|.*\n", ""), {"note"}),
    "note: other apertures": (note_edited(r"The \d+ ap", "The 31 ap"), {"note"}),
    "note: other readings": (note_edited(r"`\[100, 100\]`", "`[99.2, 100]`"), {"note"}),
    "note truncated": (truncated(NOTE), {"note"}),
    "note with no figure": (note_edited(r"\| 1 \| (\S+) \|", r"| 1 | \1.0 |"), {"note"}),
    "note missing": (lambda out: (out / NOTE).unlink(), {"note"}),
    "SVG truncated": (truncated(SVG), {"svg"}),
}


@pytest.mark.parametrize("name", DAMAGES)
def test_damage_fails_exactly(name: str, damaged_masks: Path) -> None:
    damage, expected = DAMAGES[name]
    damage(damaged_masks)
    assert failing(damaged_masks, "mask") == expected


def test_every_check_is_in_a_damage(masks: Path) -> None:
    names = passing(masks, "mask", lambda file: ".pdf" not in file)
    assert names <= set().union(*(expected for _, expected in DAMAGES.values()))


@pytest.mark.parametrize("file", [LETTER, SVG, DXF])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.6, 0.9])
def test_no_damage_raises(file: str, share: float, damaged_masks: Path) -> None:
    cut_short(damaged_masks / file, int(share * (damaged_masks / file).stat().st_size))
    assert failing(damaged_masks, "mask")
