"""Damage the masks' drawings, and exactly the right checks fail."""

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import ezdxf
import pytest

from lumitip_fab.checks import mask
from lumitip_fab.encoding import read_design

LETTER = "mask/emitter_mask_letter.pdf"
SVG, DXF = "mask/emitter_mask.svg", "mask/emitter_mask.dxf"
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


def truncated(file: str) -> Callable[[Path], None]:
    return lambda out: (out / file).write_bytes((out / file).read_bytes()[:1500]) and None


DAMAGES: dict[str, tuple[Callable[[Path], None], set[str]]] = {
    "flap over coupling": (lambda out: cut_corner_moved(out / DXF, 10, 1.8), {"folds", "dxf"}),
    "flap too short": (lambda out: cut_corner_moved(out / DXF, 10, 0.3), {"reach", "dxf"}),
    "flaps overlap": (flaps_overlapping, {"flaps", "dxf"}),
    "fold astray": (fold_astray, {"folds"}),
    "drawing in inches": (dxf_in_inches, {"dxf", *FLAPS}),
    "drawing truncated": (truncated(DXF), {"dxf", *FLAPS}),
    "drawing missing": (lambda out: (out / DXF).unlink(), {"dxf", *FLAPS}),
    "SVG hole moved": (svg_hole_moved, {"svg"}),
    "SVG in inches": (svg_in_inches, {"svg"}),
    "SVG truncated": (truncated(SVG), {"svg"}),
}


@pytest.mark.parametrize("name", DAMAGES)
def test_damage_fails_exactly(
    name: str, masks: Path, tmp_path: Path, failing_masks: Callable[[Path], set[str]]
) -> None:
    damage, expected = DAMAGES[name]
    out = Path(shutil.copytree(masks, tmp_path / "damaged"))
    damage(out)
    assert failing_masks(out) == expected


def test_every_check_is_in_a_damage(masks: Path) -> None:
    found = list(mask.measure(masks, read_design(masks / "design.json")))
    assert not [m for m in found if not m.passed]
    names = {m.check.removeprefix("mask.") for m in found if ".pdf" not in m.subject}
    assert names <= set().union(*(expected for _, expected in DAMAGES.values()))


@pytest.mark.parametrize("file", [LETTER, SVG, DXF])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.6, 0.9])
def test_no_damage_raises(
    file: str,
    share: float,
    masks: Path,
    tmp_path: Path,
    failing_masks: Callable[[Path], set[str]],
) -> None:
    out = Path(shutil.copytree(masks, tmp_path / "damaged"))
    data = (masks / file).read_bytes()
    (out / file).write_bytes(data[: int(share * len(data))])
    assert failing_masks(out)
