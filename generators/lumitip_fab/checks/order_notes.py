"""Both notes of an order, line by line: the board asks for each one, and none is missing."""

import re
from collections import Counter
from collections.abc import Iterator

import numpy as np
import shapely

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.order_ways import TEXTS, lying
from lumitip_fab.checks.panel_read import PanelBoard
from lumitip_fab.design import Fab, Flexible
from lumitip_fab.design.boards import thickness_off_mm
from lumitip_fab.text import passage

SIZE_MM = 0.006
_NUMBER = re.compile(r"\d+(?:\.\d+)?")
_REF = r"[A-Z]+\d+(?:_\d+)?"
_REFS = rf"{_REF}(?:, {_REF})*"
_ROW = re.compile(rf"({_REF})  [-a-z\d. ]+")


def other_figures(read: ReadBoard, note: str) -> Iterator[str]:
    """Lines of the fabrication note that are not those of the board's file."""
    found, wanted = list(filter(None, note.splitlines())), list(_fabrication(read))
    heads = [{line.partition(": ")[0]: line for line in lines} for lines in (found, wanted)]
    if len(found) != len(heads[0]):
        yield "a line twice"
    for head in sorted(heads[0].keys() | heads[1]):
        one, other = (lines.get(head, "") for lines in heads)
        stated, right = ([float(n) for n in _NUMBER.findall(line)] for line in (one, other))
        same = _NUMBER.sub("#", one) == _NUMBER.sub("#", other)
        if not same or not np.allclose(stated, right, rtol=0.0, atol=SIZE_MM):
            yield head


def _fabrication(read: ReadBoard) -> Iterator[str]:
    """The lines that are not empty, as the board's file and the design have them."""
    board, finish, flexible = read.board, read.of.finish, read.flexible
    edges = shapely.union_all(list(board.edges)).bounds
    thick_mm = board.thickness_mm
    off = "" if flexible else f", +/-{thickness_off_mm(thick_mm):.2g} mm"
    yield _header(read, f"{read.name} board")
    yield f"Copper layers: {len(board.layers)}"
    yield f"Material: {'polyimide, see the assembly note' if flexible else 'FR-4, Tg 130 or more'}"
    yield f"Size: {edges[2] - edges[0]:.2f} x {edges[3] - edges[1]:.2f} mm"
    yield f"Thickness: {thick_mm:g} mm{off}"
    copper_um = 1000 * flexible.copper_mm if flexible else finish.copper_um
    yield f"Copper: {copper_um:g} um on each side"
    yield f"Surface: {finish.surface}"
    yield f"{'Coverlay' if flexible else 'Solder mask'}: {finish.mask}, on both sides"
    yield "Silkscreen: white, on both sides"
    if tracks := [copper.width_mm for copper in board.loose if copper.width_mm]:
        yield f"Narrowest track: {min(tracks):g} mm"
    if drills := [copper.drill_mm for copper in board.copper() if copper.drill_mm]:
        yield f"Smallest drill: {min(drills):g} mm"
    yield "Vias: covered by the mask, not filled"
    yield "Electrical test: every board"
    if finish.reason:
        yield f"Why {finish.mask}: {finish.reason}."
    if isinstance(read, PanelBoard):
        yield from _panel(read)


def _header(read: ReadBoard, caption: str) -> str:
    block, code = read.board.title_block, read.design.layout.design_hash[:8]
    return f"{block.get('title')}: {caption}, revision {block.get('rev')}, design {code}"


def _panel(read: PanelBoard) -> Iterator[str]:
    panel, rules = read.panel, read.panel.rules
    text = passage(TEXTS, "panel").format(
        panel=panel, rules=rules, copies=len(panel.copies), radius_mm=rules.gap_mm / 2
    )
    yield from filter(None, text.splitlines())


def other_lines(read: ReadBoard, fab: Fab, note: str, stiffener: str) -> Iterator[str]:
    """Lines of the assembly note that the board does not ask for, and those that are missing.

    Args:
        read: the board.
        fab: for its remark.
        note: the text.
        stiffener: file with the outline of a flexible board's stiffener.
    """
    lines = list(filter(None, note.splitlines()))
    rows = [row[1] for line in lines if (row := _ROW.fullmatch(line))]
    cells = read.cells_hold
    of_cell = re.compile(rf"{cells.letter}\d+(_\d+)?" if cells else _REF)
    placed = {ref for ref in read.assembled() if of_cell.fullmatch(ref)}
    yield from sorted((Counter(rows) - Counter(placed)).keys())
    others = Counter(line for line in lines if not _ROW.fullmatch(line))
    wanted = Counter(_assembly(read, fab, stiffener))
    yield from (f"no {line:.40}" for line in wanted - others)
    maybe, used = _maybe(), set()
    for line in (others - wanted).elements():
        pattern = next((p for p in maybe if re.fullmatch(p, line)), "")
        if not pattern or pattern in used:
            yield f"{line:.40}"
        used.add(pattern)


def _maybe() -> tuple[str, ...]:
    """Patterns of lines of which other checks know which parts they name, if there are any."""
    by_hand, turned = (re.escape(passage(TEXTS, name)) for name in ("by_hand", "turned"))
    bought = rf"{_REF} \(.+?\)(?:, {_REF} \(.+?\))*"
    return (
        rf"ON THE BACK: {_REFS}\. Everything else is on the front\.",
        by_hand.replace(re.escape("{parts}"), bought),
        turned.replace(re.escape("{refs}"), _REFS),
        r"Without a number of the distributor in the bill of materials: .+\. Choose them by hand\.",
    )


def _assembly(read: ReadBoard, fab: Fab, stiffener: str) -> Iterator[str]:
    """The lines that each such note has, but for places."""
    copies = f", panel of {len(read.panel.copies)}" if isinstance(read, PanelBoard) else ""
    caption = read.auxiliary.title if read.auxiliary else f"{read.of.name} board"
    yield _header(read, caption + copies)
    if read.flexible:
        yield from _flexible(read.flexible, stiffener)
    elif _is_small(read, fab):
        yield passage(TEXTS, "small").format(least=fab.least_mm)
    yield from lying(read)
    if fab.remark:
        yield from filter(None, fab.remark.splitlines())
    first = "Places of the terminals" if read.finger else "Pad 1 of each part"
    yield f"{first}, in mm as in the Gerber files, seen from the front:"


def _is_small(read: ReadBoard, fab: Fab) -> bool:
    """Whether the drawn board is smaller than the least that a fab assembles, and has no panel."""
    if fab.least_mm is None or read.name in {panel.board for panel in read.design.panels}:
        return False
    x_min, y_min, x_max, y_max = shapely.union_all(list(read.board.edges)).bounds
    sides = x_max - x_min, y_max - y_min
    return any(have < least - SIZE_MM for have, least in zip(sides, fab.least_mm, strict=True))


def _flexible(flexible: Flexible, stiffener: str) -> Iterator[str]:
    total_mm = flexible.core_mm + 2 * (flexible.copper_mm + flexible.coverlay_mm)
    text = passage(TEXTS, "flexible").format(
        flexible=flexible, total_mm=total_mm, stiff=flexible.stiffener, outline=stiffener
    )
    yield from filter(None, text.splitlines())
