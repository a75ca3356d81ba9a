"""A wire from left to right with parts in it and parts that hang from it."""

from lumitip_fab.boards.kicad.schematic.draft import REACH_MM, Draft, other_net
from lumitip_fab.boards.kicad.schematic.text_size import GRID_MM, text_mm, up_to_grid
from lumitip_fab.boards.model import GROUND
from lumitip_fab.design import Component, Point

STEP_MM = 2.54
_DROP_MM = 2.54  # from the wire to a part that hangs from it


class Rail:
    """The right end of a wire, which grows.

    Attributes:
        x_mm: its end.
        y_mm: its height on the sheet.
        net: its name.
    """

    def __init__(self, draft: Draft, at: Point, net: str) -> None:
        self.draft, self.net = draft, net
        self.x_mm, self.y_mm = at
        self._wired_mm = self.x_mm

    def on(self, length_mm: float = STEP_MM) -> None:
        """Go on to the right; the wire follows when something is joined to it."""
        self.x_mm += length_mm

    def to(self, x_mm: float) -> None:
        """Go on to a place, unless it is passed."""
        self.x_mm = max(self.x_mm, x_mm)

    def end(self) -> Point:
        """Its end, with the wire up to there."""
        if self.x_mm > self._wired_mm:
            self.draft.wire((self._wired_mm, self.y_mm), (self.x_mm, self.y_mm))
        self._wired_mm = self.x_mm
        return self.x_mm, self.y_mm

    def skip(self, length_mm: float) -> None:
        """Go on without a wire, past a part."""
        self.end()
        self.x_mm += length_mm
        self._wired_mm = self.x_mm

    def tag(self, angle_deg: int = 90) -> None:
        """Its name, beside it."""
        self.on()
        self.draft.tag(self.net, self.end(), angle_deg)
        self.on()

    def supply(self) -> None:
        """The symbol of its supply, above it."""
        self.draft.power(self.net, self.end())

    def through(self, part: Component) -> None:
        """A part in the wire: from there on it is the part's other net."""
        wide = max(map(text_mm, (part.ref, part.value)))
        beside = max(GRID_MM, up_to_grid(wide / 2 - REACH_MM + GRID_MM / 2))
        self.on(beside)
        self.draft.lay(part, self.net, (self.x_mm + REACH_MM, self.y_mm))
        self.skip(2 * REACH_MM)
        self.net = other_net(part, self.net)
        self.on(beside)

    def hang(self, part: Component) -> Point:
        """A part from the wire down to ground, or to the place that is returned."""
        x, y = self.end()
        upper = y + _DROP_MM
        lower = upper + 2 * REACH_MM
        self.draft.wire((x, y), (x, upper))
        reach = self.draft.stand(part, self.net, (x, upper + REACH_MM))
        if other_net(part, self.net) == GROUND:
            self.draft.power(GROUND, (x, lower))
        self.on(reach + STEP_MM)
        return x, lower
