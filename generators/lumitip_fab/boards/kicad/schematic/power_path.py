"""The way of the supply on a flange: fuse, MOSFET and TVS diode, then regulators.

```
24V_IN ── F1 ── Q1 ──┬────┬──── R3 ── VIN        VIN ──┬── U1 ── C4 ── L1 ──┬── 5V
                └─ R1┘    D1                           C1                   C2
                   R2     GND                          GND                  GND
```
"""

from collections.abc import Sequence

from lumitip_fab.boards.kicad.schematic import shapes
from lumitip_fab.boards.kicad.schematic.draft import (
    REACH_MM,
    Draft,
    net_of,
    nets_of,
    other_net,
    pads_of,
)
from lumitip_fab.boards.kicad.schematic.shapes import pin_names
from lumitip_fab.boards.kicad.schematic.sheet import GRID_MM, text_mm, up_to_grid
from lumitip_fab.boards.kicad.schematic.symbols import PITCH_MM
from lumitip_fab.boards.model import GROUND
from lumitip_fab.design import Component, Point

Group = Sequence[Component]
_BOOT, _SWITCH, _FEEDBACK = 0, 2, 6
"""Rows of a buck regulator's pins."""
_ABOVE_MM = 5.08, 2.54  # reference and value above the top of a chip
_GATE_MM = 7.62, 10.16  # from the wire to the MOSFET's gate, and to the resistors at it


STEP_MM = 2.54


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


def draw_plug_in(draft: Draft, group: Group) -> None:
    """Fuse, MOSFET against a reversed supply with its gate's resistors, TVS diode, inrush."""
    fuse, transistor = (_only(group, kind) for kind in ("fuse", "transistor"))
    supply, gate, drain = (net_of(transistor, pin) for pin in "SGD")
    rail = Rail(draft, (0.0, 0.0), other_net(fuse, drain))
    rail.supply()
    rail.through(fuse)
    rail.tag()
    node = _transistor(draft, transistor, rail, gate)
    rail.net = supply
    resistors = [part for part in group if part.kind == "resistor"]
    for part in resistors:
        if {supply, gate} == nets_of([part]):
            rail.on()
            draft.wire(node, rail.hang(part))
    lower = Rail(draft, node, gate)
    for part in resistors:
        if {gate, GROUND} == nets_of([part]):
            lower.hang(part)
    rail.to(max(rail.x_mm, lower.x_mm))
    for part in group:
        if {supply, GROUND} == nets_of([part]):
            rail.hang(part)
    rail.supply()
    rail.on()
    for part in resistors:
        if supply in nets_of([part]) and part.ref not in draft.drawn:
            rail.through(part)
            draft.end(rail.net, rail.end(), 1)


def draw_buck(draft: Draft, group: Group) -> None:
    """A step-down regulator with its capacitors, coil and feedback."""
    regulator = group[0]
    switch, boot, vin = (net_of(regulator, pin) for pin in ("SW", "BST", "VIN"))
    rail = Rail(draft, (0.0, 0.0), vin)
    rail.supply()
    rail.on()
    _hang_all(rail, group)
    left = {"VIN": 0, "EN": 2}
    right = {"BST": _BOOT, "SW": _SWITCH, "FB": _FEEDBACK}
    pins = _chip(draft, regulator, rail, left, right)
    if net_of(regulator, "EN") == vin:
        enable = pins["EN"]
        corner = enable[0] - STEP_MM, enable[1]
        draft.wire(enable, corner, (corner[0], rail.y_mm))
    upper, out = Rail(draft, pins["BST"], boot), Rail(draft, pins["SW"], switch)
    upper.tag()
    for part in group:
        if {boot, switch} == nets_of([part]):
            upper.through(part)
            draft.wire(upper.end(), (upper.x_mm, out.y_mm))
    out.tag(270)
    out.to(max(out.x_mm, upper.x_mm))
    for part in group:
        if part.kind == "inductor" and switch in nets_of([part]):
            out.through(part)
    feedback = pins["FB"]
    if net_of(regulator, "FB") == out.net:
        draft.wire(feedback, (out.x_mm, feedback[1]), out.end())
    else:
        draft.end(net_of(regulator, "FB"), feedback, 1)
    out.on(2 * STEP_MM)
    _hang_all(out, group)
    out.supply()


def draw_linear(draft: Draft, group: Group) -> None:
    """A linear regulator between its capacitors."""
    regulator = group[0]
    rail = Rail(draft, (0.0, 0.0), net_of(regulator, "IN"))
    rail.supply()
    rail.on()
    _hang_all(rail, group)
    pins = _chip(draft, regulator, rail, {"IN": 0}, {"OUT": 0})
    out = Rail(draft, pins["OUT"], net_of(regulator, "OUT"))
    out.on()
    _hang_all(out, group)
    out.supply()


def draw_indicator(draft: Draft, group: Group) -> None:
    """A power LED below its resistor."""
    led, resistor = group
    (between,) = nets_of([led]) & nets_of([resistor])
    rail = Rail(draft, (0.0, 0.0), other_net(resistor, between))
    rail.supply()
    x, y = rail.hang(resistor)
    node = x, y + STEP_MM
    draft.wire((x, y), node)
    draft.wire((x - STEP_MM, node[1]), node)
    draft.tag(between, (x - STEP_MM, node[1]), 180)
    draft.stand(led, between, (x, node[1] + REACH_MM))
    draft.power(other_net(led, between), (x, node[1] + 2 * REACH_MM))


def draw_feed(draft: Draft, group: Group) -> None:
    """A diode in the way to the controller."""
    (diode,) = group
    (_, cathode), (_, anode) = diode.nets
    rail = Rail(draft, (0.0, 0.0), anode)
    rail.supply()
    rail.on()
    rail.through(diode)
    draft.end(cathode, rail.end(), 1)


def _transistor(draft: Draft, part: Component, rail: Rail, gate: str) -> Point:
    """The MOSFET in the wire, drain to the left: the place of its gate's resistors."""
    rail.on()
    x, y = rail.end()
    middle = x + 5.08, y + STEP_MM
    shape = shapes.lying(shapes.mosfet(part, "P"))
    assert isinstance(shape, tuple)
    draft.place(part, f"Transistor_{part.ref}", shape, middle, 0, (0.0, -8.89), (0.0, -6.6))
    rail.skip(10.16)
    pin, node = (middle[0], y + _GATE_MM[0]), (middle[0], y + _GATE_MM[1])
    left = middle[0] - STEP_MM, pin[1]
    draft.wire(pin, node)
    draft.wire(left, pin)
    draft.tag(gate, left, 180)
    return node


def _chip(
    draft: Draft, part: Component, rail: Rail, left: dict[str, int], right: dict[str, int]
) -> dict[str, Point]:
    """A chip with row 0 of its left at the wire's end: places of its pins by name."""
    rail.on(2 * STEP_MM)
    names = pin_names(part)
    below = [pad for pad, _ in part.nets if names[pad] == "GND"]
    shape = shapes.chip(part, pads_of(part, left), pads_of(part, right), below)
    beside = -min(x for x, _ in shapes.pins_of(shape).values())
    top = -PITCH_MM
    texts = [(0.0, top - above) for above in _ABOVE_MM]
    x, y = rail.end()
    at = x + beside, y
    pins = draft.place(part, f"{part.kind.capitalize()}_{part.ref}", shape, at, 0, *texts)
    for pad in below:
        draft.power(GROUND, pins[pad])
    return {names[pad]: place for pad, place in pins.items()}


def _hang_all(rail: Rail, group: Group) -> None:
    """Every capacitor of a group between a wire and ground."""
    for part in group:
        if part.kind == "capacitor" and {rail.net, GROUND} == nets_of([part]):
            rail.hang(part)


def _only(group: Group, kind: str) -> Component:
    (part,) = (part for part in group if part.kind == kind)
    return part


_DROP_MM = 2.54  # from the wire to a part that hangs from it
