"""Ways to hurt a written board file, shared by the tests of its checks."""

import re
import zipfile
from collections.abc import Callable
from pathlib import Path

import shapely

from lumitip_fab.boards.outline import fractured


def in_part(text: str, ref: str, pattern: str, put: str | Callable[[re.Match[str]], str]) -> str:
    """Replace the first match within a part's footprint."""
    at = text.index(f'(fp_text reference "{ref}"')
    start = text.rindex("\n  (footprint", 0, at)
    end = text.index("\n  (", at)
    return text[:start] + once(text[start:end], pattern, put) + text[end:]


def once(text: str, pattern: str, put: str | Callable[[re.Match[str]], str]) -> str:
    """Replace the first match, of which there must be one."""
    hurt, count = re.subn(pattern, put, text, count=1)
    assert count == 1, f"nothing matches {pattern}"
    return hurt


def shifted(dx_mm: float, dy_mm: float) -> Callable[[re.Match[str]], str]:
    """For a pattern whose groups 1 and 2 are x and y, and 3 what follows."""
    return lambda m: f"(at {float(m[1]) + dx_mm:g} {float(m[2]) + dy_mm:g}{m[3]}"


def moved_part(text: str, ref: str, dx_mm: float, dy_mm: float) -> str:
    """A footprint moved on the page."""
    return in_part(text, ref, r"\(at (\S+) (\S+?)( \S+\)|\))", shifted(dx_mm, dy_mm))


def rezip(path: Path, damage: Callable[[dict[str, bytes]], None]) -> None:
    """Change the files of a zip."""
    with zipfile.ZipFile(path) as package:
        files = {name: package.read(name) for name in package.namelist()}
    before = dict(files)
    damage(files)
    assert files != before
    with zipfile.ZipFile(path, "w") as package:
        for name, data in files.items():
            package.writestr(name, data)


def swapped_pads(text: str, ref: str, one: str, other: str) -> str:
    """Two pads of a part with each other's number: the copper stays where it is."""
    text = in_part(text, ref, rf'\(pad "{one}" ', '(pad "?" ')
    text = in_part(text, ref, rf'\(pad "{other}" ', f'(pad "{one}" ')
    return in_part(text, ref, r'\(pad "\?" ', f'(pad "{other}" ')


def resistor_smaller(text: str) -> str:
    """Another value of a string's resistor."""
    return in_part(text, "R1", r'value "\d+R"', 'value "100R"')


def unrated(text: str) -> str:
    """A string's resistor in a package without a known rating."""
    return in_part(text, "R1", r"RESC\d{4}X", "RESC9999X")


def spokes_cut(text: str) -> str:
    """The pour of the back cut away round the ground pad of J1, but for one side of it."""
    at = text.index('(fp_text reference "J1"')
    part = text[text.rindex("\n  (footprint", 0, at) :]
    place = re.search(r"\(at (\S+) (\S+?)[ )]", part)
    pad = re.search(
        r'\(pad "\w+" thru_hole \w+\s+\(at (\S+) (\S+?)[ )](?:(?!\(pad )[\s\S])*?"GND"', part
    )
    assert place and pad
    x, y = (float(place[k]) + float(pad[k]) for k in (1, 2))
    half = shapely.box(x - 0.4, y - 1.6, x + 1.6, y + 1.6)
    cut = half | shapely.box(x - 1.6, y + 0.3, x + 1.6, y + 1.6)  # one spoke stays on its left

    def clipped(match: re.Match[str]) -> str:
        corners = [tuple(map(float, xy)) for xy in re.findall(r"\(xy (\S+) (\S+?)\)", match[0])]
        area = shapely.Polygon(corners).buffer(0)
        if not area.intersects(cut):
            return match[0]
        left = [p for p in shapely.get_parts(area - cut) if p.area > 0.05]
        return "\n".join(_polygon(p) for p in left)

    fill = r'    \(filled_polygon\s+\(layer "B\.Cu"\)\s+\(pts[^()]*(?:\([^()]*\)[^()]*)+\)\s*\)'
    hurt = re.sub(fill, clipped, text)
    assert hurt != text
    return hurt


def _polygon(area: shapely.Polygon) -> str:
    corners = " ".join(f"(xy {x:.3f} {y:.3f})" for x, y in fractured(area))
    return f'    (filled_polygon (layer "B.Cu") (pts {corners}))'


def tie_of(text: str, which: int = 0) -> str:
    """Reference of a hole for a thread, in the order of the file."""
    pattern = r'MountingHole_1\.6mm"(?:(?!\(footprint ).)*?\(fp_text reference "(H\d+)"'
    return re.findall(pattern, text, re.DOTALL)[which]


def tie_moved(text: str) -> str:
    """Too little to see."""
    return moved_part(text, tie_of(text), 0.05, 0.0)


def tie_far(text: str) -> str:
    """Away from its row of wire pads."""
    return moved_part(text, tie_of(text), -5.0, 0.0)


def tie_wide(text: str) -> str:
    """Drilled too wide."""
    return in_part(text, tie_of(text, -1), r"\(drill 1\.6\)", "(drill 1.7)")


def tie_missing(text: str) -> str:
    """Not drilled."""
    return in_part(text, tie_of(text, 1), "np_thru_hole", "connect")


def text_over_a_tie(text: str) -> str:
    """The name of a row of pads where the hole is."""
    part = text[: text.index(f'(fp_text reference "{tie_of(text)}"')]
    x, y = re.findall(r"\n    \(at (\S+) (\S+?)\)", part)[-1]
    return once(text, r'(\(gr_text "J\d" \(at )\S+ \S+', rf"\g<1>{x} {y}")


def tie_under_the_film(text: str) -> str:
    """Beyond the opening of mask and film."""
    return moved_part(text, tie_of(text), -1.5, 0.0)


def tie_under_a_resistor(text: str) -> str:
    """Through a part on the back, where the plate is closed."""
    part = text[: text.index('(fp_text reference "R1"')]
    x, y = re.findall(r"\n    \(at (\S+) (\S+?)[ )]", part)[-1]
    return in_part(text, tie_of(text), r"\(at \S+ \S+?\)", f"(at {x} {y})")


def tie_beyond_the_edge(text: str) -> str:
    """Into the board's edge."""
    return moved_part(text, tie_of(text), 0.0, 1.0)


TIE_DAMAGES: dict[Callable[[str], str], set[str]] = {
    tie_moved: {"ties", "hole_clearance"},
    tie_far: {"ties", "tie_reach", "tie_window", "hole_clearance"},
    tie_wide: {"tie_width", "hole_clearance"},
    tie_missing: {"lands", "tie_count", "ties", "tie_reach"},
    tie_under_the_film: {"ties", "tie_window", "tie_silk", "hole_clearance"},
    tie_under_a_resistor: {
        "ties",
        "tie_reach",
        "tie_window",
        "tie_notch",
        "tie_parts",
        "tie_silk",
        "hole_clearance",
    },
    tie_beyond_the_edge: {"ties", "tie_edge", "hole_clearance"},
}
"""Of the emitter, and the checks that fail."""
