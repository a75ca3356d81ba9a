"""Blocks of a board that holds no cells: contacts, the supply's way, controller, cables."""

import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial

from lumitip_fab.boards.kicad.schematic import power_path
from lumitip_fab.boards.kicad.schematic.contact_blocks import draw_sockets, draw_strips
from lumitip_fab.boards.kicad.schematic.draft import REACH_MM, Draft, net_of, nets_of, other_net
from lumitip_fab.boards.kicad.schematic.module_block import draw_module
from lumitip_fab.boards.kicad.schematic.protection_block import draw_protection
from lumitip_fab.boards.kicad.schematic.shapes import pin_names, pin_type
from lumitip_fab.boards.kicad.schematic.symbols import TWO_TERMINALS, drawn
from lumitip_fab.boards.model import GROUND, SUPPLY, Placement
from lumitip_fab.design import Component

Parts = Sequence[Component]
Titled = tuple[str, Draft]
Drawing = tuple[str, Callable[[Draft], None]]
"""A title and what draws the block."""
_LEADERS = ("fuse", "regulator", "indicator", "module", "esd diode", "schottky diode")
"""Kinds of parts that begin a block; the parts after them on the board's list belong to it. ESD
diodes are in one."""
_CABLES = {"S0": "To the receiver", "LED": "To the emitter", "D+": "USB", "DIO": "Debugger"}
"""Use of wire pads by one of their nets."""
_FLAG_STEPS = 5


def auxiliary_blocks(board: Placement) -> list[Titled]:
    """The blocks of a board with their titles: each part with a net is in one."""
    parts = [part for part in board.components if part.nets]
    contacts, circuits = [p for p in parts if p.contacts], _groups(parts)
    supplies = _supplies(board, contacts, circuits)
    drawings = [
        *_first(contacts),
        *(drawing for group in circuits for drawing in _circuit(group, parts)),
        *_leaving(contacts, supplies),
        *_probes(parts),
    ]
    found = [(title, _drafted(supplies, draw)) for title, draw in drawings]
    drawn = set().union(*(draft.drawn for _, draft in found))
    others = [part for part in parts if part.ref not in drawn]
    if others:
        found.append(("Other parts", _drafted(supplies, partial(draw_alone, parts=others))))
    flags = _flags(_not_made(parts, supplies))
    return [*found, ("Power flags", _drafted(supplies, flags))]


def _drafted(supplies: Sequence[str], draw: Callable[[Draft], None]) -> Draft:
    draft = Draft(supplies)
    draw(draft)
    return draft


def _groups(parts: Parts) -> list[list[Component]]:
    """Parts that are drawn together: each group with what its first part is for."""
    found: list[list[Component]] = []
    for part in parts:
        if part.kind in _LEADERS and not (found and found[-1][0].kind == part.kind == "esd diode"):
            found.append([])
        if found and not part.contacts and part.kind != "test point":
            found[-1].append(part)
    return sorted(found, key=lambda group: group[0].kind == "module")  # it is large


def _supplies(board: Placement, contacts: Parts, circuits: Sequence[Parts]) -> list[str]:
    """Nets that are drawn with a supply's symbol: ground, and those that lead out of a block; none
    that a chip switches."""
    blocks = [nets_of([part]) for part in contacts] + [nets_of(group) for group in circuits]
    fed = {net.name for net in board.nets if net.net_class == SUPPLY}
    pins = [pin for part in board.components for pin in _typed(part)]
    fed |= {net for net, kind in pins if "power" in kind}
    fed -= {net for net, kind in pins if kind == "output"}
    names = (net.name for net in board.nets if net.name in fed)
    return [net for net in names if net == GROUND or sum(net in nets for nets in blocks) > 1]


def _typed(part: Component) -> list[tuple[str, str]]:
    """Net and type of each pin of a part."""
    names = pin_names(part)
    return [(net, pin_type(part, names.get(pad, ""))) for pad, net in part.nets]


def _first(contacts: Parts) -> Iterator[Drawing]:
    """The controller's sockets with the pads beside them, and the contacts of the tool."""
    pairs = _sockets(contacts)
    if pairs:
        yield "Controller", partial(draw_sockets, pairs=pairs)
    behind = [part for part in contacts if part.kind == "header" and part.side == "back"]
    if behind:
        yield "Contacts of the tool", partial(draw_strips, parts=behind)


def _sockets(contacts: Parts) -> list[tuple[Component, Component]]:
    """Sockets, each with the pads that have its nets."""
    return [
        (socket, pads)
        for socket in contacts
        for pads in contacts
        if (socket.kind, pads.kind) == ("socket", "wires") and socket.nets == pads.nets
    ]


def _circuit(group: Parts, parts: Parts) -> Iterator[Drawing]:
    """The drawing of a group; none of parts that are no circuit known here."""
    leader, kinds = group[0], [part.kind for part in group]
    if leader.kind == "fuse" and kinds.count("transistor") == 1:
        yield "Reverse supply and plug-in", partial(power_path.draw_plug_in, group=group)
    elif leader.kind == "esd diode":
        yield "Protection of the pins", partial(draw_protection, group=group)
    elif kinds == ["indicator", "resistor"]:
        yield "Power LED", partial(power_path.draw_indicator, group=group)
    elif kinds == ["schottky diode"]:
        yield "Feed of the controller", partial(power_path.draw_feed, group=group)
    elif leader.kind == "module":
        yield f"Controller: {leader.value}", partial(draw_module, group=group)
    elif "SW" in leader.pins and kinds.count("inductor") == 1:
        coil = group[kinds.index("inductor")]
        output = _volts(other_net(coil, net_of(leader, "SW")))
        source = _volts(_before_a_resistor(net_of(leader, "VIN"), parts))
        yield f"Buck regulator {source} to {output}", partial(power_path.draw_buck, group=group)
    elif "OUT" in leader.pins:
        source, output = (_volts(net_of(leader, pin)) for pin in ("IN", "OUT"))
        yield f"Linear regulator {source} to {output}", partial(power_path.draw_linear, group=group)


def _before_a_resistor(net: str, parts: Parts) -> str:
    """The net that feeds another through a resistor; the other itself where none does."""
    lit = nets_of(part for part in parts if part.kind == "indicator")
    resistors = (part for part in parts if part.kind == "resistor" and net in nets_of([part]))
    return next((other for part in resistors if (other := other_net(part, net)) not in lit), net)


def _volts(net: str) -> str:
    """The voltage in a net's name: `"3V3"` is 3.3 V."""
    return re.sub(r"^(\d+)V(\d+)$", r"\1.\2 V", re.sub(r"^([\d.]+)V$", r"\1 V", net))


def _leaving(contacts: Parts, supplies: Sequence[str]) -> Iterator[Drawing]:
    """Headers, and the wire pads of each cable: the first that carries a supply alone feeds the
    emitter, a further one the board itself."""
    headers = [part for part in contacts if part.kind == "header" and part.side == "front"]
    if headers:
        yield "Headers", partial(draw_strips, parts=headers)
    beside = [pads.ref for _, pads in _sockets(contacts)]
    feeding, used = ("To the emitter", "From the supply"), set[str]()
    for part in contacts:
        if part.kind == "wires" and part.ref not in beside:
            nets = nets_of([part])
            use = next((use for net, use in _CABLES.items() if net in nets), "Wires")
            if nets <= {*supplies}:
                use = next((use for use in feeding if use not in used), "Wires")
            used.add(use)
            yield use, partial(draw_strips, parts=[part])


def _probes(parts: Parts) -> Iterator[Drawing]:
    points = [part for part in parts if part.kind == "test point"]
    if points:
        yield "Test points", partial(draw_probes, parts=points)


def _not_made(parts: Parts, supplies: Sequence[str]) -> list[str]:
    """Supplies that no pin on the board makes: they come from outside or through passive parts."""
    pins = [pin for part in parts for pin in _typed(part)]
    needed = dict.fromkeys([*supplies, *(net for net, kind in pins if kind == "power_in")])
    made = {net for net, kind in pins if kind == "power_out"}
    return [net for net in needed if net not in made]


def _flags(nets: Sequence[str]) -> Callable[[Draft], None]:
    """A flag at each net, by which KiCad's rules know that it is fed."""

    def draw(draft: Draft) -> None:
        for i, net in enumerate(nets):
            upper = i * _FLAG_STEPS * power_path.STEP_MM, 0.0
            lower = upper[0], power_path.STEP_MM
            draft.wire(upper, lower)
            draft.power(net, lower if net == GROUND else upper)
            draft.fed(upper if net == GROUND else lower, 0 if net == GROUND else 180)

    return draw


_ROWS, _ROW_MM, _COLUMN_MM = 4, 7.62, 33.02
"""Test points below each other, and the distances between them."""


def draw_probes(draft: Draft, parts: Sequence[Component]) -> None:
    """Test points in columns, each at the end of its net."""
    for i, part in enumerate(parts):
        x, y = i // _ROWS * _COLUMN_MM, i % _ROWS * _ROW_MM
        draft.place(part, "TestPoint", drawn("TestPoint"), (x, y), ref_at=(3.048, -3.302))
        draft.wire((x, y), (x + REACH_MM, y))
        ((_, net),) = part.nets
        draft.end(net, (x + REACH_MM, y), 1)


def draw_alone(draft: Draft, parts: Sequence[Component]) -> None:
    """Parts with two terminals upright, others as a box with the names of their pins."""
    x = 0.0
    upright = [part for part in parts if part.kind in TWO_TERMINALS and len(part.nets) == 2]
    for part in upright:
        (_, upper), (_, lower) = part.nets
        if upper == GROUND:
            upper, lower = lower, upper
        reach = draft.stand(part, upper, (x, 0.0))
        for net, way in ((upper, -1), (lower, 1)):
            end = x, way * (REACH_MM + power_path.STEP_MM)
            draft.wire((x, way * REACH_MM), end)
            if draft.is_supply(net) and (net == GROUND) == (way > 0):
                draft.power(net, end)
            else:
                draft.tag(net, end, -90 * way % 360)
        x += reach + 2 * power_path.STEP_MM
    draw_strips(draft, [part for part in parts if part not in upright], x)
