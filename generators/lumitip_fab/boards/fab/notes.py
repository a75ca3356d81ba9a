"""Text files that go into a board's zips: a stop line, fabrication and assembly."""

from collections.abc import Iterator

from lumitip_fab.boards.fab.order import (
    TEXTS,
    assembled,
    bom_rows,
    bought,
    by_hand,
    polarity_unknown,
    turned_by_assumption,
)
from lumitip_fab.boards.fab.ways import lying, range_of
from lumitip_fab.boards.model import AT_CELLS, BoardModel, Placement
from lumitip_fab.boards.placed import pad_at, placed_pads
from lumitip_fab.design import Fab, Flexible, Led, Panel, Photodetector
from lumitip_fab.design.boards import thickness_off_mm
from lumitip_fab.design.packages import OTHER
from lumitip_fab.text import passage

STOP_FILE = "STOP_READ_FIRST.txt"


def stop_note(board: Placement) -> dict[str, bytes]:
    """The file that stops a PCB fab's operator, where the polarity of the parts at the cells is
    not known; nothing where it is, and without cells."""
    if board.cells is None or not polarity_unknown(board):
        return {}
    chip, parts = board.cells.part, [part for part in bought(board) if part.kind in AT_CELLS]
    text = passage(TEXTS, "stop").format(
        refs=range_of(parts), part=parts[0].part, chip=chip, other=OTHER[chip.marked]
    )
    return {STOP_FILE: text.encode()}


def fabrication_note(model: BoardModel) -> bytes:
    """Figures that a board is made by, a line each, and its finish."""
    finish = model.placement.finish
    board, tracks, vias = model.placement, model.routing.tracks, model.routing.vias
    width, length = board.outline.width_mm, board.outline.length_mm
    pins = [pad.pad.drill_mm for part in board.components for pad in placed_pads(part)]
    drills = [via.drill_mm for via in vias] + [drill for drill in pins if drill]
    flexible = board.flexible
    lines = [
        f"{board.title}: {board.name} board, revision {board.revision}, "
        f"design {board.design_hash[:8]}",
        "",
        "Copper layers: 2",
        f"Material: {'polyimide, see the assembly note' if flexible else 'FR-4, Tg 130 or more'}",
        f"Size: {width:.2f} x {length:.2f} mm",
        f"Thickness: {board.thickness_mm:g} mm{_off(board)}",
        f"Copper: {flexible.copper_mm * 1000 if flexible else finish.copper_um:g} um on each side",
        f"Surface: {finish.surface}",
        f"{'Coverlay' if flexible else 'Solder mask'}: {finish.mask}, on both sides",
        "Silkscreen: white, on both sides",
    ]
    lines += [f"Narrowest track: {min(t.width_mm for t in tracks):g} mm"] if tracks else []
    lines += [f"Smallest drill: {min(drills):g} mm"] if drills else []
    lines += ["Vias: covered by the mask, not filled", "Electrical test: every board"]
    lines += ["", f"Why {finish.mask}: {finish.reason}."] if finish.reason else []
    return "".join(f"{line}\n" for line in lines).encode()


def _off(board: Placement) -> str:
    """The tolerance of a rigid board's thickness; a finger's board lies in a pocket."""
    return "" if board.flexible else f", +/-{thickness_off_mm(board.thickness_mm):.2g} mm"


def panel_note(panel: Panel) -> str:
    """Lines of the fabrication note on copies, gaps, tabs, rails and marks."""
    rules, copies = panel.rules, len(panel.copies)
    return passage(TEXTS, "panel").format(
        panel=panel, rules=rules, copies=copies, radius_mm=rules.gap_mm / 2
    )


def assembly_note(board: Placement, fab: Fab, small: bool = False) -> bytes:
    """Plain text: what marks mean, how far to trust that, and where each terminal goes; on a board
    without parts of polarity, where the first pad of each part is.

    Args:
        board: parts in their places.
        fab: the PCB fab, whose remark is added.
        small: whether it does not assemble the board by itself.
    """
    chip = board.cells.part if board.cells else None
    first = "Pad 1 of each part" if chip is None else "Places of the terminals"
    stiffener = board.name + dict(fab.layers)["stiffener"] if board.flexible else ""
    lines = [
        f"{board.title}: {board.caption}, revision {board.revision}, "
        f"design {board.design_hash[:8]}",
        "",
        *(_flexible(board.flexible, stiffener) if board.flexible else ()),
        *((passage(TEXTS, "small").format(least=fab.least_mm), "") if small else ()),
        *lying(board),
        *_behind(board),
        *_by_hand(board),
        *_assumed(board, fab),
        *_ordering(board, fab),
        f"{first}, in mm as in the Gerber files, seen from the front:",
        *(_places(board, chip) if chip else _first_pads(board)),
    ]
    return "".join(f"{line}\n" for line in lines).encode()


def _flexible(flexible: Flexible, outline: str) -> Iterator[str]:
    """Order note of a flexible board, and the file with the stiffener's outline."""
    total_mm = flexible.core_mm + 2 * (flexible.copper_mm + flexible.coverlay_mm)
    yield passage(TEXTS, "flexible").format(
        flexible=flexible, total_mm=total_mm, stiff=flexible.stiffener, outline=outline
    )
    yield ""


def _first_pads(board: Placement) -> Iterator[str]:
    for part in assembled(board):
        x, y = pad_at(part, "1")
        yield f"{part.ref}  {x:.3f} {y:.3f}"


def _behind(board: Placement) -> Iterator[str]:
    behind = [part.ref for part in assembled(board) if part.side == "back"]
    if behind:
        yield f"ON THE BACK: {', '.join(behind)}. Everything else is on the front."
        yield ""


def _by_hand(board: Placement) -> Iterator[str]:
    """Parts of the board that the PCB fab does not mount."""
    parts = [f"{p.ref} ({p.manufacturer} {p.part})" for p in by_hand(board)]
    if parts:
        yield passage(TEXTS, "by_hand").format(parts=", ".join(parts))
        yield ""


def _assumed(board: Placement, fab: Fab) -> Iterator[str]:
    """Parts whose angle in the placement list is assumed."""
    refs = [part.ref for part in assembled(board) if turned_by_assumption(part, fab)]
    if refs:
        yield passage(TEXTS, "turned").format(refs=", ".join(refs))
        yield ""


def _ordering(board: Placement, fab: Fab) -> Iterator[str]:
    if fab.remark:
        yield fab.remark
        yield ""
    if "lcsc" in (field for _, field in fab.bom):
        unknown = [row["part"] for row in bom_rows(assembled(board)) if not row["lcsc"]]
        if unknown:
            yield (
                f"Without a number of the distributor in the bill of materials: "
                f"{', '.join(unknown)}. Choose them by hand."
            )
            yield ""


def _places(board: Placement, chip: Led | Photodetector) -> Iterator[str]:
    for part in bought(board):
        if part.kind in AT_CELLS:
            one, other = (pad_at(part, number) for number in ("1", "2"))
            yield (
                f"{part.ref}  {chip.marked} {one[0]:.3f} {one[1]:.3f}  "
                f"{OTHER[chip.marked]} {other[0]:.3f} {other[1]:.3f}"
            )
