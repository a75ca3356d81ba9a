"""Every file of a board, from its circuit to the zips that it is ordered with."""

from collections.abc import Callable

from lumitip_fab.boards.fab.order import assembly_note, layers_of, order_files
from lumitip_fab.boards.fab.picture import picture_files
from lumitip_fab.boards.kicad.project import project_files
from lumitip_fab.boards.kicad.schematic.files import schematic_files
from lumitip_fab.boards.model import BoardModel
from lumitip_fab.boards.placement import place
from lumitip_fab.boards.pour import pour
from lumitip_fab.boards.route import route
from lumitip_fab.boards.teardrops import with_teardrops
from lumitip_fab.boards.verify import sound
from lumitip_fab.design import Board, Fab, Finger, Packages, Reading, Rules, Stack, Title, Wiring
from lumitip_fab.design.frames import Matrix, board_page_to_sensor
from lumitip_fab.pipeline.artefact import Artefact


def board_files(
    title: Title,
    reading: Reading,
    stack: Stack,
    board: Board,
    finger: Finger,
    wiring: Wiring,
    packages: Packages,
    rules: Rules,
    fabs: tuple[Fab, ...],
) -> tuple[Artefact, ...]:
    """The KiCad project, pictures of both sides, and a zip for each board house.

    Args:
        title: of the design.
        reading: which input reads each cell.
        stack: for the board's thickness.
        board: outline and holes.
        finger: whose board it is.
        wiring: strings and lines.
        packages: the parts.
        rules: what copper keeps.
        fabs: where it may be ordered.

    Raises:
        BuildError: if a part has no room, a net cannot be routed, or the finished copper breaks
            its rules.
    """
    placement = place(title, reading, board, finger, wiring, packages, rules)
    routing = route(placement)
    if placement.flexible:
        routing = with_teardrops(placement, routing)
    routing, fills = pour(placement, routing)
    model = sound(BoardModel(placement, routing, fills))
    sheet = schematic_files(placement, wiring, packages)
    return model_files(
        model,
        sheet,
        lambda fab: assembly_note(model.placement, packages, fab),
        stack.pcb_mm,
        fabs,
        board_page_to_sensor(stack),
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
    return tuple(
        Artefact(f"boards/{name}/{path}", data, page, frame)
        if path.endswith(".kicad_pcb")
        else Artefact(f"boards/{name}/{path}", data, frame="")
        for path, data in files.items()
    )
