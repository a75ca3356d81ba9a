"""Every file of a board, from its circuit to the zips that it is ordered with."""

from collections.abc import Callable

from lumitip_fab.boards.fab.order import assembly_note, bom_rows, layers_of, order_files
from lumitip_fab.boards.fab.picture import picture_files
from lumitip_fab.boards.kicad.project import project_files
from lumitip_fab.boards.kicad.schematic.files import schematic_files
from lumitip_fab.boards.model import BoardModel
from lumitip_fab.boards.placement import place
from lumitip_fab.boards.pour import pour
from lumitip_fab.boards.route import route
from lumitip_fab.boards.teardrops import with_teardrops
from lumitip_fab.boards.verify import require_clean_drc
from lumitip_fab.design import Design, Fab, Finger
from lumitip_fab.design.frames import Matrix, board_page_to_sensor
from lumitip_fab.pipeline.artefact import Artefact


def board_files(design: Design, finger: Finger) -> tuple[Artefact, ...]:
    """Every file of a finger's board: KiCad project, pictures of both sides, orders.

    Raises:
        BuildError: if a part has no room, a net cannot be routed, or the finished copper breaks
            its rules.
    """
    wiring, packages = design.wiring, design.packages
    placement = place(
        design.title, design.reading, design.board, finger, wiring, packages, design.rules
    )
    routing = route(placement)
    if placement.flexible:
        routing = with_teardrops(placement, routing)
    routing, fills = pour(placement, routing)
    model = require_clean_drc(BoardModel(placement, routing, fills))
    sheet = schematic_files(placement, wiring, packages)
    return model_files(
        model,
        sheet,
        lambda fab: assembly_note(model.placement, packages, fab),
        design.stack.pcb_mm,
        design.fabs,
        board_page_to_sensor(design.stack),
        "sensor",
    )


def model_files(
    model: BoardModel,
    sheet: dict[str, bytes],
    note: Callable[[Fab], bytes],
    thickness_mm: float,
    fabs: tuple[Fab, ...],
    page: Matrix,
    frame: str,
) -> tuple[Artefact, ...]:
    """The files of any finished board.

    Args:
        model: the board.
        sheet: files of its schematic.
        note: for who places the parts, by board house.
        thickness_mm: of it.
        fabs: where it may be ordered.
        page: from the board file's page to its frame.
        frame: name of that frame.
    """
    name, layers = model.placement.finger, layers_of(model)
    orders = {
        f"order/{path}": data
        for fab in fabs
        for path, data in order_files(model, layers, note(fab), fab, name).items()
    }
    files = {
        **project_files(model, thickness_mm),
        **sheet,
        **picture_files(model),
        **orders,
    }
    facts = {"parts": list(bom_rows(model.placement))}
    return tuple(
        Artefact(f"boards/{name}/{path}", data, page, frame, facts)
        if path.endswith(".kicad_pcb")
        else Artefact(f"boards/{name}/{path}", data, frame="")
        for path, data in files.items()
    )
