"""How fast a channel settles, and how much of its range a bare cell uses."""

import math
from typing import NamedTuple

from lumitip_fab.config.automatic import automatic_fields
from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring.ambient import scan_us
from lumitip_fab.derive.wiring.protection import protecting_board
from lumitip_fab.derive.wiring.section import REACH_MM

SCANS_PER_S = 200
MOST_SCAN_US = 1e6 / SCANS_PER_S
COUNTS, SETTLED_COUNTS = 255, 0.5
WAIT_SHARE = 0.88
"""Of the bound in `wait_us`: the slowest reading, of a phototransistor just before it saturates,
needs 0.85 of it over the spread of gain and capacitance."""
WIRE_PF_PER_M = 100.0
"""Of a wire between grounded ones: 96 pF/m in 3M's cable 3560 (TS-0672-B, PVC, AWG 26)."""
LEAST_WIRE_MM = 300.0  # that a channel is made for: users cut their wires longer
MOST_SHARED_OHM = 150e3  # a channel settles that much slower


class Line(NamedTuple):
    """What a pull-up has to charge beside its photodetector (pF)."""

    wire_pf: float
    """Of the longest wire of a finger to the controller."""
    total_pf: float
    """Common terminal of the multiplexer, wire, input of the controller and its protection."""
    series_us: float
    """Wait for a pin behind its resistor."""
    late_us: float
    """Time constant that the resistor adds: the pin's share of all capacitance is charged late."""


def line_of(config: Input, capacitor: bool = True) -> Line:
    """The line of a multiplexer.

    Args:
        config: the input.
        capacitor: with the capacitor at the analog pin, where the file has one.
    """
    p, parts = config.parameters, config.parts
    mux, controller, guard = parts.receiver.multiplexer, parts.controller.board, parts.protection
    wire_pf = WIRE_PF_PER_M * _wire_mm(config) / 1000
    total_pf = mux.common_pf + wire_pf + controller.input_pf
    if guard.diode is None or protecting_board(config) is None:
        return Line(wire_pf, total_pf, 0.0, 0.0)
    extra_pf = 1000 * guard.capacitor.capacitance_nf if capacitor and guard.capacitor else 0.0
    total_pf += guard.diode.capacitance_pf + extra_pf
    pin_pf = controller.input_pf + extra_pf
    series_us = p.protection.series_ohm * pin_pf * 1e-6
    late_us = series_us * pin_pf / (total_pf + parts.receiver.photodetector.capacitance_pf)
    return Line(wire_pf, total_pf, series_us * math.log(COUNTS / SETTLED_COUNTS), late_us)


def wait_us(config: Input, line: Line) -> float | None:
    """Wait for a phototransistor whose collector is always pulled up; none where it floats.

    The line brings the charge of the channel before it, which is at most C * supply. The base of a
    detector of gain B and capacitance C_b takes it up as a capacitor of B C_b would, and gives it
    back through the pull-up: the error is at most C / (C + B C_b) * exp(-t / (R (C + B C_b))) of
    the supply. The worst B C_b has the time constant t, and with it the error is R C / (e t).
    """
    receiver = config.parameters.receiver
    if receiver.load != "each":
        return None
    return receiver.pull_up_ohm * _us_per_ohm(line) + line.series_us


def most_pull_up_ohm(config: Input) -> float:
    """The greatest pull-up with which there are `SCANS_PER_S` (ohm); of so many cells that their
    conversions take more than half of that time, with which the waits take the other half."""
    if config.parameters.receiver.load != "each":
        return MOST_SHARED_OHM
    found = line_of(config, capacitor=False)
    inputs = 2 ** len(config.parts.receiver.multiplexer.select)
    waits_us = max(MOST_SCAN_US - scan_us(config, 0.0), MOST_SCAN_US / 2)
    most_ohm: float = (waits_us / inputs - found.series_us) / _us_per_ohm(found)
    return most_ohm


def light_share(config: Input, current_ma: float, pull_up_ohm: float) -> float:
    """Light of a bare cell, as a share of what saturates its pull-up; above 1 it is cut off.

    The catalogue's `light_current_ua` is for the published current.
    """
    detector = config.parts.receiver.photodetector
    supply_v = config.parts.controller.board.supply_v
    saturated_ua = 1e6 * (supply_v - detector.saturation_v) / pull_up_ohm
    published_ma = float(automatic_fields()["emitter.current_ma"].start)
    return current_ma / published_ma * detector.light_current_ua / saturated_ua


def refuse_slow(config: Input, wait_us: float | None, faults: Diagnostics) -> None:
    """Refuse a capacitor at the analog pins with which a scan takes too long."""
    guarded = protecting_board(config) is not None and config.parts.protection.capacitor
    if wait_us is None or not guarded:
        return
    takes_us = scan_us(config, wait_us)
    faults.unless(
        takes_us <= MOST_SCAN_US,
        "scan_slow",
        takes_ms=takes_us / 1000,
        most_ms=MOST_SCAN_US / 1000,
        rate=SCANS_PER_S,
    )


def _us_per_ohm(line: Line) -> float:
    return WAIT_SHARE * COUNTS / SETTLED_COUNTS * line.total_pf * 1e-6 / math.e


def _wire_mm(config: Input) -> float:
    """Length of a signal's wire, or more: the boards that it ends on are not known yet."""
    p = config.parameters.wiring
    travel_mm = config.parts.coupling.gripper.stroke_mm / 2
    return max(LEAST_WIRE_MM, p.controller_mm + p.slack_mm + travel_mm + REACH_MM)
