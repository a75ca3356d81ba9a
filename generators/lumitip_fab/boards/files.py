"""Every file of a board, from its parts in their places to the zips that it is ordered with."""

from collections.abc import Callable

from lumitip_fab.boards.circuit import GROUND, SIGNAL, SUPPLY, net_class
from lumitip_fab.boards.courtyards import with_courtyards
from lumitip_fab.boards.fab.notes import (
    assembly_note,
    auxiliary_note,
    fabrication_note,
    stop_note,
)
from lumitip_fab.boards.fab.order import bom_rows, layers_of, order_files
from lumitip_fab.boards.fab.picture import picture_files
from lumitip_fab.boards.kicad.project import project_files
from lumitip_fab.boards.kicad.schematic.auxiliary import auxiliary_sheet
from lumitip_fab.boards.kicad.schematic.files import schematic_files
from lumitip_fab.boards.model import BoardModel, Net, Placement
from lumitip_fab.boards.placed import pad_at
from lumitip_fab.boards.placement import place, refuse_overlaps
from lumitip_fab.boards.pour import pour
from lumitip_fab.boards.route import route
from lumitip_fab.boards.silk.auxiliary import with_legend
from lumitip_fab.boards.silk.outlines import with_outline, without_crowded_lines
from lumitip_fab.boards.teardrops import with_teardrops
from lumitip_fab.boards.verify import require_clean_drc
from lumitip_fab.design import AuxiliaryBoard, Box, Design, Fab, Finger, Reading, Rules, Title
from lumitip_fab.design.frames import Matrix, board_page_to_auxiliary, board_page_to_sensor
from lumitip_fab.pipeline.artefact import Artefact


def board_files(design: Design, finger: Finger) -> tuple[Artefact, ...]:
    """Every file of a finger's board: KiCad project, pictures of both sides, orders.

    Raises:
        BuildError: if a part has no room, a net cannot be routed, or the finished copper breaks
            its rules.
    """
    return finger_files(design, finger, finished(place(design, finger)))


def finger_files(design: Design, finger: Finger, model: BoardModel) -> tuple[Artefact, ...]:
    """Every file of a finger's finished board."""
    board = model.placement
    sheet = schematic_files(board, finger, design)
    chip = design.packages.at_cells(finger)
    notes = {
        **stop_note(board, chip, finger.cells_hold.kind),
        f"{board.name}_fabrication.txt": fabrication_note(
            model, finger.finish, design.stack.pcb_mm
        ),
    }
    return model_files(
        model,
        sheet,
        notes,
        lambda fab: assembly_note(board, finger, design.packages, fab),
        design.stack.pcb_mm,
        finger.finish.mask,
        design.fabs,
        board_page_to_sensor(design.stack),
        "sensor",
    )


def auxiliary_files(design: Design, auxiliary: AuxiliaryBoard) -> tuple[Artefact, ...]:
    """Every file of a board outside the fingers: KiCad project, pictures of both sides, orders.

    Raises:
        BuildError: if two parts overlap, a net cannot be routed, a label has no room, or the
            finished copper breaks its rules.
    """
    bare = _placement(design.title, design.reading, auxiliary, design.rules)
    refuse_overlaps(auxiliary.name, bare.components, "choose smaller parts")
    model = finished(with_legend(bare, auxiliary, design.rules))
    sheet = auxiliary_sheet(model.placement, auxiliary)
    thickness_mm = design.stack.auxiliary_mm
    note = fabrication_note(model, auxiliary.finish, thickness_mm)
    return model_files(
        model,
        sheet,
        {f"{auxiliary.name}_fabrication.txt": note},
        lambda fab: auxiliary_note(model.placement, auxiliary.title, fab),
        thickness_mm,
        auxiliary.finish.mask,
        design.fabs,
        board_page_to_auxiliary(design.stack),
        "auxiliary",
    )


def _hot_loop(auxiliary: AuxiliaryBoard) -> tuple[Box, ...]:
    """The box round the middles of the hot loop's pads; none without a regulator."""
    parts = {part.ref: part for part in auxiliary.components}
    places = [pad_at(parts[ref], number) for ref, number in auxiliary.hot_loop]
    if not places:
        return ()
    xs, ys = zip(*places, strict=True)
    return (Box(min(xs), max(xs), min(ys), max(ys)),)


def _placement(
    title: Title, reading: Reading, auxiliary: AuxiliaryBoard, rules: Rules
) -> Placement:
    outlined = [with_outline(part, rules) for part in auxiliary.components]
    return Placement(
        name=auxiliary.name,
        title=title.on_boards().name,
        revision=title.revision,
        design_hash=reading.design_hash,
        outline=auxiliary.box,
        corner_mm=auxiliary.corner_mm,
        holes=auxiliary.holes,
        hole_mm=auxiliary.hole_mm,
        ties=tuple((at, tie.hole_mm) for tie in auxiliary.ties for at in tie.holes),
        keep_outs=auxiliary.keep_outs,
        edge_clearance_mm=rules.edge_gap_mm,
        hole_clearance_mm=rules.hole_gap_mm,
        components=without_crowded_lines(outlined, rules),
        ground_only=_hot_loop(auxiliary),
        nets=tuple(
            Net(name, SUPPLY if name in auxiliary.supplies else SIGNAL) for name in auxiliary.nets
        ),
        classes=(
            net_class(SIGNAL, rules.track_mm, rules),
            net_class(SUPPLY, rules.supply_track_mm, rules),
        ),
        ground=GROUND,
        silk=(),
        texts=(),
    )


def finished(placement: Placement) -> BoardModel:
    """The board with its copper.

    Raises:
        BuildError: if a net cannot be routed, or the copper breaks its rules.
    """
    routing = route(placement)
    if placement.flexible:
        routing = with_teardrops(placement, routing)
    routing, fills, solid = pour(placement, routing)
    return require_clean_drc(BoardModel(with_courtyards(placement), routing, fills, solid))


def model_files(
    model: BoardModel,
    sheet: dict[str, bytes],
    notes: dict[str, bytes],
    assembly: Callable[[Fab], bytes],
    thickness_mm: float,
    mask: str,
    fabs: tuple[Fab, ...],
    page: Matrix,
    frame: str,
) -> tuple[Artefact, ...]:
    """The files of any finished board.

    Args:
        model: the board.
        sheet: files of its schematic.
        notes: text files of every zip, by name.
        assembly: note for who places the parts, by PCB fab.
        thickness_mm: of it.
        mask: colour of its solder mask.
        fabs: where it may be ordered.
        page: from the board file's page to its frame.
        frame: name of that frame.
    """
    name, layers = model.placement.name, layers_of(model)
    orders = {
        f"order/{path}": data
        for fab in fabs
        for path, data in order_files(
            model, layers, {**notes, f"{name}_assembly.txt": assembly(fab)}, fab, name
        ).items()
    }
    files = {
        **project_files(model, thickness_mm),
        **sheet,
        **picture_files(model, mask),
        **orders,
    }
    facts = {"parts": list(bom_rows(model.placement))}
    return tuple(
        Artefact(f"boards/{name}/{path}", data, page, frame, facts)
        if path.endswith(".kicad_pcb")
        else Artefact(f"boards/{name}/{path}", data, frame="")
        for path, data in files.items()
    )
