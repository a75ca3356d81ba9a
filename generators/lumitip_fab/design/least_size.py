"""Boards that are smaller than the smallest that a PCB fab assembles."""

from collections.abc import Iterator
from dataclasses import dataclass

from lumitip_fab.design import Design, Fab
from lumitip_fab.design.shape import Box, Point

_NOISE_MM = 1e-9


@dataclass(frozen=True)
class TooSmall:
    """Boards that some PCB fabs, which have the same least size, do not assemble."""

    least_mm: Point
    fabs: tuple[str, ...]
    boards: tuple[str, ...]


def too_small(design: Design) -> Iterator[TooSmall]:
    """By least size, the greatest first. A board with a panel is none of them, and no flexible
    board: of those fabs make panels themselves."""
    boards = [finger.name for finger in design.fingers]
    boards += [board.name for board in design.auxiliary_boards]
    sizes = sorted({fab.least_mm for fab in design.fabs if fab.least_mm}, reverse=True)
    for least in sizes:
        fabs = [fab for fab in design.fabs if fab.least_mm == least]
        if names := tuple(name for name in boards if is_too_small(design, name, fabs[0])):
            yield TooSmall(least, tuple(fab.name for fab in fabs), names)


def is_too_small(design: Design, board: str, fab: Fab) -> bool:
    """Whether a PCB fab does not assemble a board by itself, and there is no panel of it."""
    box, panelled = _box(design, board), {panel.board for panel in design.panels}
    if box is None or board in panelled or fab.least_mm is None:
        return False
    sides = box.width_mm, box.length_mm
    return any(have < least - _NOISE_MM for have, least in zip(sides, fab.least_mm, strict=True))


def _box(design: Design, board: str) -> Box | None:
    """Outline of a rigid board; of a finger's no other board is looked at."""
    if any(finger.name == board for finger in design.fingers):
        return None if design.board.flexible else design.board.box
    return next((each.box for each in design.auxiliary_boards if each.name == board), None)
