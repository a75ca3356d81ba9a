"""Both notes of an order, line by line: the board asks for each one, and none is missing."""

import re
from collections import Counter
from collections.abc import Iterator

import numpy as np
import shapely

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.panel_read import PanelBoard
from lumitip_fab.design import Fab, Flexible
from lumitip_fab.design.boards import thickness_off_mm

SIZE_MM = 0.006
_NUMBER = re.compile(r"\d+(?:\.\d+)?")
_REF = r"[A-Z]+\d+(?:_\d+)?"
_REFS = rf"{_REF}(?:, {_REF})*"
_OTHER = {"anode": "cathode", "cathode": "anode", "collector": "emitter", "emitter": "collector"}
_SYMMETRIC = ("R", "RN", "C")
"""Letters of parts that have no polarity."""
_MAYBE = (
    rf"ON THE BACK: {_REFS}\. Everything else is on the front\.",
    rf"NOT MOUNTED BY YOU: {_REF} \(.+?\)(?:, {_REF} \(.+?\))*\. The customer solders it on by "
    r"hand; it is in neither table\. Leave its holes open\.",
    rf"ROTATION ASSUMED: {_REFS}\. Compare pad 1 of each with the mark on the part before "
    r"placing\.",
    r"Without a number of the distributor in the bill of materials: .+\. Choose them by hand\.",
)
"""Lines of which other checks know which parts they name, if there are any."""
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
    yield (
        f"Panel: {len(panel.copies)} boards, {panel.columns} x {panel.rows}, as the customer has "
        "drawn it; deliver it whole"
    )
    yield f"Rails: {panel.rail_mm:g} mm, left and right; bars as wide join them"
    yield (
        f"Gaps: routed, {rules.gap_mm:g} mm and more, corners with a radius of "
        f"{rules.gap_mm / 2:g} mm"
    )
    yield (
        f"Mouse bites: {rules.bites} unplated holes of {rules.bite_mm:g} mm at each tab, a third "
        "of each within the board"
    )
    yield f"Tooling holes: 4 of {rules.tooling_mm:g} mm, unplated"
    yield (
        f"Fiducials: {rules.fiducial_mm:g} mm on the rails, the mask open for "
        f"{rules.fiducial_opening_mm:g} mm"
    )
    yield (
        "The last number of a part is that of its board: D1_2 is D1 of board 2, counted row by "
        "row from the lower left."
    )
    yield (
        "Keep the rails. After breaking the boards out, file what is left of the tabs flush with "
        "the edge."
    )


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
    used: set[str] = set()
    for line in (others - wanted).elements():
        pattern = next((p for p in _MAYBE if re.fullmatch(p, line)), "")
        if not pattern or pattern in used:
            yield f"{line:.40}"
        used.add(pattern)


def _assembly(read: ReadBoard, fab: Fab, stiffener: str) -> Iterator[str]:
    """The lines that each such note has, but for places."""
    copies = f", panel of {len(read.panel.copies)}" if isinstance(read, PanelBoard) else ""
    caption = read.auxiliary.title if read.auxiliary else f"{read.of.name} board"
    yield _header(read, caption + copies)
    if read.flexible:
        yield from _flexible(read.flexible, stiffener)
    if read.finger and read.cells_hold:
        yield from _polarity(read, read.cells_hold.letter)
    if fab.remark:
        yield from filter(None, fab.remark.splitlines())
    first = "Places of the terminals" if read.finger else "Pad 1 of each part"
    yield f"{first}, in mm as in the Gerber files, seen from the front:"


def _flexible(flexible: Flexible, stiffener: str) -> Iterator[str]:
    stiff, total_mm = flexible.stiffener, flexible.core_mm
    total_mm += 2 * (flexible.copper_mm + flexible.coverlay_mm)
    yield (
        f"FLEXIBLE BOARD, {total_mm:.3g} mm thick in all: polyimide {flexible.core_mm:.3g} mm, "
        f"copper {flexible.copper_mm:g} mm on both sides, each under a coverlay of "
        f"{flexible.coverlay_mm:g} mm. The layers of solder mask are the coverlays' openings."
    )
    yield (
        f"Stiffener of polyimide, {flexible.stiffener_mm:g} mm, on the back, in mm as in the "
        f"Gerber files: x {stiff.x_min_mm:.3f} to {stiff.x_max_mm:.3f}, y {stiff.y_min_mm:.3f} to "
        f"{stiff.y_max_mm:.3f}; with the board's plated holes in it, 0.3 mm wider. Its outline is "
        f"the drawing {stiffener}, of no copper."
    )
    yield (
        f"It bends where y is above {flexible.bend.y_min_mm:.3f}: there are no vias, and nothing "
        "stiff may be added."
    )


def _polarity(read: ReadBoard, letter: str) -> Iterator[str]:
    """The mark of the parts at the cells, the dots of chips, and what may be turned."""
    assert read.finger
    chip = read.design.packages.at_cells(read.finger)
    one, other = chip.marked, _OTHER[chip.marked]
    yield (
        f"{_range(read, letter, chip.order_number)}, {chip.order_number} by {chip.manufacturer}: "
        f"pad 1 is the {one}, pad 2 the {other}. On the silkscreen a bracket stands round pad 1, a "
        "bar beyond it, or lines beside it."
    )
    known = {"datasheet": ", by its datasheet.", "measured": ": measured."}
    if chip.mark_is_known:
        yield f"The mark on the part itself shows its {one}{known[chip.mark_confidence]}"
    else:
        kind = "LED" if letter == "D" else "photodetector"
        yield (
            f"CHECK BEFORE PLACING: that the mark on the part itself shows its {one} is "
            f"{chip.mark_confidence}, not read from a datasheet. Hold a part against its leaflet; "
            f"if its mark shows the {other}, all {kind}s are turned by 180 degrees against the "
            "placement list."
        )
    if not read.strings:
        yield f"{_range(read, 'U')}: lead 1 is at the dot, on the notch's side."
    elif (switch := read.design.packages.switch) is not None:
        yield f"{_range(read, 'Q', switch.order_number)}: lead 1 is at the dot."
    plain = [found for kind in _SYMMETRIC if (found := _range(read, kind))]
    yield f"{' and '.join(plain)}: either way round."


def _range(read: ReadBoard, letter: str, order_number: str = "") -> str:
    """First and last reference of the bought parts with a letter, and with an order number."""
    found = [
        (int(ref[2] or 0), int(ref[1]), part.ref)
        for part in read.board.parts
        if part.bought and (ref := re.fullmatch(rf"{letter}(\d+)(?:_(\d+))?", part.ref))
        if not order_number or read.ordered(part.ref)[0] == order_number
    ]
    ends = dict.fromkeys(ref for _, _, ref in (min(found), max(found))) if found else ()
    return " to ".join(ends)
