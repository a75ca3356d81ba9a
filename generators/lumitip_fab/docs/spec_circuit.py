"""Electrical figures of a design beside the published ones."""

from lumitip_fab.design import Design, Wiring
from lumitip_fab.design.electrical import AmbientScan, Regulation
from lumitip_fab.docs.outside import Row

CONVERSION_US = 30
"""As in `settings.h` of the firmware: one conversion."""


def electrical_rows(design: Design) -> tuple[Row, ...]:
    wiring, controller, optics = design.wiring, design.controller, design.layout.optics
    return (
        Row(
            "resolution",
            "8 bits",
            f"{controller.adc_bits} bits",
            f"all bits of the ADC of {controller.title}; the published firmware keeps 8",
        ),
        Row(
            "rate",
            "55 Hz",
            *_rate(design),
        ),
        Row(
            "current of the emitter",
            "38 mA",
            f"{sum(wiring.current_ma):.1f} mA",
            f"nominal: {len(wiring.strings)} strings {_set_by(design)} from {wiring.supply_v:g} V; "
            "Table I gives whole mA",
        ),
        Row(
            "current of the receiver",
            "1 mA",
            f"{_pull_up_ma(design):.2f} mA",
            f"{wiring.pull_ups} pull-ups of {optics.pull_up_ohm:g} Ω at {optics.supply_v:g} V and "
            "full light; multiplexers take microamperes, Table I gives whole mA",
        ),
        Row(
            "warm-up",
            "5 min",
            "not computed",
            "heat flows into gripper and grasped things: measure it on your sensor",
        ),
    )


def string_rows(design: Design) -> tuple[Row, ...]:
    strings, wiring = design.electrical.strings, design.wiring
    if strings.regulation:
        return _source_rows(design, strings.regulation)
    low, high = min(strings.low_ma), max(strings.high_ma)
    longest = max(len(string) for string in wiring.strings)
    left_v = wiring.supply_v - longest * strings.forward_v
    return (
        Row("current of a string", "19 to 20 mA", _span(wiring.current_ma), "nominal"),
        Row(
            "... over tolerances",
            "not stated",
            f"{low:.1f} to {high:.1f} mA",
            f"supply ±{100 * strings.supply_tolerance:g} %, forward voltage "
            f"±{strings.forward_tolerance_v:g} V, "
            f"resistor ±{100 * strings.resistor_tolerance:g} %: "
            f"{longest} LEDs leave {left_v:.2f} V of {wiring.supply_v:g} V to the resistor; with "
            f"emitter.string_leds = {strings.fewer_leds} it is "
            f"{strings.fewer_low_ma:.1f} to {strings.fewer_high_ma:.1f} mA, on more strings",
        ),
        Row(
            "load of a string resistor",
            "not stated",
            f"{1000 * strings.resistor_w:.0f} mW",
            f"nominal; up to {1000 * strings.resistor_high_w:.0f} mW at {high:.1f} mA, of "
            f"{1000 * strings.resistor_rated_w:.0f} mW rated",
        ),
    )


def _source_rows(design: Design, held: Regulation) -> tuple[Row, ...]:
    strings, wiring = design.electrical.strings, design.wiring
    low, high = min(strings.low_ma), max(strings.high_ma)
    coldest, hottest = held.temperatures_c
    longest = max(len(string) for string in wiring.strings)
    where = (
        f"supply ±{100 * held.supply_range:g} %, {coldest:g} to {hottest:g} °C; computed, and "
        "simulated with ngspice from the data sheet's figures"
    )
    return (
        Row("current of a string", "19 to 20 mA", _span(wiring.current_ma), "nominal"),
        Row("... of one part", "not stated", f"±{100 * held.change:.1f} %", where),
        Row(
            "... from part to part",
            "not stated",
            f"±{100 * held.spread:.1f} %",
            f"reference, offset and resistors of {held.source}: {low:.1f} to {high:.1f} mA with "
            "all of it; calibration takes it off",
        ),
        Row(
            "voltage left to a current source",
            "not stated",
            f"{held.left_v:.2f} V",
            f"beyond what it needs, with {longest} LEDs, the lowest supply and cold LEDs",
        ),
        Row(
            "power of a current source",
            "not stated",
            f"{1000 * held.power_w:.0f} mW",
            f"at most, with the highest supply and warm LEDs, of {1000 * held.rated_w:.0f} mW that "
            f"it bears at {hottest:g} °C",
        ),
    )


def channel_rows(design: Design) -> tuple[Row, ...]:
    channel, optics = design.electrical.channel, design.layout.optics
    line_pf = channel.line_pf + channel.detector_pf
    return (
        Row(
            "analog inputs",
            "A0 to A3",
            ", ".join(design.wiring.adc_pins),
            pulled_up(design.wiring) or "one for each multiplexer",
        ),
        Row(
            "signal at full light",
            "not stated",
            f"{channel.full_scale_v:.2f} V",
            f"of {optics.supply_v:g} V: the detector saturates at {channel.saturation_v:g} V "
            f"or takes {channel.light_current_ua:g} µA, whichever is less",
        ),
        Row(
            "signal in the dark",
            "not stated",
            f"{channel.dark_v:.2f} V",
            f"{channel.dark_current_na:g} nA through {optics.pull_up_ohm:g} Ω",
        ),
        Row(
            "settling of a channel",
            "not stated",
            f"{channel.settle_us:.0f} µs",
            f"{line_pf:g} pF through {optics.pull_up_ohm:g} Ω, from full light to dark within half "
            f"a step of {design.controller.adc_bits} bits, for a detector without a base",
        ),
        _phototransistor(design),
        *_bulk(design),
    )


def _bulk(design: Design) -> tuple[Row, ...]:
    """The receiver's bulk capacitor; none without it."""
    bulk = design.electrical.bulk
    if bulk is None:
        return ()
    return (
        Row(
            "bulk capacitor of the receiver",
            "not stated",
            design.packages.bulk_name,
            f"beside the supply's wire: of {bulk.capacitor_uf:g} µF, {100 * bulk.left:g} % are "
            f"left by DC bias; the supply dips by {bulk.dip_mv:.1f} mV as all detectors change by "
            f"{bulk.step_ma:.1f} mA over {bulk.wire_uh:.2f} µH of wire, at most "
            f"{bulk.most_mv:.1f} mV is allowed",
        ),
    )


def _phototransistor(design: Design) -> Row:
    """Settling of a detector with its spread: the wait that it needs, or why there is none."""
    channel = design.electrical.channel
    spread = (
        f"hFE {channel.gain[0]:g} to {channel.gain[1]:g} and {channel.base_pf[0]:g} to "
        f"{channel.base_pf[1]:g} pF (assumed: measure yours)"
    )
    if channel.wait_us is None:
        return Row(
            "... of a phototransistor",
            "not stated",
            f"{_slow_ms(design, 0):.2g} to {_slow_ms(design, 1):.2g} ms",
            f"time constant hFE x C_cb x R at {spread}: a collector floats until its turn, so that "
            'readings in the dark are too low. receiver.load = "each" avoids it',
        )
    channels = 2 ** len(design.wiring.select_pins)
    scan_ms = (channels * channel.wait_us + len(design.layout) * CONVERSION_US) / 1000
    return Row(
        "... of a phototransistor",
        "not stated",
        f"{channel.wait_us:.0f} µs",
        f"within half a count of 255 after any change, at {spread}. The firmware waits at least "
        f"that long: a scan takes {scan_ms:.1f} ms or more",
    )


def ambient_rows(design: Design) -> tuple[Row, ...]:
    """Where ambient light goes."""
    ambient, packages = design.electrical.ambient, design.packages
    if ambient is None or packages.switch is None:
        words = "the LEDs are always on, so that it cannot be measured apart"
        return (Row("ambient light", "not stated", "stays in the codes", words),)
    return (
        Row(
            "ambient light",
            "not stated",
            "taken off",
            f"{packages.switch_name} turns the LEDs off by pin {design.wiring.emitter_pin}: every "
            "frame is scanned without them and with them",
        ),
        Row(
            "... wait after switching",
            "not stated",
            f"{ambient.light_us / 1000:.1f} ms",
            f"until the slowest detector of that spread is within {ambient.near_counts:g} counts "
            f"of 255; both scans with their waits take {_both_ms(ambient):.1f} ms",
        ),
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


def _slow_ms(design: Design, end: int) -> float:
    """Time constant of a phototransistor at its pull-up: 0 for the fastest, 1 for the slowest."""
    channel = design.electrical.channel
    return channel.gain[end] * channel.base_pf[end] * design.wiring.pull_up_ohm * 1e-9


def _span(values: tuple[float, ...]) -> str:
    low, high = f"{min(values):.1f}", f"{max(values):.1f}"
    return f"{low} mA" if low == high else f"{low} to {high} mA"


def _set_by(design: Design) -> str:
    """How the current of the strings is set, after "strings"."""
    held = design.electrical.strings.regulation
    return f"with {held.source} each" if held else f"through {_ohms(design.wiring.resistor_ohm)}"


def _ohms(values: tuple[float, ...]) -> str:
    return ", ".join(f"{values.count(v)} x {v:g} Ω" for v in sorted(set(values)))


def _pull_up_ma(design: Design) -> float:
    optics = design.layout.optics
    return 1000 * design.wiring.pull_ups * optics.supply_v / optics.pull_up_ohm
