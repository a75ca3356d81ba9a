"""Text files that go into a board's zips: a stop line, fabrication and assembly."""

from collections.abc import Iterator

from lumitip_fab.boards.courtyards import pad_at, placed_pads
from lumitip_fab.boards.fab.order import bom_rows, bought
from lumitip_fab.boards.model import BoardModel, Placement
from lumitip_fab.design import Fab, Flexible, Led, Photodetector

STOP_FILE = "STOP_READ_FIRST.txt"
_OTHER = {"anode": "cathode", "cathode": "anode", "collector": "emitter", "emitter": "collector"}
_POLAR = {"led": "LED", "photodetector": "photodetector"}


def stop_note(board: Placement) -> dict[str, bytes]:
    """The file that stops a PCB fab's operator, where the polarity of the parts at the cells is
    not known; nothing where it is, and without cells."""
    if not board.cells or board.cells.part.mark_is_known:
        return {}
    chip, part = board.cells.part, next(part for part in bought(board) if part.kind in _POLAR)
    refs = _refs(board, part.kind)
    text = f"""STOP: do not place {refs} before the customer has confirmed their polarity.

{refs}: {part.part} by {chip.manufacturer}.
Its mark is taken for the {chip.marked}; this is {chip.mark_confidence}, not read from a datasheet.
If the mark shows the {_OTHER[chip.marked]}, every one of these parts must be turned by 180 degrees
against the placement list.

Bare boards may be made at once. Ask the customer before these parts are placed.
"""
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
        f"Thickness: {board.thickness_mm:g} mm",
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


def assembly_note(board: Placement, fab: Fab) -> bytes:
    """Plain text: what marks mean, how far to trust that, and where each terminal goes; on a board
    without parts of polarity, where the first pad of each part is.

    Args:
        board: parts in their places.
        fab: the PCB fab, whose remark is added.
    """
    chip = board.cells.part if board.cells else None
    first = "Pad 1 of each part" if chip is None else "Places of the terminals"
    stiffener = board.name + dict(fab.layers)["stiffener"] if board.flexible else ""
    lines = [
        f"{board.title}: {board.caption}, revision {board.revision}, "
        f"design {board.design_hash[:8]}",
        "",
        *(_flexible(board.flexible, stiffener) if board.flexible else ()),
        *((*_polarity(board, chip), *_others(board)) if chip else _behind(board)),
        *_ordering(board, fab),
        f"{first}, in mm as in the Gerber files, seen from the front:",
        *(_places(board, chip) if chip else _first_pads(board)),
    ]
    return "".join(f"{line}\n" for line in lines).encode()


def _polarity(board: Placement, chip: Led | Photodetector) -> Iterator[str]:
    part = next(part for part in bought(board) if part.kind in _POLAR)
    yield (
        f"{_refs(board, part.kind)}, {part.part} by {chip.manufacturer}: pad 1 is the "
        f"{chip.marked}, pad 2 the {_OTHER[chip.marked]}. On the silkscreen a bracket stands round "
        "pad 1, a bar beyond it, or lines beside it."
    )
    known = {
        "datasheet": f"The mark on the part itself shows its {chip.marked}, by its datasheet.",
        "measured": f"The mark on the part itself shows its {chip.marked}: measured.",
    }
    yield known.get(
        chip.mark_confidence,
        f"CHECK BEFORE PLACING: that the mark on the part itself shows its {chip.marked} is "
        f"{chip.mark_confidence}, not read from a datasheet. Hold a part against its leaflet; if "
        f"its mark shows the {_OTHER[chip.marked]}, all {_POLAR[part.kind]}s are turned by 180 "
        "degrees against the placement list.",
    )
    yield ""


def _flexible(flexible: Flexible, outline: str) -> Iterator[str]:
    """Order note of a flexible board, and the file with the stiffener's outline."""
    bend, stiff = flexible.bend, flexible.stiffener
    total = flexible.core_mm + 2 * (flexible.copper_mm + flexible.coverlay_mm)
    yield (
        f"FLEXIBLE BOARD, {total:.3g} mm thick in all: polyimide {flexible.core_mm:.3g} mm, copper "
        f"{flexible.copper_mm:g} mm on both sides, each under a coverlay of "
        f"{flexible.coverlay_mm:g} mm. The layers of solder mask are the coverlays' openings."
    )
    yield (
        f"Stiffener of polyimide, {flexible.stiffener_mm:g} mm, on the back, in mm as in the "
        f"Gerber files: x {stiff.x_min_mm:.3f} to {stiff.x_max_mm:.3f}, y {stiff.y_min_mm:.3f} to "
        f"{stiff.y_max_mm:.3f}; with the board's plated holes in it, 0.3 mm wider. "
        f"Its outline is the drawing {outline}, of no copper."
    )
    yield (
        f"It bends where y is above {bend.y_min_mm:.3f}: there are no vias, and nothing stiff may "
        "be added."
    )
    yield ""


def _others(board: Placement) -> Iterator[str]:
    kinds = {part.kind for part in bought(board)}
    if "multiplexer" in kinds:
        yield f"{_refs(board, 'multiplexer')}: lead 1 is at the dot, on the notch's side."
    if "switch" in kinds:
        yield f"{_refs(board, 'switch')}: lead 1 is at the dot."
    symmetric = ("resistor", "resistor array", "capacitor")
    plain = [_refs(board, kind) for kind in symmetric if kind in kinds]
    yield f"{' and '.join(plain)}: either way round."
    yield ""


def _first_pads(board: Placement) -> Iterator[str]:
    for part in bought(board):
        x, y = pad_at(part, "1")
        yield f"{part.ref}  {x:.3f} {y:.3f}"


def _behind(board: Placement) -> Iterator[str]:
    behind = [part.ref for part in bought(board) if part.side == "back"]
    if behind:
        yield f"ON THE BACK: {', '.join(behind)}. Everything else is on the front."
        yield ""


def _ordering(board: Placement, fab: Fab) -> Iterator[str]:
    if fab.remark:
        yield fab.remark
        yield ""
    if "lcsc" in (field for _, field in fab.bom):
        unknown = [row["part"] for row in bom_rows(board) if not row["lcsc"]]
        if unknown:
            yield (
                f"Without a number of the distributor in the bill of materials: "
                f"{', '.join(unknown)}. Choose them by hand."
            )
            yield ""


def _places(board: Placement, chip: Led | Photodetector) -> Iterator[str]:
    for part in bought(board):
        if part.kind in _POLAR:
            one, other = (pad_at(part, number) for number in ("1", "2"))
            yield (
                f"{part.ref}  {chip.marked} {one[0]:.3f} {one[1]:.3f}  "
                f"{_OTHER[chip.marked]} {other[0]:.3f} {other[1]:.3f}"
            )


def _refs(board: Placement, kind: str) -> str:
    refs = [part.ref for part in bought(board) if part.kind == kind]
    return refs[0] if len(refs) == 1 else f"{refs[0]} to {refs[-1]}"
