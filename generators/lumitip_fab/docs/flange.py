"""The manual's steps of the flange: the coupling and its bolts, the board with the gripper's cable,
the printed parts."""

import re
from collections.abc import Iterator

from lumitip_fab.design import AuxiliaryBoard, Design, Flange
from lumitip_fab.design.cabling import INPUT_END, front_headers, plugged_headers
from lumitip_fab.design.electrical import Indicator
from lumitip_fab.design.mount import BOLTS_MM, SHORTER_MM, standard_bolt_mm
from lumitip_fab.docs.bolts import flange_bolts
from lumitip_fab.docs.gripper_cable import (
    cable_from_headers,
    in_volts,
    own_cable,
    probed,
    raw_supply,
)
from lumitip_fab.docs.protection import TVS, boards_of_later, protection_note
from lumitip_fab.docs.steps import numbered
from lumitip_fab.docs.wiring import pressed
from lumitip_fab.text import as_written, listed, passage

_SUPPLY = re.compile(r"[\d.]+V")
OWN_MM = (12, 16, 20, 25)
"""Lengths of a gripper's own bolts, as examples."""
BOARD_MIN, FLANGE_MIN = 30, 20
"""How long the work on the board takes, and building it in (assumed)."""


def coupling_step(design: Design, flange: Flange) -> str:
    """The look at the coupling, before boards and bolts are ordered."""
    return _text("coupling_step", work=numbered(_looked(design)), lengths=_lengths(flange))


def flange_board_step(design: Design, flange: Flange, pictures: str) -> str:
    """The test of the flange's board.

    Args:
        design: with the flange.
        flange: whose board it is.
        pictures: of the board, in Markdown.
    """
    return _text(
        "flange_board_step",
        pictures=pictures,
        needs=", ".join(_needs(design)),
        minutes=BOARD_MIN,
        work=numbered(_boarded(design, flange)),
        protection="".join(protection_note(later, design) for later in boards_of_later(design)),
        contacts=_contacts(design),
    )


def flange_step(design: Design, flange: Flange) -> str:
    """The flange built in, up to the supply that is measured."""
    return _text(
        "flange_step",
        flange=flange,
        glue=design.strength.glue,
        minutes=FLANGE_MIN,
        work=numbered(_built_in(design, flange)),
    )


def _looked(design: Design) -> Iterator[str]:
    """The gripper off, its bolts and the coupling's contacts measured."""
    yield _text("switched_off")
    yield _text("taken_off")
    yield _text("confirmed", volts=in_volts(raw_supply(design)))
    fed = _text("fed_from_there") * own_cable(design).feeds
    for carried in _other_supplies(design):
        yield _text("other_supply", carried=carried, volts=in_volts(raw_supply(design)), fed=fed)


def _other_supplies(design: Design) -> Iterator[str]:
    """What the coupling's supply contacts carry, where it is not the voltage of this design."""
    contacts = [contact for flange in design.flanges for contact in flange.contacts]
    carried = dict.fromkeys(in_volts(c.carries) for c in contacts if c.kind == "supply")
    yield from (volts for volts in carried if volts != in_volts(raw_supply(design)))


def _needs(design: Design) -> Iterator[str]:
    """Tools for the board, and what is used up."""
    yield "a soldering iron, solder, side cutters, safety glasses, a multimeter, a bench supply"
    if front_headers(_flange(design)):
        yield "a small vice"


def _boarded(design: Design, flange: Flange) -> Iterator[str]:
    """Sockets on wires, spring contacts, and the board alone on a bench supply."""
    own = own_cable(design)
    for header, cable in plugs(design):
        joint = header in own.headers and not own.by_maker
        shared = _text("shared", header=header) if joint else ""
        how = pressed(design.cabling)
        yield _text("socketed", cable=cable, header=header, shared=shared, pressed=how)
    yield _text("contacts", flange=flange)
    yield _tried(design)


def _built_in(design: Design, flange: Flange) -> Iterator[str]:
    """From the board in its printed part to the supply that is measured."""
    yield _text("gripper_off")
    hard_h = design.mould.glue_hard_h
    wait = f"for {hard_h:g} h" if hard_h else "for as long as its label says"
    out_mm = flange.pin_length_mm - flange.pin_depth_mm
    yield _text("closed", flange=flange, glue=design.strength.glue, wait=wait, out_mm=out_mm)
    tight = flange_bolts(design, flange)
    yield _text("bolted", flange=flange, bolts=len(flange.bolts), tight=tight)
    yield from _powered(design)


def _tried(design: Design) -> str:
    """The flange's board alone, on a bench supply."""
    raw, board = raw_supply(design), _flange(design)
    points = [f"{in_volts(net)} at the test point {net}" for net in _outputs(design)]
    signs = "".join(_text("lit", lit=lit) for lit in _lights(design))
    if board not in boards_of_later(design):
        diodes = [part for part in board.components if part.kind == TVS]
        signs += "".join(_text("cold", part=part) for part in diodes)
    return _text("indicator", supply=in_volts(raw), raw=raw, outputs=listed(points), signs=signs)


def _powered(design: Design) -> Iterator[str]:
    """Where the supply of the controller is measured once the gripper hides the flange's board."""
    for part in front_headers(_flange(design)):
        carried = {net for _, net in part.nets}
        found = [net for net in _outputs(design) if net in carried]
        if found and "GND" in carried:
            plus, minus = (
                [f"{part.ref}.{number}" for number, net in part.nets if net == wanted]
                for wanted in (found[-1], "GND")
            )
            volts = in_volts(found[-1])
            yield _text("powered", header=part.ref, volts=volts, plus=plus[0], minus=minus[-1])
            return


def _outputs(design: Design) -> list[str]:
    """Nets of test points behind the fuse that carry a supply, such as `"5V"`, the lowest last."""
    supplies = _flange(design).supplies
    found = [net for net in probed(design) if net in supplies and _SUPPLY.fullmatch(net)]
    return sorted(found, key=lambda net: -float(net.removesuffix("V")))


def _lights(design: Design) -> list[Indicator]:
    """The power LED of the flange's board; none without it."""
    return [lit for lit in design.electrical.indicators if lit.board == "flange"]


def _contacts(design: Design) -> str:
    """The table of the headers' contacts, of the signal that each carries, and of its wire."""
    return _text(
        "sockets",
        counted="" if plugs(design) else _text("counted"),
        wired=_text("other_contacts") if plugs(design) else "",
        rows="\n".join(_contact_rows(design)),
        own=cable_from_headers(design),
    )


def _contact_rows(design: Design) -> Iterator[str]:
    board, own = _flange(design), own_cable(design)
    wires = [wire for cable in design.cabling.cables for wire in cable.wires]
    ends = {(w.end.connector, w.end.pin): w.number for w in wires if w.end.board == board.name}
    for part in front_headers(board):
        nets = dict.fromkeys(net for _, net in part.nets)
        for net in nets:
            pins = [pin for pin, carried in part.nets if carried == net]
            found = [f"{ends[part.ref, p]} at {p}" for p in pins if (part.ref, p) in ends]
            of_robot = net.endswith(INPUT_END) or net not in board.supplies
            if (of_robot or (net == "GND" and part.ref in own.headers)) and not own.by_maker:
                found.append("the gripper's")
            shown = ", ".join(found) or "none"
            yield f"| {part.ref} | {', '.join(pins)} | {as_written(net)} | {shown} |"


def _flange(design: Design) -> AuxiliaryBoard:
    """The flange's board."""
    return next(board for board in design.auxiliary_boards if board.name == "flange")


def _lengths(flange: Flange) -> str:
    """The rule for the flange bolts, with examples."""
    rows = []
    for own_mm in OWN_MM:
        least_mm = own_mm + flange.top_z_mm
        if least_mm <= BOLTS_MM[-1]:
            length_mm = standard_bolt_mm(least_mm)
            rows.append(
                f"| {own_mm} mm | {least_mm:.1f} mm | {flange.bolt} x {length_mm} "
                f"| {length_mm - least_mm:+.1f} mm |"
            )
    return _text("lengths", flange=flange, less_mm=SHORTER_MM, rows="\n".join(rows))


def plugs(design: Design) -> list[tuple[str, str]]:
    """Headers of the flange that a cable is plugged into, and the name of that cable."""
    headers = plugged_headers(design.cabling.cables, design.auxiliary_boards)
    found = {
        (wire.end.connector, cable.name)
        for cable in design.cabling.cables
        for wire in cable.wires
        if wire.end.board == "flange"
    }
    return sorted(plug for plug in found if plug[0] in headers)


def _text(name: str, /, **values: object) -> str:
    """A passage of the manual with its values."""
    return passage("docs/chapters.md", name).format(**values)
