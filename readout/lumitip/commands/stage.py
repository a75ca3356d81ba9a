"""The step of `lumitip accept` in which a printer moves the sheet."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lumitip.acceptance.stage import START_MM, Traverse, places_mm, ways_mm
from lumitip.errors import LumitipError
from lumitip.fingertip import Fingertip
from lumitip.frame import Values, complement

if TYPE_CHECKING:
    from lumitip.links.printer import Printer

SETTLE_S = 0.3
"""After a move: the head swings, and frames are on their way."""
FRAMES = 5
"""Of each place."""
_AXES = "XYZ"
_HOW = ("across the fingers, from one side", "along the fingers, from the tip")


@dataclass(frozen=True)
class Stage:
    """A printer, and how its head moves the sheet."""

    printer: "Printer"
    directions: tuple[str, str]
    """Across the fingers and along them, such as `("Z-", "Y+")`."""

    def traverses(
        self, tip: Fingertip, timeout_s: float, ask: Callable[[str], None]
    ) -> Iterator[Traverse]:
        """Move the sheet over the cells of a fingertip, across and along, to and fro.

        Args:
            tip: the fingertip.
            timeout_s: most time to wait for a frame.
            ask: prints a text, and waits for Enter.

        Raises:
            LinkError: if the printer refuses, or one of both does not answer.
        """
        for direction, way_mm, how in zip(self.directions, ways_mm(tip.layout), _HOW, strict=True):
            ask(
                "move the head by the printer's menu until the sheet is between the fingers, its "
                f"edge at most {START_MM:g} mm before the first holes; it will go {way_mm:g} mm "
                f"along {direction}, {how}, and back. Nothing may be in its way"
            )
            yield self._traverse(direction, way_mm, tip, timeout_s)

    def _traverse(
        self, direction: str, way_mm: float, tip: Fingertip, timeout_s: float
    ) -> Traverse:
        axis, sign = direction[0], -1.0 if direction[1] == "-" else 1.0
        moved_mm = places_mm(way_mm)
        light = []
        for step_mm in np.diff(moved_mm, prepend=0.0).tolist():
            if step_mm:
                self.printer.move(axis, sign * step_mm)
            light.append(_settled(tip, timeout_s))
        return Traverse(direction, moved_mm, np.stack(light))


@contextmanager
def opened(named: list[str] | None) -> Iterator[Stage | None]:
    """The stage of `--stage`, whose port is open; `None` without that option.

    Raises:
        LumitipError: if a direction is none, or both have the same axis.
        LinkError: if no printer answers at the address.
    """
    if named is None:
        yield None
        return
    address, *directions = named
    both = _checked(directions)
    from lumitip.links.printer import Printer  # needs pyserial

    with Printer(address) as printer:
        print(f"printer: {printer.firmware}")
        yield Stage(printer, both)


def _checked(directions: list[str]) -> tuple[str, str]:
    for direction in directions:
        if len(direction) != 2 or direction[0] not in _AXES or direction[1] not in "+-":
            raise LumitipError(
                f"--stage has the direction {direction!r}; an axis and a sign are needed, such as "
                "Z-"
            )
    across, along = directions
    if across[0] == along[0]:
        raise LumitipError(
            f"--stage has the directions {across} and {along}; two different axes are needed"
        )
    return across, along


def _settled(tip: Fingertip, timeout_s: float) -> Values:
    """Light of the next frames after the settling time, shape `(frames, cells)`."""
    first = tip.wait_latest(timeout_s).t
    while tip.wait_latest(timeout_s).t < first + SETTLE_S:
        pass
    frames = [tip.wait_latest(timeout_s) for _ in range(FRAMES)]
    return np.stack([complement(frame.raw, frame.bits) for frame in frames])
