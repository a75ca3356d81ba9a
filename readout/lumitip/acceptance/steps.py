"""The steps of the protocol, and the frames of a fingertip at each."""

from dataclasses import dataclass

from lumitip.acceptance.stage import Traverse
from lumitip.frame import Values


@dataclass(frozen=True, eq=False)
class Frames:
    """Light of all cells at each step, not calibrated, 255 is full light.

    Arrays have the shape `(frames, cells)`.
    """

    empty: Values
    """Nothing between the fingers, closed to the gauge's gap."""
    sheet: Values
    """Sheet metal over all cells."""
    moving: Values
    """The sheet moved over all cells, in all directions."""
    gauge: tuple[Values, ...]
    """Each placement of the gauge."""
    traverses: tuple[Traverse, ...] = ()
    """Of a stage that moved the sheet; their frames are those of `moving`."""
