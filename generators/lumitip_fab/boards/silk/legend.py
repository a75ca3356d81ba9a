"""Silkscreen of a board: notes, names of contacts, references, and the title on each side."""

import dataclasses
from collections.abc import Sequence

import numpy as np

from lumitip_fab.boards.model import SIDES, Placement
from lumitip_fab.boards.silk.names import draw_shroud, print_names
from lumitip_fab.boards.silk.page import Page
from lumitip_fab.boards.silk.references import print_references
from lumitip_fab.design import Note, Point, Rules, Side

_TITLE_MM = 1.0  # height beside cells
_STEP_MM = 0.25
_REMEDY = {
    True: "give it wider margins in [board], or a shorter name",
    False: "fewer digits in supply.voltage_v, shorter names of lines in [flange], or a larger "
    "breakout.board_mm",
}
"""Remedies for a board with cells, and for one without."""


def with_legend(
    board: Placement, title_at: Point, notes: Sequence[Note], rules: Rules
) -> Placement:
    """The board with its silkscreen.

    Args:
        board: parts in their places.
        title_at: near which its title stands.
        notes: lines on its front.
        rules: for the least size of letters and lines.

    Raises:
        BuildError: if a note, a required label, the title or the arrow has no room, with the
            numbers.
    """
    page = Page(board, rules)
    for note in notes:
        text = page.text(note.text, note.at, note.height_mm, note.angle_deg)
        page.require(repr(note.text), [text])
    print_names(page)
    components = print_references(page)
    for part in components:
        draw_shroud(page, part)
    if not board.cells:
        for side in SIDES:
            page.sides[side].take(*page.bodies[side].over.values())
    # The front of a board with cells has room along its edges alone.
    arrows = [
        _along_the_edges(page) if board.cells and side == "front" else _block(page, side, title_at)
        for side in SIDES
    ]
    if board.cells and not any(arrows):
        page.miss("the arrow to the tip", 3.0, 1.0, board.outline.centre_mm)
    page.refuse_losses(_REMEDY[bool(board.cells)])
    return dataclasses.replace(
        board, components=components, silk=tuple(page.strokes), texts=tuple(page.texts)
    )


def _along_the_edges(page: Page) -> bool:
    """Along the long edges of the front where there is room: arrow to the tip and name; finger,
    revision and design. Tells whether the arrow is there."""
    board, box = page.board, page.board.outline
    ys = np.arange(box.y_max_mm - 2.0, box.y_min_mm, -_STEP_MM).tolist()
    inwards = np.arange(_TITLE_MM, 4.0, _STEP_MM).tolist()
    left, right = (
        [edge + sign * d for d in inwards] for edge, sign in ((box.x_min_mm, 1), (box.x_max_mm, -1))
    )
    arrow = page.arrow("front", ((x, y) for x in left for y in ys))
    revision = f"{board.name} rev {board.revision}  {board.design_hash[:8]}"
    for xs, line in ((left, board.title), (right, revision)):
        for height in (_TITLE_MM, 0.0):
            if page.first_free(
                "front", (page.text(line, (x, y), height, 90.0) for x in xs for y in ys)
            ):
                break
    return arrow


def _block(page: Page, side: Side, at: Point) -> bool:
    """The whole title, and on a board with cells what the marks mean, and an arrow to the tip.
    Tells whether the arrow is there."""
    board = page.board
    lines = _lines(board)
    room = page.block(side, lines, at)
    if room is None:
        height = page.text("", at).height_mm * 1.8 * len(lines)
        longest = max(page.length_mm(words) for words, _ in lines)
        page.miss(f"the title on the {side}", height, longest, at)
        return False
    if not board.cells:
        return False
    x = room.centre_mm[0]
    below = [(x, room.y_min_mm - d) for d in np.arange(0.5, 10.0, _STEP_MM).tolist()]
    return page.arrow(side, [*below, *page.anywhere((x, at[1]))])


def _lines(board: Placement) -> tuple[tuple[str, float], ...]:
    """Lines of the title, each with its height."""
    design = board.design_hash[:8]
    if not board.cells:
        last = f"rev {board.revision}  {design}"
        return (board.title, 2.0), (board.caption, 1.5), (last, 1.2)
    return (
        (board.title, 2.0),
        (f"{board.caption}  rev {board.revision}", 1.5),
        (f"design {design}", 1.5),
        (f"bracket: {board.cells.part.marked}", 1.2),
    )
