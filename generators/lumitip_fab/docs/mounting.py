"""The manual's step of mounting: flange, controller's board and fingers, and how long the gripper's
bolts must be."""

from collections.abc import Iterator

from lumitip_fab.design import AuxiliaryBoard, Design, Flange
from lumitip_fab.design.cabling import INPUT_END, front_headers, gripper_headers, plugged_headers
from lumitip_fab.design.mount import BOLTS_MM, SHORTER_MM, standard_bolt_mm
from lumitip_fab.docs.wiring import listed
from lumitip_fab.text import passage

OWN_MM = (12, 16, 20, 25)
"""Lengths of a gripper's own bolts, as examples."""


def mounting(design: Design) -> str:
    """The step, its work numbered."""
    work = "\n".join(f"{n}. {text}" for n, text in enumerate(_work(design), 1))
    lengths = "".join(_lengths(flange) for flange in design.flanges)
    return _text(
        "mounted",
        work=work,
        lengths=lengths,
        needs=", ".join(_needs(design)),
        minutes=_minutes(design),
        glued=", and the glue's" if design.flanges else "",
        signs=_text("flange_sign") if design.flanges else "",
    )


def _needs(design: Design) -> Iterator[str]:
    """Tools, and what is used up."""
    yield "the keys and screwdrivers"
    if design.mount.lugs or design.holders:
        yield "cable ties"
    yield "side cutters"
    if design.flanges:
        yield f"a soldering iron, solder, a multimeter, {design.strength.glue}, nitrile gloves"
        yield "safety glasses"
    if design.electrical.indicators:
        yield "a bench supply"
    if _plugs(design):
        yield "a small vice"


def _minutes(design: Design) -> int:
    """How long the work takes (assumed)."""
    return 20 + 60 * len(design.flanges) + 15 * len(design.holders)


def _work(design: Design) -> Iterator[str]:
    """From the robot to the fingers."""
    mount = design.mount
    yield _text("switched_off")
    if design.flanges:
        yield _chosen(design)
    for header, cable in _plugs(design):
        own = gripper_headers(design.auxiliary_boards)
        shared = _text("shared", header=header) if header in own else ""
        yield _text("socketed", cable=cable, header=header, shared=shared)
    for flange in design.flanges:
        yield from _flanged(design, flange)
    for holder in design.holders:
        yield _text("in_holder", holder=holder, screws=len(holder.holes))
    if not design.holders and any(board.name == "breakout" for board in design.auxiliary_boards):
        yield _text("beside_gripper", mount=mount)
    if design.flanges:
        plugs = [_text("plugged", cable=cable, header=header) for header, cable in _plugs(design)]
        yield _text("connected", sockets="".join(plugs))
    yield _text("activated", rated_n=design.strength.rated_force_n, greatest=_greatest(design))
    if mount.lugs:
        yield _text("tied")
    yield _text("screwed_on", bolts=len(mount.bolt_u_mm), mount=mount)
    wires = [wire for cable in design.cabling.cables for wire in cable.wires]
    led_net = f"{design.wiring.supply_v:g}V"
    ends = [wire for wire in wires if wire.end.board == "supply"]
    own = [wire.number for wire in ends if wire.signal == "5V" and led_net != "5V"]
    if ends:
        listed_ends = ", ".join(f"{wire.number} to {wire.signal}" for wire in ends)
        free = "".join(_text("supplied_free", wire=number) for number in own)
        yield _text("supplied", ends=listed_ends, free=free)
    yield _text("moved", rated_n=design.strength.rated_force_n)


def _greatest(design: Design) -> str:
    """How strongly the gripper closes, against what a finger bears."""
    gripper_n = design.strength.gripper_n
    if not gripper_n:
        return _text("unknown")
    stronger = gripper_n > design.strength.rated_force_n
    return _text("stronger" if stronger else "weaker", gripper_n=gripper_n)


def _flanged(design: Design, flange: Flange) -> Iterator[str]:
    """The flange between robot and gripper."""
    yield _text("taken_off")
    yield _text("confirmed", volts=_volts(_raw(design)))
    yield _text("contacts", flange=flange)
    for lit in design.electrical.indicators:
        output = f"{lit.output_v:g}V"
        raw = _raw(design)
        yield _text("indicator", lit=lit, supply=_volts(raw), raw=raw, output=output)
    yield _text("closed", flange=flange, glue=design.strength.glue)
    yield _text("flange", flange=flange, bolts=len(flange.bolts))
    yield from _powered(design)


def _powered(design: Design) -> Iterator[str]:
    """Where the flange's supply is measured once the gripper hides its board."""
    for lit in design.electrical.indicators:
        output = f"{lit.output_v:g}V"
        for part in front_headers(_flange(design)):
            plus, minus = (
                [f"{part.ref}.{number}" for number, net in part.nets if net == wanted]
                for wanted in (output, "GND")
            )
            if plus and minus:
                volts = f"{lit.output_v:g} V"
                header = part.ref
                yield _text("powered", header=header, volts=volts, plus=plus[0], minus=minus[-1])
                return


def _chosen(design: Design) -> str:
    """The gripper's cable, and where its supply and lines are on the flange's board."""
    board = _flange(design)
    headers = front_headers(board)
    raw = _raw(design)
    pads = [f"{part.ref}.{number}" for part in headers for number, net in part.nets if net == raw]
    supply = _text("from_robot", pads=listed(pads), volts=_volts(raw)) if pads else ""
    own = [part.ref for part in headers if {net for _, net in part.nets} - {*board.supplies}]
    lines = _text("lines", lines=listed(own)) if own else ""
    return _text("chosen", supply=supply or _text("behind_fuse"), lines=lines)


def _raw(design: Design) -> str:
    """Net of the contacts' supply before the fuse, such as `"24V_IN"`."""
    return next(name for name in _probed(design) if name.endswith(INPUT_END))


def _volts(raw: str) -> str:
    """Voltage of the contacts' supply, such as `"24 V"`."""
    return raw.removesuffix(INPUT_END).replace("V", " V")


def _flange(design: Design) -> AuxiliaryBoard:
    """The flange's board."""
    return next(board for board in design.auxiliary_boards if board.name == "flange")


def _probed(design: Design) -> list[str]:
    """Nets of the test points on the flange's board."""
    return [part.value for part in _flange(design).components if part.kind == "test point"]


def _plugs(design: Design) -> list[tuple[str, str]]:
    """Headers of the flange that a cable is plugged into, and the name of that cable."""
    headers = plugged_headers(design.cabling.cables, design.auxiliary_boards)
    found = {
        (wire.end.connector, cable.name)
        for cable in design.cabling.cables
        for wire in cable.wires
        if wire.end.board == "flange"
    }
    return sorted(plug for plug in found if plug[0] in headers)


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


def _text(name: str, /, **values: object) -> str:
    """A passage of the manual with its values."""
    return passage("docs/chapters.md", name).format(**values)
