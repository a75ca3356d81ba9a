"""The manual's steps of mounting: the controller's board on the gripper, and the fingers."""

from collections.abc import Iterator

from lumitip_fab.design import Design, Holder
from lumitip_fab.design.frames import gripper_to_tool, holder_edge_mm
from lumitip_fab.docs.bolts import finger_bolts
from lumitip_fab.docs.cable_ways import cable_ways
from lumitip_fab.docs.flange import plugs
from lumitip_fab.docs.steps import numbered
from lumitip_fab.text import listed, passage

FINGERS_MIN = 20
"""How long mounting the fingers takes (assumed)."""


def mounting_steps(design: Design) -> Iterator[str]:
    """The controller's board and the gripper, then the fingers."""
    yield _text(
        "gripper_step",
        mounted=_text("where_held" if design.system.holders else "not_held"),
        held=_text("held") * bool(design.holders),
        title="Mount the controller" if design.holders else "Try the gripper",
        work=numbered(_gripper_work(design)),
        needs=", ".join(["the keys and screwdrivers", *_gripper_needs(design)]),
        minutes=10 + 15 * len(design.holders),
        dead=_text("dead_behind" if design.flanges else "dead"),
        slipping=_text("slipping") * bool(design.holders),
    )
    yield _text(
        "mounted",
        work=numbered(_finger_work(design)),
        needs=", ".join(
            [
                "the keys",
                *_ties(has_cable_lugs(design)),
                *["the tape"] * bool(design.holders),
                *["calipers"] * bool(design.gauge_cards),
            ]
        ),
        minutes=FINGERS_MIN,
        ways=cable_ways(design),
        closed=_text("touch_first" if design.mount.tilt_deg else "parallel"),
    )


def _where(design: Design, holder: Holder) -> str:
    """How far up the gripper it is clipped on; empty if it is for another body than that whose
    length is known."""
    if holder.name not in design.system.holders:
        return ""
    face = "the flange" if design.flanges else "where the gripper stands"
    return _text("at_height", edge_mm=holder_edge_mm(holder, design.system), face=face)


def _gripper_needs(design: Design) -> list[str]:
    """Of the controller's board, and tape for fingers whose cables end at it."""
    if design.holders:
        return [*_ties(True), design.mould.tape]
    return ["waxed thread"] * any(board.name == "breakout" for board in design.auxiliary_boards)


def _ties(used: bool) -> list[str]:
    return ["cable ties", "side cutters"] * used


def has_cable_lugs(design: Design) -> bool:
    """Whether cables are tied to lugs."""
    return bool(design.mount.lugs) or any(holder.lugs for holder in design.holders)


def _gripper_work(design: Design) -> Iterator[str]:
    """The controller's board, the gripper's cable, and the gripper's first stroke."""
    mount = design.mount
    yield _text("still_off" if design.flanges else "switched_off")
    for holder in design.holders:
        yield _text(
            "in_holder",
            holder=holder,
            screws=len(holder.holes),
            robot=listed(_to_robot(design, holder)),
            fingers=_to_fingers(design),
            loop_mm=holder.tie_loop_mm,
            where=_where(design, holder),
        )
    if not design.holders and any(board.name == "breakout" for board in design.auxiliary_boards):
        yield _text("beside_gripper", mount=mount)
    if design.flanges:
        found = plugs(design)
        sockets = "".join(_text("plugged", cable=cable, header=header) for header, cable in found)
        feeds = bool(found) and design.feed is not None and not design.feed.diode
        yield _text("connected", sockets=sockets + _text("unplugged") * feeds)
    aside = _text("fixed_aside" if design.holders else "laid_aside")
    rated_n = design.strength.rated_force_n
    yield _text("activated", aside=aside, rated_n=rated_n, greatest=_greatest(design))


def _finger_work(design: Design) -> Iterator[str]:
    """Ties, bolts, supply, and the first stroke with the fingers on."""
    mount = design.mount
    if has_cable_lugs(design):
        yield _text("tied")
    yield from _supplied(design)
    if design.gauge_cards:
        yield _text("measured_fingers", thickness_mm=design.stack.thickness_mm)
    own = _text("own_supply") * bool(design.flanges)
    yield _text("force_first", own=own, rated_n=design.strength.rated_force_n)
    tight = finger_bolts(design)
    yield _text("screwed_on", bolts=len(mount.bolt_u_mm), mount=mount, tight=tight)
    frames = design.stack, mount, design.closing, design.system
    face = "the robot's flange" if design.flanges else "the gripper's own face"
    yield _text("tool", tool_mm=float(gripper_to_tool(*frames)[2, 3]), face=face)
    yield _text("moved")


def _supplied(design: Design) -> Iterator[str]:
    """The wires that are joined to a supply."""
    wires = [wire for cable in design.cabling.cables for wire in cable.wires]
    led_net = f"{design.wiring.supply_v:g}V"
    ends = [wire for wire in wires if wire.end.board == "supply"]
    own = [wire.number for wire in ends if wire.signal == "5V" and led_net != "5V"]
    if ends:
        listed_ends = ", ".join(f"{wire.number} to {wire.signal}" for wire in ends)
        feed = design.feed
        name = "supplied_free" if feed and feed.diode else "supplied_joined"
        free = "".join(_text(name, wire=number) for number in own)
        yield _text("supplied", ends=listed_ends, free=free)


def _to_robot(design: Design, holder: Holder) -> list[str]:
    """Connectors of a holder's board from which a cable leads to no finger."""
    fingers = {finger.name for finger in design.fingers}
    ends = {
        near.connector
        for cable in design.cabling.cables
        for near, far in ((cable.start, cable.end), (cable.end, cable.start))
        if near.board == holder.auxiliary and far.board not in fingers
    }
    return sorted(ends)


def _to_fingers(design: Design) -> str:
    """What lies at the board's other edge, and the cable that goes past the board."""
    if not design.cabling.beyond_mm:
        return ""
    emitter = design.cabling.cables[0]
    receiver = next(c for c in design.cabling.cables if c.start.board == "receiver")
    ends = (cable.end.connector for cable in (receiver, emitter))
    return _text("fingers_edge", near=next(ends), far=next(ends), cable=emitter.name)


def _greatest(design: Design) -> str:
    """How strongly the gripper closes, against what a finger bears."""
    gripper_n = design.strength.gripper_n
    if not gripper_n:
        return _text("unknown")
    stronger = gripper_n > design.strength.rated_force_n
    return _text("stronger" if stronger else "weaker", gripper_n=gripper_n)


def _text(name: str, /, **values: object) -> str:
    """A passage of the manual with its values."""
    return passage("docs/chapters.md", name).format(**values)
