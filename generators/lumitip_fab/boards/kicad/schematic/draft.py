"""A block while it is drawn: parts in their places, wires from pin to pin, names at ends."""

from collections.abc import Iterable, Mapping, Sequence

from lumitip_fab.boards.kicad.schematic import shapes, symbols
from lumitip_fab.boards.kicad.schematic.shapes import pin_names
from lumitip_fab.boards.kicad.schematic.sheet import GRID_MM, Sheet, text_mm, up_to_grid
from lumitip_fab.boards.kicad.sexpr import Node
from lumitip_fab.boards.model import GROUND
from lumitip_fab.design import Component, Point

REACH_MM = 3.81
"""From the middle of a part with two terminals to its pins."""
_LYING_MM, _WIDE_MM = 2.54, 3.302
"""From the middle of a lying part to its texts; of capacitors, whose plates are wider."""
_STANDING_MM = 2.794  # from the middle of a standing part to its texts
_SYMBOL_MM = 3.302  # from the wire's end to the name of a supply, sideways


class Draft:
    """A drawing with its own origin.

    Attributes:
        sheet: what is drawn so far.
        shapes: its symbols by name.
        drawn: references of the parts that are drawn.
    """

    def __init__(self, supplies: Sequence[str]) -> None:
        self.sheet = Sheet()
        self.shapes: dict[str, Node] = {}
        self.drawn: set[str] = set()
        self._supplies = supplies

    def place(
        self,
        part: Component,
        name: str,
        shape: Node,
        at: Point,
        angle_deg: int = 0,
        ref_at: Point | None = None,
        value_at: Point | None = None,
    ) -> dict[str, Point]:
        """Draw a part: places of its pins, by their numbers."""
        self.shapes[name] = shape
        self.drawn.add(part.ref)
        self.sheet.part(name, part, at, angle_deg, (), ref_at, value_at)
        turned = {0: (1, 0), 90: (0, 1), 180: (-1, 0), 270: (0, -1)}[angle_deg]
        cos, sin = turned
        return {
            number: (at[0] + x * cos - y * sin, at[1] - x * sin - y * cos)
            for number, (x, y) in shapes.pins_of(shape).items()
        }

    def lay(self, part: Component, left_net: str, at: Point) -> None:
        """A part with two terminals along a wire, one of its nets to the left."""
        angle_deg = 90 if part.nets[0][1] == left_net else 270
        off = _WIDE_MM if part.kind == "capacitor" else _LYING_MM
        name, shape = symbols.two_terminals(part.kind)
        self.place(part, name, shape, at, angle_deg, (0.0, -off), (0.0, off))

    def stand(self, part: Component, upper_net: str, at: Point) -> float:
        """A part with two terminals across wires: how far its texts reach to the right."""
        angle_deg = 0 if part.nets[0][1] == upper_net else 180
        wide = max(map(text_mm, (part.ref, part.value)))
        name, shape = symbols.two_terminals(part.kind)
        texts = [
            (_STANDING_MM + text_mm(words) / 2, y)
            for words, y in ((part.ref, -GRID_MM), (part.value, GRID_MM))
        ]
        self.place(part, name, shape, at, angle_deg, *texts)
        return up_to_grid(_STANDING_MM + wide)

    def wire(self, *points: Point) -> None:
        """A wire along some corners."""
        self.sheet.wire(*points)

    def power(self, net: str, at: Point) -> None:
        """The symbol of a supply above a place, or that of ground below it."""
        self._supply_shape(net)
        self.sheet.power(net, at)

    def fed(self, at: Point, angle_deg: int) -> None:
        """The flag of a net that is fed from elsewhere."""
        self._supply_shape("PWR_FLAG")
        self.sheet.power("PWR_FLAG", at, angle_deg)

    def tag(self, net: str, at: Point, angle_deg: int = 90) -> None:
        """The name of a net that does not leave the block, beside its wire."""
        self.sheet.flag(net, at, angle_deg)

    def end(self, net: str, at: Point, side: int) -> None:
        """The end of a wire to the left (-1) or right (1): a supply's symbol, or a label."""
        if not self.is_supply(net):
            self.sheet.flag(net, at, 0 if side > 0 else 180)
            return
        self._supply_shape(net)
        angle_deg = 90 if (net == GROUND) == (side > 0) else 270
        beyond = side * (_SYMBOL_MM + text_mm(net) / 2), 0.0
        self.sheet.power(net, at, angle_deg, beyond)

    def is_supply(self, net: str) -> bool:
        """Whether a net is drawn with the symbol of a supply."""
        return net in self._supplies

    def text(self, words: str, at: Point, height_mm: float = GRID_MM) -> None:
        """A line of text that begins at a place."""
        self.sheet.texts.append((words, at, height_mm))

    def _supply_shape(self, net: str) -> None:
        self.shapes[net] = symbols.supply(net)


def other_net(part: Component, net: str) -> str:
    """Net of the other terminal of a part with two."""
    (_, one), (_, other) = part.nets
    return other if one == net else one


def net_of(part: Component, pin: str) -> str:
    """Net of a pin by its name."""
    names = pin_names(part)
    return next(net for pad, net in part.nets if names[pad] == pin)


def pads_of(part: Component, names: Mapping[str, int]) -> list[tuple[str, int]]:
    """Pads of pins with their rows, from the pins' names."""
    called = pin_names(part)
    return [(pad, names[called[pad]]) for pad, _ in part.nets if called[pad] in names]


def nets_of(parts: Iterable[Component]) -> set[str]:
    """Nets of all pads of parts."""
    return {net for part in parts for _, net in part.nets}
