"""Figures of the circuit in closed form; tests compare them with a simulation."""

from dataclasses import dataclass

from lumitip_fab.design.protection import Protection


@dataclass(frozen=True)
class Regulation:
    """How well current sources hold the current of the strings, and what they bear."""

    source: str
    """In the catalogue."""
    set_v: float
    """Voltage across the resistor at SET, and across that at OUT."""
    change: float
    """Of the current of one part over supply and temperature: a fraction, either way."""
    spread: float
    """From part to part: a fraction, either way."""
    left_v: float
    """At the longest string, beyond what the source needs, at the worst case."""
    power_w: float
    """Largest power of a source, at the worst case."""
    rated_w: float
    """Power with which its chip reaches its highest temperature at the highest ambient one."""
    supply_range: float
    """Fraction by which the supply changes, either way."""
    resistor_per_k: float
    """Temperature coefficient of its resistors: a fraction, either way."""
    most_load: float
    """Largest share of `rated_w` that is allowed."""


@dataclass(frozen=True)
class Strings:
    """Currents of the LED strings beyond the nominal ones in `Wiring`."""

    forward_v: float
    """Forward voltage of an LED at `target_ma`."""
    forward_tolerance_v: float
    ideality: float
    """The voltage grows by this many times the thermal voltage for each factor e of current."""
    target_ma: float
    supply_tolerance: float
    """Fraction by which the supply may be off, either way."""
    resistor_tolerance: float
    """Fraction by which a resistor may be off, either way."""
    temperatures_c: tuple[float, float]
    """Least and greatest ambient temperature."""
    forward_v_per_k: float
    """Greatest fall of an LED's forward voltage with temperature."""
    low_ma: tuple[float, ...]
    """Current of each string with the lowest supply, the highest forward voltages, in the cold, and
    the highest resistor; with current sources by their tolerances."""
    high_ma: tuple[float, ...]
    fewer_leds: int
    """A shorter string, to compare: LEDs in it, and its currents."""
    fewer_low_ma: float
    fewer_high_ma: float
    resistor_w: float
    """Largest load of a resistor that carries a string's current, nominal."""
    resistor_high_w: float
    """The same at the worst case of all tolerances and temperatures."""
    resistor_rated_w: float
    """Rated power of the resistor's package."""
    regulation: Regulation | None = None
    """None where a resistor alone sets the current."""


CUT_OFF_SHARE = 1.1
"""Light of a bare cell, of its range: up to here the catalogue's figure cannot tell."""


@dataclass(frozen=True)
class Channel:
    """Channel from a detector to the controller."""

    supply_v: float
    """Supply of the detectors, which is also the reference of the ADC."""
    light_current_ua: float
    light_share: float
    """Light of a bare cell at the LEDs' current, as a share of what saturates a pull-up; above 1 it
    is cut off."""
    whole_range_ohm: float
    """The greatest pull-up that is sold with which a bare cell is not cut off."""
    fast_ohm: float
    """The greatest own pull-up that is sold with which a scan takes `most_scan_us` at most."""
    dark_current_na: float
    saturation_v: float
    on_resistance_ohm: float
    detector_pf: float
    line_pf: float
    """Common terminal of the multiplexer, wire and input of the controller, with the parts that
    protect it."""
    wire_pf: float
    """Of it, the longest wire of a finger to the controller, to those beside it."""
    step_v: float
    """One step of the ADC."""
    full_scale_v: float
    """At full light."""
    dark_v: float
    settle_us: float
    """From full light to darkness within half a step of the ADC, after a change of channel, for a
    detector without a base."""
    wait_us: float | None
    """After a change of channel, until every phototransistor reads within half a count of 255 of
    its settled value; none where collectors float between their turns."""
    most_scan_us: float
    """Scan of all cells at the rate that readings settle for."""
    gain: tuple[float, float]
    """Current gain hFE of the detectors, least and greatest."""
    base_pf: tuple[float, float]
    """Capacitance from collector to base, least and greatest."""


@dataclass(frozen=True)
class AmbientScan:
    """Times of a frame that is scanned without the light of the LEDs and with it."""

    light_us: float
    """After the LEDs are switched, until the slowest photodetector is near its new reading."""
    near_counts: float
    """How near, in counts of 255."""
    scan_us: float
    """Shortest scan of all cells, without that wait."""
    period_us: int
    """From frame to frame, with what radio and USB take."""


@dataclass(frozen=True)
class Regulated:
    """A switching regulator in continuous conduction."""

    input_v: float
    output_v: float
    switching_khz: float
    soft_start_ms: float
    switch_ohm: float
    """Resistance of both switches, each weighted by its share of the time."""
    inductance_uh: float
    capacitors: tuple[str, ...]
    """The output capacitors beside the coil. What else is at the output, such as the input of a
    linear regulator, is left out: with it there is less ripple."""
    capacitor_uf: float
    """Capacitance of each after DC-bias derating."""
    load_a: float
    """For which the figures are."""
    ripple_a: float
    """Ripple of the coil's current, peak to peak; below half of it the regulator skips pulses."""
    ripple_mv: float
    """Ripple of the output, from low to high."""
    charging_a: float
    """Into the output capacitors during the soft start."""


@dataclass(frozen=True)
class PlugIn:
    """The board that the robot's supply enters, as it is plugged into a live supply."""

    board: str
    """Its name: the flange's, or the breakout without a flange."""
    supply_v: float
    """Highest supply."""
    cable_uh: tuple[float, float]
    """Least and greatest inductance of the cable."""
    inrush_ohm: float
    """Resistor before the regulator's input."""
    capacitor_uf: float
    """Capacitor at the regulator's input without voltage; 0 where there is no regulator."""
    left: float
    """Fraction of it at `left_at_v`: its DC-bias derating."""
    left_at_v: float
    capacitor_tolerance: float
    """Fraction by which it may be off, either way."""
    breakdown_v: tuple[float, float]
    """Least and greatest breakdown voltage of the TVS diode at 25 °C."""
    conducts_v: float
    """Least voltage at which it conducts, at `coldest_c`."""
    coldest_c: float
    tvs_ohm: float
    """Dynamic resistance of the TVS diode."""
    clamping_v: float
    """Its voltage at its rated pulse."""
    gate_v: float
    """Rated voltage between gate and source of the MOSFET."""
    limit_v: float
    """Largest voltage at the regulator's input; without a regulator, at the supply behind the
    MOSFET."""
    peak_a: float
    """Peak of the current, without the cable's inductance."""
    pulse_a: float | None
    """Rated pulse of the MOSFET; none where it is not known."""
    surge_a2s: float
    """I²t of the pulse, an upper bound."""
    melting_a2s: float | None
    """Melting I²t of the fuse; none where it is not known."""
    pulse_j: float
    """Energy of the pulse in the resistor, an upper bound."""


@dataclass(frozen=True)
class Indicator:
    """The power LED of a board beside the fingers, with its resistor."""

    board: str
    """Name of the board."""
    led_ref: str
    resistor_ref: str
    led: str
    """In the catalogue."""
    colour: str
    output_v: float
    """Nominal voltage of what feeds it: the flange's output, or the controller's supply."""
    supply_tolerance: float
    """Fraction by which that may be off, either way."""
    resistor_tolerance: float
    forward_v: tuple[float, float]
    """Least and greatest forward voltage."""
    ohm: float
    low_ma: float
    """Least current: low output, high forward voltage, high resistance."""
    high_ma: float
    """Greatest current."""
    visible_ma: float
    """Least current with which it is seen in a lit room."""
    max_ma: float
    """Its largest continuous current."""
    resistor_w: float
    """Power of the resistor at the greatest current."""
    rated_w: float
    """Its rated power."""
    load: float
    """Largest fraction of its rated power."""


@dataclass(frozen=True)
class Bulk:
    """The bulk capacitor of the receiver at the end of its supply's wire."""

    supply_v: float
    wire_uh: float
    """Inductance of the wire with its return."""
    step_ma: float
    """Change of the current of all detectors together."""
    capacitor_uf: float
    left: float
    """Fraction of it at its supply: its DC-bias derating."""
    tolerance: float
    """Fraction by which it may be less."""
    dip_mv: float
    """Dip of the supply at that change."""
    most_mv: float
    reach_mm: float
    """From its pad to the wire's, at most."""


@dataclass(frozen=True)
class Electrical:
    """Figures of the boards."""

    strings: Strings
    channel: Channel
    heat_w: float
    """LEDs and string resistors, nominal."""
    supplies: tuple[Regulated, ...]
    """The flange's regulator; none without it."""
    plug_ins: tuple[PlugIn, ...] = ()
    """The board that the supply enters; none where that does not protect its input."""
    indicators: tuple[Indicator, ...] = ()
    """The power LEDs, at most one for each board."""
    bulk: Bulk | None = None
    """The receiver's bulk capacitor; none without it."""
    protection: Protection | None = None
    """None where the controller's pins are joined to the wires."""
    ambient: AmbientScan | None = None
    """None where the LEDs are always on."""

    @property
    def mean_heat_w(self) -> float:
        """Mean power: LEDs that are switched are off while ambient light is scanned."""
        if self.ambient is None:
            return self.heat_w
        off_us = self.ambient.light_us + self.ambient.scan_us
        return self.heat_w * (1 - off_us / self.ambient.period_us)
