"""The files of a board's KiCad project, but for the schematic."""

from lumitip_fab.boards.model import BoardModel
from lumitip_fab.boards.pcb.board import board_file
from lumitip_fab.boards.pcb.footprint import (
    LIBRARY,
    hole_library_file,
    hole_name,
    library_file,
)
from lumitip_fab.boards.pcb.project import library_table, project_file


def project_files(model: BoardModel, thickness_mm: float) -> dict[str, bytes]:
    """Board, project and footprint library, by their path beside the board.

    Args:
        model: the finished board.
        thickness_mm: of the finished board.
    """
    board = model.placement
    shapes = {c.footprint.name: c for c in board.components}
    hole = {f"{hole_name(board.hole_mm)}": hole_library_file(board.hole_mm)}
    mods = {name: library_file(c) for name, c in sorted(shapes.items())} | hole
    return {
        f"{board.finger}.kicad_pcb": board_file(model, thickness_mm),
        f"{board.finger}.kicad_pro": project_file(board, f"{board.finger}.kicad_pro"),
        "fp-lib-table": library_table(),
        **{f"{LIBRARY}.pretty/{name}.kicad_mod": data for name, data in mods.items()},
    }
