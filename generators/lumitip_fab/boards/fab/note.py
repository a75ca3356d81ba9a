"""The note for who places the parts: which way round each of them goes, and what is not certain."""

from collections.abc import Iterator

from lumitip_fab.boards.fab.lists import bom_rows, bought
from lumitip_fab.boards.geometry import pad_at
from lumitip_fab.boards.model import Placement
from lumitip_fab.design import Chip, Fab, Flexible, Packages

_OTHER = {"anode": "cathode", "cathode": "anode", "collector": "emitter", "emitter": "collector"}
_POLAR = {"led": "LED", "photodetector": "photodetector"}


def assembly_note(board: Placement, packages: Packages, fab: Fab) -> bytes:
    """Plain text: what marks mean, how far to trust that, and where each terminal goes.

    Args:
        board: parts in their places.
        packages: for the terminal that a part's mark shows, and its confidence.
        fab: the board house, whose remark is added.
    """
    emitter = board.finger == "emitter"
    chip = packages.led if emitter else packages.photodetector
    lines = [
        f"{board.name}: {board.finger} board, revision {board.revision}, "
        f"design {board.design_hash[:8]}",
        "",
        *(
            _flexible(board.flexible, board.finger + dict(fab.layers)["stiffener"])
            if board.flexible
            else ()
        ),
        *_polarity(board, chip, "led" if emitter else "photodetector"),
        *_others(board),
        *_ordering(board, fab),
        "Places of the terminals, in mm as in the Gerber files, seen from the front:",
        *_places(board, chip),
    ]
    return "".join(f"{line}\n" for line in lines).encode()


def _polarity(board: Placement, chip: Chip, kind: str) -> Iterator[str]:
    parts = [part for part in bought(board) if part.kind == kind]
    yield (
        f"{_refs(board, kind)}, {parts[0].part} by {chip.manufacturer}: pad 1 is the "
        f"{chip.marked}, pad 2 the {_OTHER[chip.marked]}. On the silkscreen a bracket stands round "
        "pad 1, or a bar beside it."
    )
    if chip.confidence == "datasheet":
        yield f"The mark on the part itself shows its {chip.marked}, by its datasheet."
    else:
        yield (
            f"CHECK BEFORE PLACING: that the mark on the part itself shows its {chip.marked} is "
            f"{chip.confidence}, not read from a datasheet. Hold a part against its leaflet; if "
            f"its mark shows the {_OTHER[chip.marked]}, all {_POLAR[kind]}s are turned by 180 "
            "degrees against the placement list."
        )
    yield ""


def _flexible(flexible: Flexible, outline: str) -> Iterator[str]:
    """What must be ordered of a flexible board, and the file with the stiffener's outline."""
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
    plain = [_refs(board, kind) for kind in ("resistor", "capacitor") if kind in kinds]
    yield f"{' and '.join(plain)}: either way round."
    yield ""


def carrier_note(board: Placement, title: str, fab: Fab) -> bytes:
    """The same of a carrier: which pad is the first of each part.

    Args:
        board: parts in their places.
        title: what the board says of itself.
        fab: the board house, whose remark is added.
    """
    lines = [
        f"{board.name}: {title}, revision {board.revision}, design {board.design_hash[:8]}",
        "",
        *_behind(board),
        *_ordering(board, fab),
        "Pad 1 of each part, in mm as in the Gerber files, seen from the front:",
        *(f"{part.ref}  {x:.3f} {y:.3f}" for part in bought(board)
          for x, y in [pad_at(part, "1")]),
    ]  # fmt: skip
    return "".join(f"{line}\n" for line in lines).encode()


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


def _places(board: Placement, chip: Chip) -> Iterator[str]:
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
