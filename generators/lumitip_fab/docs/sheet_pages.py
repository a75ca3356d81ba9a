"""Where the steps of the manual begin on A4, and how large their drawings are there."""

import io
import math
from collections.abc import Callable
from itertools import count

from reportlab.lib.pagesizes import A4
from reportlab.lib.units import mm
from reportlab.pdfgen.canvas import Canvas
from reportlab.platypus import Flowable, KeepTogether, PageBreak
from reportlab.platypus.doctemplate import NullActionFlowable

MARGIN, MARGIN_HIGH = 20 * mm, 18 * mm
"""Beside, and above and below."""
WIDTH = A4[0] - 2 * MARGIN
_HIGH = A4[1] - 2 * MARGIN_HIGH - 12  # less the frame's own padding
_EMPTY = 0.35  # of a page that the next step then begins on


def kept_step(choices: list[Callable[[], list[Flowable]]]) -> list[Flowable]:
    """A step on one page, with the largest drawings that allow it, or one of more pages.

    Args:
        choices: give the step, with smaller and smaller drawings; called where they are needed.
    """
    steps = []
    for choice in choices:
        steps.append(choice())
        if _pages(steps[-1], _HIGH) == 1:
            return [KeepTogether(steps[-1])]
    return [_Long(steps)]


class _Long(Flowable):  # type: ignore[misc]
    """A step of more than one page. It begins on the page of the step before it where it then takes
    no page more, or where much of that page is empty; else on a new one. Its drawings are the
    largest with which it takes the fewest pages."""

    def __init__(self, choices: list[list[Flowable]]) -> None:
        super().__init__()
        self._choices = choices

    def wrap(self, width: float, _high: float) -> tuple[float, float]:
        """Higher than any page: it is always split."""
        return width, math.inf

    def split(self, _width: float, left: float) -> list[Flowable]:
        """The step with drawings for the room that is left."""
        here, more = self._fewest(left)
        on_new, pages = self._fewest(_HIGH)
        if more <= pages or left > _EMPTY * _HIGH:
            # Before a heading something else must come, or it is not kept with its drawing.
            return [NullActionFlowable(), *here]
        return [PageBreak(), *on_new]

    def _fewest(self, room: float) -> tuple[list[Flowable], int]:
        """The step that takes the fewest pages from some room of the first one on."""
        return min(((step, _pages(step, room)) for step in self._choices), key=lambda each: each[1])


def _pages(step: list[Flowable], room: float) -> int:
    """How many pages a step takes, with some room on the first one."""
    measured, pieces = Canvas(io.BytesIO()), list(step)
    for page in count(1):
        after = 0.0  # space below the piece before, which that above the next shares
        while pieces and (high := _high(pieces[0], measured, after)) <= room:
            room -= high
            after = float(pieces.pop(0).getSpaceAfter())
        if not pieces:
            return page
        first, *rest = pieces[0].splitOn(measured, WIDTH, room) or [pieces[0]]
        # What cannot be parted goes to the next page, or overfills one that has nothing else.
        pieces[:1] = rest if rest or room == _HIGH else [first]
        room = _HIGH
    raise AssertionError


def _high(piece: Flowable, measured: Canvas, after: float) -> float:
    """Height of a piece with what it adds to the space below the piece before, and its own."""
    high: float = piece.wrapOn(measured, WIDTH, _HIGH)[1]
    return high + max(float(piece.getSpaceBefore()) - after, 0.0) + float(piece.getSpaceAfter())
