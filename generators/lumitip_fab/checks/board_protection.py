"""The protection of the controller's pins, followed along the copper from each wire to its pin."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass

from lumitip_fab.checks.board_read import ReadBoard, ohm
from lumitip_fab.checks.discharge import Clamp, pin_pulse_a
from lumitip_fab.checks.readers.kicad_board import Terminal
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design.protection import Protection

GROUND, CATHODE, ANODE = "GND", "1", "2"
_PICO = re.compile(r"(\d+(?:\.\d+)?)([pn])F")
_PF = {"p": 1.0, "n": 1e3}
_NOISE = 1e-6


@dataclass(frozen=True)
class _Wire:
    """A pad that a wire ends at."""

    net: str
    pad: Terminal
    group: int


def measure_protection(read: ReadBoard) -> Iterator[Measurement]:
    """A diode beside each wire, a resistor before each pin and a capacitor at analog ones; how far
    they are, what they add to a line, and the current that a discharge drives into a pin."""
    protection = read.design.electrical.protection
    if protection is None or protection.board != read.name:
        return
    wires, paths = list(_wires(read, protection)), list(_paths(read, protection))
    missing = [*_unclamped(read, protection, wires), *_unprotected(read, protection, paths)]
    yield read.count("protection", missing, "wires and pins")
    reach_mm = max((_reach_mm(read, wire) for wire in wires), default=math.inf)
    note = "from a wire's pad to its diode"
    yield read.figure("protection_reach", reach_mm, 0, protection.reach_mm, note=note)
    far_mm = max((_far_mm(read, path) for path in paths), default=math.inf)
    note = "from resistor and capacitor to the pin"
    yield read.figure("protection_pins", far_mm, 0, protection.pin_mm, note=note)
    yield read.count("protection_line", list(_heavy(read, protection, paths)), "analog lines")
    yield _pulse(read, protection, paths, reach_mm)


def line_of(read: ReadBoard, group: int | None) -> int | None:
    """The copper of a pin's wire: beyond its resistor, or the pin's own if none leads there."""
    protection = read.design.electrical.protection
    if group is None or protection is None or protection.board != read.name:
        return group
    wires = {wire.group for wire in _wires(read, protection)}
    beyond = [other for _, other in _resistors(read, group) if other in wires]
    return beyond[0] if len(beyond) == 1 else group


def _wires(read: ReadBoard, protection: Protection) -> Iterator[_Wire]:
    """Pads of the cables that need a diode, by the design's nets."""
    for device in (d for d in read.components if d.kind == "wires" and d.pins):
        part = read.parts.get(device.ref)
        pads = {t.number: t for t in part.terminals} if part else {}
        for number, net in device.nets:
            pad = pads.get(number)
            if net in protection.clamped and pad is not None and pad.copper is not None:
                yield _Wire(net, pad, read.clusters.of(pad.copper))


@dataclass(frozen=True)
class _Path:
    """A signal from its wire to its pin, as the board has it."""

    net: str
    analog: bool
    wire: int | None
    pin: Terminal | None
    group: int | None
    """Copper of the pin."""


def _paths(read: ReadBoard, protection: Protection) -> Iterator[_Path]:
    wiring = read.design.wiring
    pins = {f"S{i}": pin for i, pin in enumerate(wiring.select_pins)}
    pins |= {pin: pin for pin in wiring.adc_pins}
    on_wire = {wire.net: wire.group for wire in _wires(read, protection)}
    for net in protection.lines:
        pin = _pin(read, pins.get(net, wiring.emitter_pin))
        group = read.clusters.of(pin.copper) if pin is not None and pin.copper else None
        yield _Path(net, net in wiring.adc_pins, on_wire.get(net), pin, group)


def _pin(read: ReadBoard, name: str | None) -> Terminal | None:
    """The pad of a controller's pin."""
    for device in (d for d in read.components if d.kind in ("socket", "module")):
        part = read.parts.get(device.ref)
        for land, pin in zip(device.footprint.pads, device.pins, strict=True):
            if pin == name and part is not None:
                return next((t for t in part.terminals if t.number == land.number), None)
    return None


def _refs(read: ReadBoard, kind: str) -> list[str]:
    return [d.ref for d in read.components if d.kind == kind and d.ref in read.parts]


def _ground(read: ReadBoard) -> int | None:
    for device in (d for d in read.components if d.kind == "wires"):
        for number, net in device.nets:
            if net == GROUND:
                return read.group(device.ref, number)
    return None


def _diodes(read: ReadBoard, group: int) -> list[str]:
    """Diodes from some copper to ground, the cathode there."""
    ends = group, _ground(read)
    return [
        ref
        for ref in _refs(read, "esd diode")
        if (read.group(ref, CATHODE), read.group(ref, ANODE)) == ends
    ]


def _resistors(read: ReadBoard, group: int) -> list[tuple[str, int | None]]:
    """Resistors at some copper, with the copper at their other end."""
    found = []
    for ref in _refs(read, "resistor"):
        ends = [read.group(ref, number) for number in (1, 2)]
        if group in ends and ends[0] != ends[1]:
            found.append((ref, ends[1 - ends.index(group)]))
    return found


def _capacitors(read: ReadBoard, group: int | None) -> list[str]:
    ends = {group, _ground(read)}
    refs = _refs(read, "capacitor")
    return [ref for ref in refs if {read.group(ref, 1), read.group(ref, 2)} == ends]


def _unclamped(read: ReadBoard, protection: Protection, wires: list[_Wire]) -> Iterator[str]:
    there = {wire.net for wire in wires}
    yield from (f"{net} has no wire" for net in protection.clamped if net not in there)
    for wire in wires:
        if not _diodes(read, wire.group):
            yield f"wire {wire.net} has no diode to ground"


def _unprotected(read: ReadBoard, protection: Protection, paths: list[_Path]) -> Iterator[str]:
    for path in paths:
        if None in (path.wire, path.group) or _ground(read) in (path.wire, path.group):
            yield f"{path.net} has no pin, or is at ground"
            continue
        between = [r for r, other in _resistors(read, path.wire or 0) if other == path.group]
        if path.wire == path.group or len(between) != 1:
            yield f"{path.net} has no resistor of its own before its pin"
        due = int(path.analog and protection.capacitor_pf > 0)
        if len(_capacitors(read, path.group)) != due:
            yield f"{path.net} has {len(_capacitors(read, path.group))} capacitors, not {due}"


def _reach_mm(read: ReadBoard, wire: _Wire) -> float:
    """From a wire's pad to the cathode of its nearest diode."""
    return min(
        (
            math.dist(wire.pad.at, t.at)
            for ref in _diodes(read, wire.group)
            for t in read.parts[ref].terminals
            if t.number == CATHODE
        ),
        default=math.inf,
    )


def _far_mm(read: ReadBoard, path: _Path) -> float:
    """From a pin to the farther of its resistor and capacitor."""
    if path.pin is None or path.group is None:
        return math.inf
    refs = [ref for ref, _ in _resistors(read, path.group)] + _capacitors(read, path.group)
    apart = [
        math.dist(path.pin.at, t.at)
        for ref in refs
        for t in read.parts[ref].terminals
        if read.group(ref, t.number) == path.group
    ]
    return max(apart, default=math.inf)


def _heavy(read: ReadBoard, protection: Protection, paths: list[_Path]) -> Iterator[str]:
    """Analog lines with more capacitance than the firmware's wait is made for."""
    channel = read.design.electrical.channel
    others_pf = channel.line_pf - protection.diode_pf - protection.capacitor_pf
    for path in (path for path in paths if path.analog):
        added_pf = sum(_pico(read, ref) for ref in _capacitors(read, path.group))
        added_pf += protection.diode_pf * len(_diodes(read, path.wire or 0))
        if not others_pf + added_pf <= channel.line_pf + _NOISE:
            yield f"{path.net} has {others_pf + added_pf:g} pF, not {channel.line_pf:g}"


def _pulse(
    read: ReadBoard, protection: Protection, paths: list[_Path], reach_mm: float
) -> Measurement:
    """Largest current into a pin as a wire is discharged into."""
    clamp = Clamp(
        protection.breakdown_v, protection.dynamic_ohm, protection.nh_per_mm * min(reach_mm, 1e3)
    )
    supply_v, kv = read.design.electrical.channel.supply_v, protection.discharge_kv
    found = []
    for path in paths:
        values = [ohm(read.parts[ref].value) for ref, _ in _resistors(read, path.group or 0)]
        series = min(values, default=0.0) * (1 - protection.resistor_tolerance)
        pf = sum(_pico(read, ref) for ref in _capacitors(read, path.group))
        found.append(pin_pulse_a(clamp, series, pf, supply_v, kv) if series > 0 else math.inf)
    most = math.inf if protection.most_pin_a is None else 1000 * protection.most_pin_a
    worst = max(found, key=lambda a: math.inf if math.isnan(a) else a, default=math.nan)
    note = f"into a pin, at a contact discharge of {kv:g} kV into its wire"
    if protection.most_pin_a is None:
        note += "; the controller's entry has no limit"
    return read.figure("protection_pulse", 1000 * worst, 0, most, "mA", note)


def _pico(read: ReadBoard, ref: str) -> float:
    """Capacitance of a part by its value such as 22pF (pF); not a number of any other text."""
    match = _PICO.fullmatch(read.parts[ref].value)
    return float(match[1]) * _PF[match[2]] if match else math.nan
