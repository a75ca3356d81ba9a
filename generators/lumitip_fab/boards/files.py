"""Every file of one finger's board, from its circuit to the zips that it is ordered with."""

from lumitip_fab.artefact import Artefact
from lumitip_fab.boards.fab.package import layers_of, order_files
from lumitip_fab.boards.model import BoardModel
from lumitip_fab.boards.pcb.files import project_files
from lumitip_fab.boards.picture.files import picture_files
from lumitip_fab.boards.placement import place
from lumitip_fab.boards.pour import pour
from lumitip_fab.boards.routing import route
from lumitip_fab.boards.schematic.files import schematic_files
from lumitip_fab.boards.verify import sound
from lumitip_fab.design import (
    Board,
    Fab,
    Finger,
    Packages,
    Reading,
    Rules,
    Stack,
    Title,
    Wiring,
)
from lumitip_fab.frames import board_page_to_sensor


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
    routing, fills = pour(placement, route(placement))
    model = sound(BoardModel(placement, routing, fills))
    layers = layers_of(model)
    orders = {
        f"order/{name}": data
        for fab in fabs
        for name, data in order_files(model, layers, packages, fab, finger.name).items()
    }
    files = {
        **project_files(model, stack.pcb_mm),
        **schematic_files(placement, wiring, packages),
        **picture_files(model),
        **orders,
    }
    page = board_page_to_sensor(stack)
    return tuple(
        Artefact(f"boards/{finger.name}/{name}", data, page)
        if name.endswith(".kicad_pcb")
        else Artefact(f"boards/{finger.name}/{name}", data, frame="")
        for name, data in files.items()
    )
