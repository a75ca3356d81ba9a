"""Strings of LEDs, followed along the copper of the board: their LEDs, current and loads."""

import math
import re
from collections.abc import Iterator

import numpy as np
from scipy.optimize import brentq

from lumitip_fab.checks.board_read import ReadBoard, ohm
from lumitip_fab.checks.board_sources import measure_sources, source_lead
from lumitip_fab.checks.result import Measurement

SWITCH, GROUND = "Q1", "GND"


def sink(read: ReadBoard) -> int | None:
    """The group that the last cathode of each string is to be in: the transistor's drain, or ground
    where there is none."""
    return read.wire(GROUND) if _lead(read, "D") is None else _group(read, "D")


def measure_switch(read: ReadBoard) -> Iterator[Measurement]:
    """Source at ground, drain on a net of its own, gate at its wire and at one pull-down."""
    if read.strings and read.design.packages.switch is not None:
        yield read.count("switch", list(_faults(read)), "leads")


def _faults(read: ReadBoard) -> Iterator[str]:
    supply, gate, ground = read.supply, _group(read, "G"), read.wire(GROUND)
    driven = read.wire(read.signals[2]) if len(read.signals) > 2 else None
    if gate is None or gate != driven:
        yield "gate is not at its wire"
    if _group(read, "S") is None or _group(read, "S") != ground:
        yield "source is not at ground"
    if _group(read, "D") in (None, ground, driven, read.wire(supply)):
        yield "drain is at a wire"
    wanted = read.design.wiring.pull_down_ohm
    pulling = [
        ref
        for ref, part in read.parts.items()
        if ref.startswith("R")
        and {read.group(ref, 1), read.group(ref, 2)} == {gate, ground}
        and math.isclose(ohm(part.value), wanted, rel_tol=1e-6)
    ]
    if len(pulling) != 1:
        yield f"{len(pulling)} pull-downs of {wanted:g} ohm at the gate, not 1"


def _lead(read: ReadBoard, name: str) -> int | None:
    """Number of a lead by the catalogue; none without a switch."""
    part = read.design.packages.switch
    return None if part is None else part.names.index(name) + 1


def _group(read: ReadBoard, name: str) -> int | None:
    lead = _lead(read, name)
    return None if lead is None else read.group(SWITCH, lead)


CURRENT_SHARE = 0.02
THERMAL_V = 0.02585
SUPPLY_HIGH, RESISTOR_LOW = 1.05, 0.99
ROOM_C = 25.0
MOST_SHARE = 0.8
"""Largest share of the rating: thick-film chips are rated to 70 °C; at 87 °C 0.8 of it is left."""
RATED_W = {"1608": 0.1, "2012": 0.125, "3216": 0.25, "3225": 0.5, "5025": 0.75}
"""Rated power by size in tenths of a millimetre (Yageo RC_L series)."""
_SIZE = re.compile(r"RESC(\d{4})X")


def measure_loads(read: ReadBoard, chains: tuple[int, ...]) -> Iterator[Measurement]:
    """The largest load of a string resistor, as a share of its rating.

    Args:
        read: the emitter's board.
        chains: LEDs that the copper puts behind each resistor, R1 first.
    """
    volts = float(read.supply.removesuffix("V"))
    shares = [_share(read, f"R{i}", leds, volts) for i, leds in enumerate(chains, start=1)]
    worst = max(range(len(shares)), key=lambda i: (math.isnan(shares[i]), shares[i]))
    note = f"R{worst + 1}, over the tolerances of supply, LEDs and resistor, and temperature"
    yield read.figure("resistor_load", 100 * shares[worst], 0, 100 * MOST_SHARE, "%", note)


def _share(read: ReadBoard, ref: str, leds: int, volts: float) -> float:
    part = read.parts.get(ref)
    size = _SIZE.match(part.footprint) if part else None
    if part is None or size is None or size[1] not in RATED_W:
        return math.nan
    resistance = ohm(part.value) * RESISTOR_LOW
    amps = _highest_a(read, volts * SUPPLY_HIGH, leds, resistance)
    return amps**2 * resistance / RATED_W[size[1]]


def _highest_a(read: ReadBoard, volts: float, leds: int, resistance: float) -> float:
    """Current with every LED at its lowest forward voltage, in the heat."""
    strings = read.design.electrical.strings
    slope = strings.ideality * THERMAL_V
    warmer_v = strings.forward_v_per_k * (strings.temperatures_c[1] - ROOM_C)

    def missing_v(amps: float) -> float:
        each = strings.forward_v - strings.forward_tolerance_v - warmer_v
        each += slope * math.log(1000 * amps / strings.target_ma)
        return volts - leds * each - amps * resistance

    return float(brentq(missing_v, 1e-12, volts / resistance + 1e-9))


def measure_strings(read: ReadBoard) -> Iterator[Measurement]:
    """Each string from the supply through its resistor or current source and its LEDs to ground,
    and its current."""
    if not read.strings:
        return
    wiring = read.design.wiring
    anode = "1" if read.design.packages.led.marked == "anode" else "2"
    starts = [_start(read, number) for number in range(1, len(read.strings) + 1)]
    chains = [_chain(read, start, anode) for start in starts]
    wrong, turned = [], []
    for number, (cells, (chain, ends)) in enumerate(zip(read.strings, chains, strict=True), 1):
        lit = [ref.removeprefix("-") for ref in chain]
        turned += [ref.removeprefix("-") for ref in chain if ref.startswith("-")]
        if lit != [f"D{cell + 1}" for cell in cells] or not ends:
            wrong.append(
                f"R{number} feeds {len(chain)} LEDs, not the {len(cells)} of string {number}"
            )
    yield read.count("strings", wrong, "strings")
    yield read.count("polarity", turned, "LEDs")
    lengths = tuple(len(chain) for chain, _ in chains)
    if wiring.set_ohm:
        shares, measured = measure_sources(read, starts, lengths)
    else:
        shares, measured = _resistor_shares(read, lengths), measure_loads(read, lengths)
    off = np.array(shares) - 1
    worst = off[np.abs(np.nan_to_num(off, nan=math.inf)).argmax()]
    yield read.figure("current", 1 + worst, 1 - CURRENT_SHARE, 1 + CURRENT_SHARE, "of nominal")
    yield from measured


def _resistor_shares(read: ReadBoard, lengths: tuple[int, ...]) -> list[float]:
    """Current of each string over its nominal one, from its resistor's value and its LEDs."""
    wiring, shares = read.design.wiring, []
    for i, lit in enumerate(lengths):
        part = read.parts.get(f"R{i + 1}")
        resistance = ohm(part.value) if part else math.nan
        drop = wiring.supply_v - wiring.current_ma[i] * 1e-3 * wiring.resistor_ohm[i]
        amps_ma = 1e3 * (wiring.supply_v - drop / len(read.strings[i]) * lit) / resistance
        shares.append(amps_ma / wiring.current_ma[i])
    return shares


def _start(read: ReadBoard, number: int) -> int | None:
    """Where the LEDs of a string begin: the far end of its resistor."""
    ends = [read.group(f"R{number}", 1), read.group(f"R{number}", 2)]
    source = read.wire(read.supply)
    if read.design.wiring.set_ohm:
        source = source_lead(read, number, "OUT")
    return ends[1 - ends.index(source)] if source in ends and None not in ends else None


def _chain(read: ReadBoard, start: int | None, anode: str) -> tuple[list[str], bool]:
    """LEDs from a place on, with a minus where the current meets the cathode first; and whether
    the last is at ground, or at the transistor that switches them."""
    at, end = start, sink(read)
    if at is None or end is None:
        return [], False
    cathode = "1" if anode == "2" else "2"
    leds = {
        ref: (read.group(ref, anode), read.group(ref, cathode))
        for ref in read.parts
        if ref.startswith("D")
    }
    chain: list[str] = []
    while at != end:
        after = [ref for ref, pads in leds.items() if at in pads]
        if len(after) != 1:
            return chain, False
        into, out = leds.pop(after[0])
        chain.append(after[0] if into == at else f"-{after[0]}")
        at = out if into == at else into
    return chain, True
