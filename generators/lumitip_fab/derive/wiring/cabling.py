"""Cables: ends, colours, lengths and sections of the wires."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import permutations

from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.connectors import SWITCH
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring.loops import BEND_RATIO, Way, loop_of, with_room
from lumitip_fab.derive.wiring.section import MOST_A_PER_MM2, MOST_DROP, section_mm2
from lumitip_fab.design import AuxiliaryBoard, Component, Electrical, Finger, Mount, Outline, Wiring
from lumitip_fab.design.cabling import STRANDED, Cable, Cabling, Terminal, Wire

DRILL_ROOM_MM = 0.1
STEP_MM = 10.0  # lengths are multiples of it
_FIXED = {"GND": "BK", "3V3": "OG", "5V": "PK"}
_SUPPLY = "RD"  # of the LEDs, whatever its voltage
_PLAIN = ("BN", "YE", "GN", "BU", "VT", "GY", "WH", "TQ")
_STRIPED = tuple("".join(pair) for pair in permutations(_PLAIN, 2))


@dataclass(frozen=True)
class Boards:
    """The boards that the cables connect."""

    emitter: Finger
    receiver: Finger
    auxiliary_boards: tuple[AuxiliaryBoard, ...]


@dataclass(frozen=True)
class Loads:
    """Largest current of each net that carries one, by cable."""

    lit: dict[str, float]
    read: dict[str, float]
    all: dict[str, float]


def derive_cabling(
    config: Input,
    boards: Boards,
    outline: Outline,
    mount: Mount,
    wiring: Wiring,
    electrical: Electrical,
    faults: Diagnostics,
) -> Cabling:
    """All cables, from the signals of the connectors that they join."""
    p, travel_mm = config.parameters.wiring, mount.stroke_mm / 2
    fixed = _FIXED | {boards.emitter.connector.supply: _SUPPLY}
    loads = _loads(config, boards.emitter, wiring, electrical)
    ends = _ends(config, boards, wiring)
    breakout, host = _named(boards.auxiliary_boards, "breakout"), _host(boards.auxiliary_boards)
    beyond_mm = _apart_mm(breakout, "J6", "J5") if breakout else 0.0
    to_supply_mm = p.controller_mm + beyond_mm if host else p.supply_mm
    fed, switched = _parted(_pads(boards.emitter), ends["emitter"])
    parts = [
        (boards.emitter, fed, loads.lit, to_supply_mm),
        (boards.receiver, _pads(boards.receiver), loads.read, p.controller_mm),
    ]
    if switched:
        parts.append((boards.emitter, switched, {}, p.controller_mm))
    ways = [Way(reach_mm(finger, outline), travel_mm, run_mm) for finger, _, _, run_mm in parts]
    cables = [
        _cable(
            f"W{i}",
            pads,
            ends[finger.name],
            load,
            fixed,
            p.section_mm2,
            way.length_mm + p.slack_mm,
        )
        for i, ((finger, pads, load, _), way) in enumerate(zip(parts, ways, strict=True), 1)
    ]
    if breakout:
        fed = _wires_of(breakout, "J7")
        supply = _feeding(boards.auxiliary_boards, fed)
        cables.append(
            _cable(
                "W3",
                fed,
                supply,
                loads.all,
                fixed,
                p.section_mm2,
                p.supply_mm + p.slack_mm,
            )
        )
    for _ in range(2):  # a longer cable may have to be thicker, and a thicker one longer
        cables = [_thick_enough(config, cable, cables) for cable in cables]
        moving = [with_room(c, way, STEP_MM) for c, way in zip(cables, ways, strict=False)]
        cables = [*moving, *cables[len(ways) :]]
    for cable in cables:
        _refuse_thick(config, cable, boards, faults)
    return Cabling(
        cables=tuple(cables),
        loops=tuple(loop_of(cable, way) for cable, way in zip(cables, ways, strict=False)),
        travel_mm=travel_mm,
        supply_mm=p.supply_mm,
        controller_mm=p.controller_mm,
        beyond_mm=beyond_mm,
        slack_mm=p.slack_mm,
        step_mm=STEP_MM,
        most_a_per_mm2=MOST_A_PER_MM2,
        bend_ratio=BEND_RATIO,
        most_drop=MOST_DROP,
    )


def reach_mm(finger: Finger, outline: Outline) -> float:
    """From the farthest pad of a connector to the middle of the finger's gripper end."""
    return max(abs(x) + y - outline.end_y_mm for x, y in finger.connector.pads)


def _apart_mm(board: AuxiliaryBoard, *refs: str) -> float:
    """Distance of the wire pads of two connectors along a board."""
    first, other = (d.y_mm for ref in refs for d in board.components if d.ref == ref)
    return abs(first - other)


def _loads(config: Input, emitter: Finger, wiring: Wiring, electrical: Electrical) -> Loads:
    lit_ma = sum(electrical.strings.high_ma)
    read_ma = 1000 * wiring.pull_ups * electrical.channel.supply_v / wiring.pull_up_ohm
    own_ma = config.parts.controller.board.draws_ma + read_ma
    supply = emitter.connector.supply
    together = {supply: lit_ma, "5V": own_ma, "GND": lit_ma + own_ma}
    if supply == "5V":
        together["5V"] = lit_ma + own_ma
    return Loads({supply: lit_ma, "GND": lit_ma}, {"3V3": read_ma, "GND": read_ma}, together)


def _ends(config: Input, boards: Boards, wiring: Wiring) -> dict[str, dict[str, Terminal]]:
    """Far end of each signal of each finger, by name."""
    host = _host(boards.auxiliary_boards)
    if host:
        auxiliary, *refs = host
        return {
            finger: {t.name: t for t in _wires_of(auxiliary, ref)}
            for finger, ref in zip(("emitter", "receiver"), refs, strict=True)
        }
    selects = {f"S{i}": pin for i, pin in enumerate(wiring.select_pins)}
    plug = config.parts.controller.board.plug
    order = (*plug.rows[0], *plug.rows[1]) if plug else ()
    controller = {}
    for place, signal in enumerate(boards.receiver.connector.signals, 1):
        pin = selects.get(signal, signal)
        at = order.index(pin) + 1 if pin in order else place
        controller[signal] = Terminal("controller", "", pin, pin, at)
    supply = {
        signal: Terminal("supply", "", signal, signal, place)
        for place, signal in enumerate(boards.emitter.connector.signals, 1)
    }
    if wiring.emitter_pin is not None:
        pin = wiring.emitter_pin
        at = order.index(pin) + 1 if pin in order else len(controller) + 1
        supply[SWITCH] = Terminal("controller", "", pin, pin, at)
    return {"emitter": supply, "receiver": controller}


def _parted(
    pads: tuple[Terminal, ...], ends: dict[str, Terminal]
) -> tuple[tuple[Terminal, ...], tuple[Terminal, ...]]:
    """The emitter's pads, apart from one whose wire goes to another place than the first."""
    here = tuple(pad for pad in pads if ends[pad.name].board == ends[pads[0].name].board)
    return here, tuple(pad for pad in pads if pad not in here)


def _host(auxiliary_boards: Iterable[AuxiliaryBoard]) -> tuple[AuxiliaryBoard, str, str] | None:
    """The board where the fingers' cables end, with its wire pads for emitter and receiver: the
    breakout, or the flange's board if the controller is on it."""
    breakout, flange = _named(auxiliary_boards, "breakout"), _named(auxiliary_boards, "flange")
    if breakout:
        return breakout, "J6", "J5"
    if flange and any(device.kind == "module" for device in flange.components):
        return flange, "J5", "J4"
    return None


def _pads(finger: Finger) -> tuple[Terminal, ...]:
    signals = enumerate(finger.connector.signals, 1)
    return tuple(Terminal(finger.name, "J1", str(pad), name, pad) for pad, name in signals)


def _wires_of(auxiliary: AuxiliaryBoard, ref: str) -> tuple[Terminal, ...]:
    """The wire pads of a connector of an auxiliary board, in their order, with the names beside
    them: that of a supply is the same before and behind the board's fuse."""
    device: Component = next(d for d in auxiliary.components if d.ref == ref)
    pads = enumerate(zip(device.nets, device.pins, strict=True), 1)
    return tuple(Terminal(auxiliary.name, ref, pad, name, at) for at, ((pad, _), name) in pads)


def _feeding(
    auxiliary_boards: Iterable[AuxiliaryBoard], pads: tuple[Terminal, ...]
) -> dict[str, Terminal]:
    """Source of each pad of the breakout: contacts of the flange's header that has most of its
    nets, or a supply."""
    supply = {pad.name: Terminal("supply", "", pad.name, pad.name, pad.order) for pad in pads}
    flange = _named(auxiliary_boards, "flange")
    headers = [d for d in flange.components if d.ref in ("J2", "J3")] if flange else []
    if not headers:
        return supply
    header = max(headers, key=lambda d: len(supply.keys() & {net for _, net in d.nets}))
    first = {net: contact for contact, net in reversed(header.nets)}
    return supply | {
        net: Terminal("flange", header.ref, contact, net, int(contact))
        for net, contact in first.items()
        if net in supply
    }


def _named(auxiliary_boards: Iterable[AuxiliaryBoard], name: str) -> AuxiliaryBoard | None:
    return next((auxiliary for auxiliary in auxiliary_boards if auxiliary.name == name), None)


def _cable(
    name: str,
    starts: tuple[Terminal, ...],
    ends: dict[str, Terminal],
    load_ma: dict[str, float],
    fixed: dict[str, str],
    section_mm2: float,
    least_mm: float,
) -> Cable:
    """A wire for each pad, to where its signal goes."""
    free = [s.name for s in starts if s.name not in fixed]
    palette = (*_PLAIN, *_STRIPED)
    colours = fixed | {signal: palette[i % len(palette)] for i, signal in enumerate(free)}
    wires = tuple(
        Wire(
            f"{name}.{place}",
            start.name,
            start,
            ends[start.name],
            colours[start.name],
            load_ma.get(start.name, 0.0),
        )
        for place, start in enumerate(starts, 1)
    )
    length_mm = STEP_MM * math.ceil(round(least_mm / STEP_MM, 6))
    return Cable(name, least_mm, length_mm, 0.0, section_mm2, wires)


def _thick_enough(config: Input, cable: Cable, cables: list[Cable]) -> Cable:
    """The cable with the configured section or, where that is too thin, the smallest sold one that
    carries its current to the supply."""
    feeding = [c for c in cables if c.start.board != "receiver" and any(_currents_ma(c))]
    way_mm = sum(c.length_mm for c in feeding)
    return replace(cable, section_mm2=section_mm2(config, max(_currents_ma(cable)), way_mm))


def _currents_ma(cable: Cable) -> tuple[float, ...]:
    return tuple(wire.current_ma for wire in cable.wires)


def _refuse_thick(config: Input, cable: Cable, boards: Boards, faults: Diagnostics) -> None:
    """Refuse wires that do not go into the holes at their ends."""
    asked, section = config.parameters.wiring.section_mm2, cable.section_mm2
    drill_mm = min(_drill_mm(end, boards) for end in (cable.start, cable.end))
    most = math.pi / 4 * ((drill_mm - DRILL_ROOM_MM) / STRANDED) ** 2
    amps_ma = max(_currents_ma(cable))
    need = f"{section:g} mm² is needed for {amps_ma:.0f} mA, but " if section > asked else ""
    faults.refuse_unless(
        section <= most,
        "wiring.section_mm2",
        f"is {asked:g}; {need}the holes of {drill_mm:g} mm at the ends of {cable.name} "
        f"({cable.start.board} to {cable.end.board}) take strands of at most "
        f"{math.floor(1000 * most) / 1000:g} mm²"
        + (". Reduce emitter.current_ma." if need else ""),
    )


def _drill_mm(end: Terminal, boards: Boards) -> float:
    """Hole of a wire pad; no limit where there is none."""
    for finger in (boards.emitter, boards.receiver):
        if end.board == finger.name:
            return finger.connector.drill_mm
    auxiliary = _named(boards.auxiliary_boards, end.board)
    devices = auxiliary.components if auxiliary else ()
    lands = [land for d in _bare(devices, end) for land in d.footprint.pads]
    return min((land.drill_mm for land in lands), default=math.inf)


def _bare(devices: Iterable[Component], end: Terminal) -> list[Component]:
    """Wire pads at an end; a header takes a socket, not a wire."""
    return [d for d in devices if d.ref == end.connector and d.kind == "wires"]
