"""Everything that is printed on a board, as strokes."""

from collections.abc import Iterator

from lumitip_fab.boards.geometry import placed
from lumitip_fab.boards.model import Placement, Side, Stroke
from lumitip_fab.boards.strokes import angle_on_board_deg, text_strokes, upright


def silkscreen(board: Placement) -> Iterator[tuple[Side, Stroke]]:
    """Every stroke with its side, in the sensor frame: footprints, references, lines, texts."""
    for part in board.components:
        for stroke in part.footprint.silk:
            points = tuple(placed(part, *point) for point in stroke.points)
            yield part.side, Stroke(points, stroke.width_mm)
        if (text := part.ref_text) is not None:
            at, angle = placed(part, text.x_mm, text.y_mm), angle_on_board_deg(part, text)
            for stroke in text_strokes(part.ref, text, at, angle, part.side):
                yield part.side, stroke
    yield from board.silk
    for side, text in board.texts:
        at, angle = (text.x_mm, text.y_mm), upright(text.angle_deg, side)
        for stroke in text_strokes(text.text, text, at, angle, side):
            yield side, stroke
