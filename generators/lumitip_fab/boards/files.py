"""Every file of a board, from its parts in their places to the zips that it is ordered with."""

from lumitip_fab.boards.courtyards import with_courtyards
from lumitip_fab.boards.fab.assembly_drawing import assembly_drawings
from lumitip_fab.boards.fab.groups import groups
from lumitip_fab.boards.fab.notes import assembly_note, fabrication_note, stop_note
from lumitip_fab.boards.fab.order import assembled, bom_rows, by_hand, layers_of, order_files
from lumitip_fab.boards.fab.picture import picture_files
from lumitip_fab.boards.kicad.project import project_files
from lumitip_fab.boards.kicad.schematic import schematic_files
from lumitip_fab.boards.model import BoardModel, Placement
from lumitip_fab.boards.panel.model import panel_files
from lumitip_fab.boards.placement import place
from lumitip_fab.boards.pour import pour
from lumitip_fab.boards.route import route
from lumitip_fab.boards.route.wider import with_wider_tracks
from lumitip_fab.boards.teardrops import with_teardrops
from lumitip_fab.boards.verify import require_clean_drc
from lumitip_fab.design import AuxiliaryBoard, Design, Finger
from lumitip_fab.design.frames import board_page_to_auxiliary, board_page_to_sensor
from lumitip_fab.design.least_size import is_too_small
from lumitip_fab.pipeline.artefact import Artefact


def board_files(design: Design, board: Finger | AuxiliaryBoard) -> tuple[Artefact, ...]:
    """Every file of a board: KiCad project, pictures of both sides, orders; and of its panel.

    Raises:
        BuildError: if a part, a label or a tab has no room, a net cannot be routed, or the
            finished copper breaks its rules.
    """
    model = finished(place(design, board))
    panels = (panel_files(design, p, model) for p in design.panels if p.board == board.name)
    return (*model_files(design, model), *(file for files in panels for file in files))


def finished(placement: Placement) -> BoardModel:
    """The board with its copper.

    Raises:
        BuildError: if a net cannot be routed, or the copper breaks its rules.
    """
    routing = with_wider_tracks(placement, route(placement))
    if placement.flexible:
        routing = with_teardrops(placement, routing)
    routing, fills, solid = pour(placement, routing)
    return require_clean_drc(BoardModel(with_courtyards(placement), routing, fills, solid))


def model_files(design: Design, model: BoardModel) -> tuple[Artefact, ...]:
    """Every file of a finished board."""
    board, layers = model.placement, layers_of(model)
    notes = {**stop_note(board), f"{board.name}_fabrication.txt": fabrication_note(model)}
    files = {
        **project_files(model, board.thickness_mm),
        **schematic_files(board, design),
        **picture_files(model, board.finish.mask),
        **assembly_drawings(board),
    }
    for fab in design.fabs:
        small = is_too_small(design, board.name, fab)
        texts = {**notes, f"{board.name}_assembly.txt": assembly_note(board, fab, small)}
        orders = order_files(model, layers, texts, fab, board.name)
        files |= {f"order/{path}": data for path, data in orders.items()}
    # Cells are in the sensor frame of their finger, and with them the whole board.
    frame = "sensor" if board.cells else "auxiliary"
    to_frame = board_page_to_sensor if board.cells else board_page_to_auxiliary
    facts = {
        "parts": list(bom_rows(assembled(board))),
        "by_hand": list(bom_rows(by_hand(board))),
        "groups": groups(board, design.wiring.adc_pins),
    }
    return tuple(
        Artefact(f"boards/{board.name}/{path}", data, to_frame(design.stack), frame, facts)
        if path.endswith(".kicad_pcb")
        else Artefact(f"boards/{board.name}/{path}", data, frame="")
        for path, data in files.items()
    )
