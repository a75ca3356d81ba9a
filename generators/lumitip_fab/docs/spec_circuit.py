"""Electrical figures of a design beside the published ones."""

import math
from collections.abc import Iterator

from lumitip_fab.design import Design, Wiring
from lumitip_fab.design.electrical import CUT_OFF_SHARE, AmbientScan, PlugIn, Regulation
from lumitip_fab.docs.row import Row, rows_of

CONVERSION_US = 30
"""As in `settings.h` of the firmware: one conversion."""


def electrical_rows(design: Design) -> Iterator[Row]:
    """Rows of Table I, from the resolution to the warm-up."""
    wiring, optics = design.wiring, design.layout.optics
    return rows_of(
        "electrical",
        controller=design.controller,
        wiring=wiring,
        optics=optics,
        rate=_rate(design),
        current_ma=sum(wiring.current_ma),
        strings=len(wiring.strings),
        set_by=_set_by(design),
        pull_up_ma=1000 * wiring.pull_ups * optics.supply_v / optics.pull_up_ohm,
    )


def string_rows(design: Design) -> Iterator[Row]:
    """Current and load of the strings, with resistors or with current sources."""
    strings, wiring = design.electrical.strings, design.wiring
    longest = max(len(string) for string in wiring.strings)
    coldest, hottest = strings.temperatures_c
    currents = {
        "coldest": coldest,
        "hottest": hottest,
        "nominal": _span(wiring.current_ma),
        "low": min(strings.low_ma),
        "high": max(strings.high_ma),
        "longest": longest,
    }
    if strings.regulation:
        return rows_of("sources", **currents, **_of_sources(strings.regulation))
    return rows_of(
        "strings",
        **currents,
        strings=strings,
        wiring=wiring,
        supply_percent=100 * strings.supply_tolerance,
        resistor_percent=100 * strings.resistor_tolerance,
        left_v=wiring.supply_v - longest * strings.forward_v,
        load_mw=1000 * strings.resistor_w,
        high_mw=1000 * strings.resistor_high_w,
        rated_mw=1000 * strings.resistor_rated_w,
    )


def _of_sources(held: Regulation) -> dict[str, object]:
    return {
        "held": held,
        "supply_percent": 100 * held.supply_range,
        "change_percent": 100 * held.change,
        "spread_percent": 100 * held.spread,
        "load_mw": 1000 * held.power_w,
        "rated_mw": 1000 * held.rated_w,
    }


def channel_rows(design: Design) -> Iterator[Row]:
    """Light and signals of a channel, the time it needs, and the receiver's bulk capacitor."""
    channel, bulk = design.electrical.channel, design.electrical.bulk
    yield from _light(design)
    yield from rows_of(
        "channel",
        channel=channel,
        optics=design.layout.optics,
        pins=", ".join(design.wiring.adc_pins),
        pulled_up=pulled_up(design.wiring) or "one for each multiplexer",
        line_pf=channel.line_pf + channel.detector_pf,
        adc_bits=design.controller.adc_bits,
    )
    yield from _phototransistor(design)
    if bulk is not None:
        name, left_percent = design.packages.bulk_name, 100 * bulk.left
        yield from rows_of("bulk", bulk=bulk, name=name, left_percent=left_percent)


def _light(design: Design) -> Iterator[Row]:
    """How much of its range a bare cell uses, or that it is cut off."""
    share, target_ma = design.electrical.channel.light_share, design.electrical.strings.target_ma
    if share <= CUT_OFF_SHARE:
        return rows_of("within", percent=100 * share, target_ma=target_ma)
    covered, ohm = 100 * (1 - 1 / share), design.electrical.channel.whole_range_ohm
    return rows_of("beyond", share=share, target_ma=target_ma, covered=covered, ohm=ohm)


def _phototransistor(design: Design) -> Iterator[Row]:
    """Settling of a detector with its spread: the wait that it needs, or why there is none."""
    channel = design.electrical.channel
    spread = (
        f"hFE {channel.gain[0]:g} to {channel.gain[1]:g} and {channel.base_pf[0]:g} to "
        f"{channel.base_pf[1]:g} pF (assumed: measure yours)"
    )
    if channel.wait_us is None:
        slow_ms = [
            gain * base_pf * design.wiring.pull_up_ohm * 1e-9
            for gain, base_pf in zip(channel.gain, channel.base_pf, strict=True)
        ]
        return rows_of("floating", slow_ms=slow_ms, spread=spread)
    channels = 2 ** len(design.wiring.select_pins)
    scan_ms = (channels * channel.wait_us + len(design.layout) * CONVERSION_US) / 1000
    slow = ""
    if 1000 * scan_ms > channel.most_scan_us and design.wiring.pull_up_ohm > channel.fast_ohm:
        rate = 1e6 / channel.most_scan_us
        slow = f": fewer than {rate:.0f} a second. A pull-up of {channel.fast_ohm:g} Ω is faster"
    return rows_of("loaded", channel=channel, spread=spread, scan_ms=scan_ms, slow=slow)


def ambient_rows(design: Design) -> Iterator[Row]:
    """Where ambient light goes."""
    ambient, packages = design.electrical.ambient, design.packages
    if ambient is None or packages.switch is None:
        return rows_of("always_lit")
    return rows_of(
        "switched",
        packages=packages,
        wiring=design.wiring,
        ambient=ambient,
        light_ms=ambient.light_us / 1000,
        both_ms=_both_ms(ambient),
    )


def _both_ms(ambient: AmbientScan) -> float:
    return 2 * (ambient.light_us + ambient.scan_us) / 1000


def _rate(design: Design) -> tuple[str, str]:
    """Rate of the firmware as it is written, and what sets it."""
    ambient = design.electrical.ambient
    if ambient is None:
        return "set by the firmware", "no part of this design sets it: firmware and link do"
    return (
        f"{1e6 / ambient.period_us:.0f} Hz",
        f"a frame of {ambient.period_us / 1000:g} ms: {_both_ms(ambient):.1f} ms for two scans, "
        "the rest for radio and USB; LUMITIP_PERIOD_US in layout.h",
    )


def pulled_up(wiring: Wiring) -> str:
    """A sentence about inputs with pull-ups on the controller; empty without any."""
    if not wiring.pulled_up_ohm:
        return ""
    pins = " and ".join(pin for pin, _ in wiring.pulled_up_ohm)
    ohm = max(ohm for _, ohm in wiring.pulled_up_ohm)
    share = ohm / (ohm + wiring.pull_up_ohm)
    return (
        f"{pins}: {ohm:g} Ω to the supply on the controller, made for I2C; the cells read there "
        f"give {100 * share:.0f} % of the signal of the others. Use a multiplexer with more inputs "
        "or another controller"
    )


def _span(values: tuple[float, ...]) -> str:
    low, high = f"{min(values):.1f}", f"{max(values):.1f}"
    return f"{low} mA" if low == high else f"{low} to {high} mA"


def _set_by(design: Design) -> str:
    """How the current of the strings is set, after "strings"."""
    held, ohms = design.electrical.strings.regulation, design.wiring.resistor_ohm
    if held:
        return f"with {held.source} each"
    return "through " + ", ".join(f"{ohms.count(ohm)} x {ohm:g} Ω" for ohm in sorted(set(ohms)))


def input_rows(design: Design) -> Iterator[Row]:
    """The input of the board that the supply enters: of a flange with a regulator as it is plugged
    in; without a flange its parts, or that there are none."""
    if design.flanges:
        for plug_in in (each for each in design.electrical.plug_ins if each.capacitor_uf):
            yield from _plugged_in(plug_in)
    elif not design.entered:
        yield from rows_of("unprotected_input", supply_v=design.wiring.supply_v)
    else:
        for board, plug_in in zip(design.entered, design.electrical.plug_ins, strict=True):
            values = {device.ref: device.value for device in board.components}
            yield from rows_of("input", board=board, plug_in=plug_in, **values)
    for plug_in in design.electrical.plug_ins:
        yield from _tvs(plug_in, design.wiring.supply_v)


def _tvs(plug_in: PlugIn, supply_v: float) -> Iterator[Row]:
    """From where on the TVS diode may conduct."""
    over = {"over_percent": plug_in.conducts_v, "percent": plug_in.supply_v}
    percent = {name: 100 * (volts / supply_v - 1) for name, volts in over.items()}
    conducts_v = math.floor(10 * plug_in.conducts_v) / 10
    return rows_of("tvs", plug_in=plug_in, conducts_v=conducts_v, supply_v=supply_v, **percent)


def _plugged_in(plug_in: PlugIn) -> Iterator[Row]:
    rated = "" if plug_in.pulse_a is None else f"; its MOSFET bears {plug_in.pulse_a:g} A"
    melts = ""
    if plug_in.melting_a2s is not None:
        share = 100 * plug_in.surge_a2s / plug_in.melting_a2s
        melts = f"; {share:.0f} % of the fuse's melting I²t"
    pulse_mj = 1000 * plug_in.pulse_j
    return rows_of("plugged_in", plug_in=plug_in, rated=rated, melts=melts, pulse_mj=pulse_mj)
