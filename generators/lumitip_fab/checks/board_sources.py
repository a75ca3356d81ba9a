"""Current sources of the strings, read from the board: their wiring, current, load and headroom."""

import math
from collections.abc import Iterator, Sequence

from lumitip_fab.checks.board_read import ReadBoard, ohm
from lumitip_fab.checks.result import Measurement

ROOM_C = 25.0


def measure_sources(
    read: ReadBoard, starts: Sequence[int | None], lengths: Sequence[int]
) -> tuple[list[float], Iterator[Measurement]]:
    """Current of each string over its nominal one, and the measurements of their sources.

    Args:
        read: the emitter's board.
        starts: where the LEDs of each string begin.
        lengths: LEDs that the copper puts into each string.
    """
    numbers = range(1, len(starts) + 1)
    nominal = read.design.wiring.current_ma
    amps_ma = [_current_ma(read, n, at) for n, at in zip(numbers, starts, strict=True)]
    shares = [found / wanted for found, wanted in zip(amps_ma, nominal, strict=True)]
    return shares, _measured(read, starts, lengths, amps_ma)


def _measured(
    read: ReadBoard, starts: Sequence[int | None], lengths: Sequence[int], amps_ma: Sequence[float]
) -> Iterator[Measurement]:
    wrong = [text for n, at in enumerate(starts, start=1) for text in _misled(read, n, at)]
    yield read.count("sources", wrong, "leads")
    entry, held = read.design.packages.source, read.design.electrical.strings.regulation
    if held is None:
        return
    strings = read.design.electrical.strings
    coldest, hottest = strings.temperatures_c
    volts = float(read.supply.removesuffix("V"))
    loads, left = [], []
    for number, (lit, current_ma) in enumerate(zip(lengths, amps_ma, strict=True), start=1):
        set_v = entry.set_ua * 1e-6 * _value(read, number, "SET")
        warm_v = strings.forward_v - strings.forward_tolerance_v
        warm_v -= strings.forward_v_per_k * (hottest - ROOM_C)
        cold_v = strings.forward_v + strings.forward_tolerance_v
        cold_v += strings.forward_v_per_k * (ROOM_C - coldest)
        most_v = volts * (1 + held.supply_range) - lit * warm_v - set_v
        highest_ma = current_ma * (1 + held.spread + held.change)
        bears_w = (entry.junction_c - hottest) / entry.thermal_k_per_w
        loads.append(highest_ma / 1000 * most_v / bears_w)
        least_v = volts * (1 - held.supply_range) - lit * cold_v - set_v
        left.append(least_v - entry.dropout_v)
    worst = max(range(len(loads)), key=lambda i: (math.isnan(loads[i]), loads[i]))
    note = f"U{worst + 1}, highest supply and warm LEDs, of what it bears at {hottest:g} °C"
    yield read.figure("source_load", 100 * loads[worst], 0, 100 * held.most_load, "%", note)
    least = min(range(len(left)), key=lambda i: (not math.isnan(left[i]), left[i]))
    note = f"U{least + 1}, beyond what it needs, lowest supply and cold LEDs"
    yield read.figure("source_headroom", left[least], 0, volts, "V", note)


def source_lead(read: ReadBoard, number: int, name: str) -> int | None:
    """The group of a lead of a current source, by its name."""
    lead = read.design.packages.source.names.index(name) + 1
    return read.group(f"U{number}", lead)


def _current_ma(read: ReadBoard, number: int, start: int | None) -> float:
    """By the values of the two resistors: one carries the reference current to the LEDs, the
    other the rest, with the same voltage across both."""
    reference_ma = read.design.packages.source.set_ua / 1000
    at_set, at_out = (_value(read, number, name, start) for name in ("SET", "OUT"))
    return reference_ma + reference_ma * at_set / at_out


def _value(read: ReadBoard, number: int, name: str, start: int | None = None) -> float:
    """Resistance of the one resistor at a lead of a source; NaN of none, of several, or of one
    that does not lead to where the LEDs begin."""
    group = source_lead(read, number, name)
    found = []
    for ref, part in read.parts.items():
        ends = [read.group(ref, 1), read.group(ref, 2)] if ref.startswith("R") else []
        if group is not None and group in ends:
            beyond = ends[1 - ends.index(group)]
            found.append(ohm(part.value) if start in (None, beyond) else math.nan)
    return found[0] if len(found) == 1 else math.nan


def _misled(read: ReadBoard, number: int, start: int | None) -> Iterator[str]:
    """Leads of a source that are not where they must be."""
    supply = read.wire(read.supply)
    out, setting = (source_lead(read, number, name) for name in ("OUT", "SET"))
    taken = {supply, start, read.wire("GND")}
    for lead, name in enumerate(read.design.packages.source.names, start=1):
        group = read.group(f"U{number}", lead)
        where = f"U{number} lead {lead} ({name})"
        if name == "IN" and (group != supply or group is None):
            yield f"{where} is not at {read.supply}"
        if name == "OUT" and (group != out or group in taken or group == setting):
            yield f"{where} is not at its resistor alone"
        if name == "SET" and (group in taken or group is None):
            yield f"{where} is not at its resistor alone"
