"""Damage a written panel, and exactly the right checks fail."""

import re
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from board_damages import in_part, moved_part, once
from damages import failing
from lumitip_fab.checks import panels
from lumitip_fab.design import Panel
from lumitip_fab.design.encoding import read_design
from lumitip_fab.design.frames import on_board_page

pytestmark = pytest.mark.slow

Move = Callable[[float, float], tuple[float, float]]
Damage = Callable[[str, Panel], str]
NAME = "receiver_panel"
_EDGE = re.compile(r'\n  \(gr_(?:line|arc)(?:(?!\n  \()[\s\S])*?"Edge\.Cuts"(?:(?!\n  \()[\s\S])*')
_POINT = re.compile(r"\((start|mid|end) (\S+) (\S+?)\)")


@pytest.fixture
def hurt(panelled: Path, tmp_path: Path) -> Path:
    """A copy of the boards with panels, to damage."""
    return Path(shutil.copytree(panelled, tmp_path / "hurt"))


def panel_of(folder: Path) -> Panel:
    design = read_design(folder / "design.json")
    return next(panel for panel in design.panels if panel.name == NAME)


def edges_moved(text: str, move: Move) -> str:
    """Each point of the outline and of the routed openings moved, in the panel's frame."""

    def point(match: re.Match[str]) -> str:
        x, y = float(match[2]) - 150.0, 100.0 - float(match[3])
        across, down = on_board_page(move(x, y))
        return f"({match[1]} {across:.6f} {down:.6f})"

    moved = _EDGE.sub(lambda edge: _POINT.sub(point, edge[0]), text)
    assert moved != text
    return moved


def removed(text: str, ref: str) -> str:
    """The file without a footprint."""
    at = text.index(f'(fp_text reference "{ref}"')
    start = text.rindex("\n  (footprint", 0, at)
    return text[:start] + text[text.index("\n  (", at) :]


def tab_at(panel: Panel, text: str) -> float:
    """y of the lowest tab of the first copy."""
    return sorted(y for x, y in bites_of(text) if x < panel.inside.x_min_mm + 3)[2]


def bites_of(text: str) -> Iterator[tuple[float, float]]:
    pattern = r'MountingHole_0\.6mm"(?:(?!\(at )[\s\S])*\(at (\S+) (\S+?)\)'
    for match in re.finditer(pattern, text):
        yield float(match[1]) - 150.0, 100.0 - float(match[2])


def wider(text: str, panel: Panel) -> str:
    x_max = panel.box.x_max_mm - 1.5
    return edges_moved(text, lambda x, y: (x + 400.0 if x > x_max else x, y))


def longer(text: str, panel: Panel) -> str:
    y_max = panel.box.y_max_mm - 1.5
    return edges_moved(text, lambda x, y: (x, y + 400.0 if y > y_max else y))


def shorter(text: str, panel: Panel) -> str:
    y_max = panel.box.y_max_mm - 1.5
    return edges_moved(text, lambda x, y: (x, y - 4.0 if y > y_max else y))


def rail_narrow(text: str, panel: Panel) -> str:
    x_min = panel.box.x_min_mm + 1.5
    return edges_moved(text, lambda x, y: (x + 1.5 if x < x_min else x, y))


def gap_narrow(text: str, panel: Panel) -> str:
    at = panel.inside.x_min_mm
    return edges_moved(text, lambda x, y: (x + 0.5 if abs(x - at) < 1e-6 else x, y))


def copy_cut(text: str, panel: Panel) -> str:
    at = panel.inside.x_min_mm + 2.0
    return edges_moved(text, lambda x, y: (x + 0.2 if abs(x - at) < 1e-6 else x, y))


def tab_narrow(text: str, panel: Panel) -> str:
    y_tab, x_tab = tab_at(panel, text), panel.inside.x_min_mm + 2.5
    low, high = y_tab, y_tab + panel.rules.contact_mm / 2 + 0.1

    def move(x: float, y: float) -> tuple[float, float]:
        return x, y - 0.3 if x < x_tab and x > panel.inside.x_min_mm - 0.1 and low < y < high else y

    return edges_moved(text, move)


def tab_lost(text: str, panel: Panel) -> str:
    """The gap goes on where a tab was."""
    y_tab, half = tab_at(panel, text), panel.rules.contact_mm / 2 + 0.01
    left, right = panel.inside.x_min_mm, panel.inside.x_min_mm + 2.0

    def of_tab(edge: re.Match[str]) -> str:
        places = [(float(m[2]) - 150.0, 100.0 - float(m[3])) for m in _POINT.finditer(edge[0])]
        near = all(left - 0.1 < x < right + 0.1 and abs(y - y_tab) < half for x, y in places)
        return "" if near else edge[0]

    cut = _EDGE.sub(of_tab, text)
    half -= 0.01
    for x in (left, right):
        ends = [on_board_page((x, y)) for y in (y_tab - half, y_tab + half)]
        points = " ".join(
            f"({name} {at[0]:.6f} {at[1]:.6f})"
            for name, at in zip(("start", "end"), ends, strict=True)
        )
        cut = once(
            cut,
            r"\n  \(gr_line",
            f'\n  (gr_line {points} (layer "Edge.Cuts") (width 0.1))\n  (gr_line',
        )
    return cut


def beside_tab(text: str, panel: Panel, ref: str, inset_mm: float) -> str:
    """A footprint moved beside the lowest tab of the first copy, so far from the copy's edge."""
    x = panel.inside.x_min_mm + panel.rules.gap_mm + inset_mm
    across, down = on_board_page((x, tab_at(panel, text)))
    place = r"\(at (\S+) (\S+?)( \S+\)|\))"
    return in_part(text, ref, place, lambda m: f"(at {across:g} {down:g}{m[3]}")


def track_moved(text: str, _: Panel) -> str:
    return once(
        text,
        r"\(segment(\s+)\(start (\S+)",
        lambda m: f"(segment{m[1]}(start {float(m[2]) + 0.1:g}",
    )


def other_net(text: str, _: Panel) -> str:
    """The pour of the first copy with the net of the second one."""
    first = re.search(r'\(net (\d+) "GND_1"\)', text)
    second = re.search(r'\(net (\d+) "GND_2"\)', text)
    assert first and second
    return once(
        text,
        rf'\(net {first[1]}\)(\s+)\(net_name "GND_1"\)',
        f'(net {second[1]})\\1(net_name "GND_2")',
    )


def mark_added(text: str, _: Panel) -> str:
    """A fourth fiducial: the panel looks alike when it is turned by half."""
    at = text.index('(fp_text reference "FID3"')
    start, end = text.rindex("\n  (footprint", 0, at), text.index("\n  (", at)
    more = text[start:end].replace('"FID3"', '"FID4"')
    place = re.search(r"\(at (\S+) (\S+?)\)|\(at (\S+) (\S+) 0\)", more)
    assert place
    y = 100.0 + (100.0 - float(place[2] or place[4]))
    return text[:end] + more.replace(place[0], f"(at {place[1] or place[3]} {y:g})", 1) + text[end:]


def tools(text: str) -> list[str]:
    """References of the tooling holes."""
    return re.findall(r'MountingHole_2mm"(?:(?!reference)[\s\S])*reference "(H\d+)"', text)


def bite_refs(text: str) -> list[str]:
    return re.findall(r'MountingHole_0\.6mm"(?:(?!reference)[\s\S])*reference "(H\d+)"', text)


DAMAGES: dict[str, tuple[Damage, set[str]]] = {
    "400 mm wider": (wider, {"width", "outline", "profile"}),
    "400 mm longer": (longer, {"length", "outline", "profile"}),
    "4 mm shorter": (shorter, {"outline", "profile", "bars", "tooling_wall"}),
    "rail narrow": (rail_narrow, {"outline", "profile", "rails", "fiducial_edge", "tooling_wall"}),
    "gap narrow": (gap_narrow, {"gaps", "profile"}),
    "copy cut": (copy_cut, {"copies", "tabs", "bites", "gaps", "profile"}),
    "tab narrow": (tab_narrow, {"web", "profile"}),
    "tab lost": (tab_lost, {"tabs", "profile", "bites"}),
    "track moved": (track_moved, {"copper"}),
    "pour of another copy's net": (other_net, {"copper"}),
    "part moved": (lambda t, _: moved_part(t, "Q3_2", 0.1, 0.0), {"parts", "copper"}),
    "part lost": (lambda t, _: removed(t, "C1_3"), {"parts", "copper"}),
    "mark of a copy moved": (
        lambda t, _: moved_part(t, "FID1_2", 0.1, 0.0),
        {"parts", "loose_copper"},
    ),
    "part of another value": (
        lambda t, _: in_part(t, "C1_1", 'value "100nF"', 'value "1uF"'),
        {"parts"},
    ),
    "part beside a tab": (
        lambda t, p: beside_tab(t, p, "Q3_1", 2.5),
        {"parts", "copper", "tab_parts"},
    ),
    "locating hole moved": (lambda t, _: moved_part(t, "H1", 0.1, 0.0), {"holes"}),
    "locating hole beside a tab": (
        lambda t, p: beside_tab(t, p, "H1", 2.0),
        {"holes", "tab_pads"},
    ),
    "mouse bite lost": (lambda t, _: removed(t, bite_refs(t)[0]), {"bites"}),
    "hole of a mouse bite wide": (
        lambda t, _: in_part(t, bite_refs(t)[1], r"\(drill 0\.6\)", "(drill 0.9)"),
        {"bite_size", "bite_depth", "web", "tab_copper"},
    ),
    "hole of a mouse bite moved along": (
        lambda t, _: moved_part(t, bite_refs(t)[1], 0.0, 0.25),
        {"web", "widest_web"},
    ),
    "hole of a mouse bite within the board": (
        lambda t, _: moved_part(t, bite_refs(t)[1], 0.15, 0.0),
        {"bite_depth", "tab_copper"},
    ),
    "tooling hole lost": (lambda t, _: removed(t, tools(t)[0]), {"tooling"}),
    "tooling hole small": (
        lambda t, _: in_part(t, tools(t)[0], r"\(drill 2\)", "(drill 1.5)"),
        {"tooling_size"},
    ),
    "tooling hole at the edge": (
        lambda t, _: moved_part(t, tools(t)[0], -1.5, 0.0),
        {"tooling_wall"},
    ),
    "fiducial lost": (lambda t, _: removed(t, "FID3"), {"fiducials"}),
    "fiducial small": (
        lambda t, _: in_part(t, "FID3", r"\(size 1 1\)", "(size 0.8 0.8)"),
        {"fiducial_size"},
    ),
    "fiducial at the edge": (
        lambda t, _: moved_part(t, "FID1", -0.5, 0.0),
        {"fiducial_edge", "fiducial_opening"},
    ),
    "other revision": (lambda t, _: t.replace('(rev "', '(rev "0'), {"title_block"}),
    "four fiducials": (mark_added, {"fiducial_turn", "fiducial_opening"}),
}


@pytest.mark.parametrize("name", DAMAGES)
def test_a_damage_of_a_panel(name: str, hurt: Path) -> None:
    damage, expected = DAMAGES[name]
    file = hurt / "boards" / NAME / f"{NAME}.kicad_pcb"
    text = file.read_text(encoding="utf-8")
    worse = damage(text, panel_of(hurt))
    assert worse != text
    file.write_text(worse, encoding="utf-8")
    assert failing(hurt, "panels", NAME) == expected


def test_each_check_is_seen_to_fail(panelled: Path) -> None:
    design = read_design(panelled / "design.json")
    names = {m.check.partition(".")[2] for m in panels.measure_board(panelled, design, NAME)}
    assert names - set().union(*(expected for _, expected in DAMAGES.values())) == set()
