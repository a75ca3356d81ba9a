"""The pictures of both sides of a board."""

from lumitip_fab.boards.model import SIDES, BoardModel
from lumitip_fab.boards.picture.draw import png_picture, svg_picture
from lumitip_fab.boards.picture.paint import painted


def picture_files(model: BoardModel) -> dict[str, bytes]:
    """PNG and SVG of front and back, by their name."""
    board = model.placement
    files = {}
    for side in SIDES:
        seen = painted(model, side)
        title = f"{board.name} {board.revision}, {board.finger} board, {side}"
        files[f"{board.finger}_{side}.svg"] = svg_picture(seen, title)
        files[f"{board.finger}_{side}.png"] = png_picture(seen)
    return files
