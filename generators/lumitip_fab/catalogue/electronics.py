"""Catalogue entries of what is soldered to the fingers' boards."""

from typing import Literal, Self

from pydantic import Field, model_validator

from lumitip_fab.catalogue.record import (
    TRUSTED,
    Capacitances,
    Confidence,
    Entry,
    Gains,
    Length,
    Ordered,
    OrderedByValue,
    Voltages,
)


class Chip(Ordered, Entry):
    """A two-terminal part soldered flat on its board."""

    body_mm: tuple[Length, Length, Length]
    """Body: along its terminals, across them, height above the board."""
    pad_mm: tuple[Length, Length]
    """One solder pad: along the terminals, across them."""
    pad_pitch_mm: Length
    """Distance between the centres of the two pads."""

    @property
    def over_pads_mm(self) -> tuple[float, float]:
        """Length and width of the land pattern, body included."""
        along = max(self.pad_pitch_mm + self.pad_mm[0], self.body_mm[0])
        return along, max(self.pad_mm[1], self.body_mm[1])


class Marked(Chip):
    """A chip with a mark at one of its terminals."""

    marked_confidence: Confidence | None = None
    """Confidence in the terminal that its mark shows; by default that of the entry. Write
    "measured" after the test with a multimeter in the build manual: the order files then carry no
    stop line, and no line that asks to check it."""

    @property
    def mark_confidence(self) -> Confidence:
        """Confidence in the marked terminal."""
        return self.marked_confidence or self.confidence

    @property
    def mark_is_known(self) -> bool:
        """Whether the marked terminal is measured, or read from a datasheet."""
        return self.mark_confidence in TRUSTED


class Optical(Marked):
    """A chip that emits or detects light through its top."""

    die_height_mm: Length
    """Height of the light-emitting or light-sensitive surface above the board."""

    @model_validator(mode="after")
    def _die_in_body(self) -> Self:
        if self.die_height_mm > self.body_mm[2]:
            raise ValueError(
                f"die_height_mm is {self.die_height_mm:g}; at most the body's height of "
                f"{self.body_mm[2]:g} is allowed"
            )
        return self


class Polar(Optical):
    """A part at a cell, with a mark at one of its terminals."""

    marked: str
    """Terminal that the part's mark shows; the board's mark is beside it."""


class Led(Polar):
    """An infrared light-emitting diode."""

    forward_voltage_v: float = Field(ge=0.1, le=10)
    """Forward voltage at the working current."""
    forward_tolerance_v: float = Field(ge=0, le=2)
    """Tolerance of the forward voltage, either way."""
    ideality: float = Field(ge=1, le=5)
    """Ideality factor n: how its voltage grows with the logarithm of its current."""
    marked: Literal["anode", "cathode"]
    """Terminal that the part's mark shows; the board's mark is beside it."""
    max_current_ma: float = Field(ge=0.1, le=1000)
    """Largest continuous current."""
    exponent: float = Field(ge=0, le=50)
    """Exponent m of the radiant intensity cos(angle) ** m; 1 is Lambertian."""


class Indicator(Marked):
    """A light-emitting diode to look at: terminal 1 is its cathode."""

    colour: Literal["green", "yellow-green", "yellow", "orange", "red", "blue", "white"]
    """Colour of its light."""
    forward_v: Voltages
    """Least and greatest forward voltage at the working current."""
    current_ma: float = Field(ge=0.1, le=100)
    """Working current."""
    visible_ma: float = Field(ge=0.01, le=100)
    """Least current with which it is seen in a lit room."""
    max_current_ma: float = Field(ge=0.1, le=1000)
    """Largest continuous current."""


class Photodetector(Polar):
    """A phototransistor or photodiode."""

    exponent: float = Field(ge=0, le=50)
    """Exponent n of the sensitivity cos(angle) ** n."""
    marked: Literal["collector", "emitter"]
    """Terminal that the part's mark shows; the board's mark is beside it."""
    dark_current_na: float = Field(ge=0, le=1e6)
    """Largest collector current without light."""
    light_current_ua: float = Field(gt=0, le=1e6)
    """Collector current under a bare LED, nothing between the fingers."""
    saturation_v: float = Field(ge=0, le=2)
    """Collector to emitter voltage when the light asks for more current than there is."""
    capacitance_pf: float = Field(ge=0, le=1e4)
    """Capacitance of the collector."""
    gain: Gains = (100.0, 1000.0)
    """Current gain hFE, least and greatest; 1 and 1 for a photodiode. The default is assumed."""
    base_pf: Capacitances = (3.0, 10.0)
    """Capacitance from collector to base, least and greatest. The default is assumed."""


class Resistor(OrderedByValue, Chip):
    """A resistor package."""

    power_w: float = Field(gt=0, le=10)
    """Rated power at 70 °C."""


class PulseResistor(Resistor):
    """A resistor package that withstands pulses."""


class ResistorArray(OrderedByValue, Entry):
    """Separate resistors side by side in one chip, each between two opposite pads."""

    body_mm: tuple[Length, Length, Length]
    """Body: along its rows of pads, across them, height above the board."""
    pad_mm: tuple[Length, Length]
    """One solder pad: along the row, across it."""
    pad_pitch_mm: Length
    """From pad to pad along a row."""
    row_pitch_mm: Length
    """From the middle of one row to the other."""
    resistors: int = Field(ge=2, le=8)
    """Resistors in the chip."""
    power_w: float = Field(gt=0, le=10)
    """Rated power of each resistor at 70 °C."""

    @property
    def over_pads_mm(self) -> tuple[float, float]:
        """Length and width of the land pattern, body included: along its rows, across them."""
        length = (self.resistors - 1) * self.pad_pitch_mm + self.pad_mm[0]
        return max(length, self.body_mm[0]), max(
            self.row_pitch_mm + self.pad_mm[1], self.body_mm[1]
        )


class Capacitor(Chip):
    """A ceramic capacitor."""

    capacitance_nf: float = Field(gt=0, le=1e6)
    """Capacitance."""
    rated_v: float = Field(gt=0, le=1e4)
    """Rated voltage."""
    left: float = Field(default=1, gt=0, le=1)
    """DC-bias derating: fraction of the capacitance at the working voltage."""


class Inductor(Chip):
    """A power inductor."""

    inductance_uh: float = Field(gt=0, le=1e5)
    """Inductance."""


class Crystal(Chip):
    """A quartz crystal of 32.768 kHz."""

    load_pf: float = Field(gt=0, le=100)
    """Load capacitance C_L: its two capacitors in series, with strays."""


class Fuse(Chip):
    """A fuse."""

    rated_a: float = Field(gt=0, le=100)
    """Rated current."""
    rated_v: float = Field(gt=0, le=1000)
    """Rated breaking voltage."""
    melting_a2s: float | None = Field(default=None, gt=0, le=1e4)
    """Melting I²t: integral of the squared current of a short pulse that melts it."""


class Multiplexer(Ordered, Entry):
    """An analog multiplexer with its leads in two rows."""

    body_mm: tuple[Length, Length, Length]
    """Body: along the rows of leads, across them, height above the board."""
    lead_span_mm: Length
    """Outer ends of the pads of the two rows."""
    lead_tips_mm: Length
    """Outer ends of the leads of the two rows."""
    lead_pad_mm: tuple[Length, Length]
    """Pad of one lead: along the lead, across it."""
    lead_pitch_mm: Length
    """Distance between neighbouring leads."""
    leads: int = Field(ge=8, le=128)
    """Number of leads, both rows together."""
    inputs: dict[str, int]
    """Lead number of each input, by channel: `0 = 13` means Y0 is lead 13."""
    select: tuple[int, ...] = Field(min_length=1, max_length=8)
    """Lead numbers of the select lines, least significant first."""
    output: int = Field(ge=1)
    """Lead number of the common terminal."""
    supply: int = Field(ge=1)
    """Lead number of the supply."""
    ground: int = Field(ge=1)
    """Lead number of the ground."""
    enable: int = Field(ge=1)
    """Lead number of the enable input, active low: tied to ground."""
    negative: int | None = None
    """Lead number of the negative supply, if there is one: tied to ground."""
    on_resistance_ohm: float = Field(gt=0, le=1e4)
    """Largest resistance from an input to the common terminal at the detectors' supply."""
    common_pf: float = Field(ge=0, le=1e4)
    """Capacitance of the common terminal."""
    bypass_nf: Capacitances
    """Least and greatest capacitance between its supply and ground."""

    @property
    def input_leads(self) -> tuple[int, ...]:
        """Lead of each input, by channel."""
        return tuple(self.inputs[str(channel)] for channel in range(self.channels))

    @property
    def channels(self) -> int:
        """Number of inputs."""
        return len(self.inputs)

    @model_validator(mode="after")
    def _leads_exist(self) -> Self:
        single = (self.output, self.supply, self.ground, self.enable, self.negative)
        used = (*self.inputs.values(), *self.select, *(lead for lead in single if lead is not None))
        if set(self.inputs) != {str(i) for i in range(len(self.inputs))} or not self.inputs:
            inputs = ", ".join(self.inputs) or "none"
            raise ValueError(
                f"inputs are {inputs}; the channels 0, 1, 2 … without a gap are needed"
            )
        if self.channels > 2 ** len(self.select):
            raise ValueError(
                f"has {self.channels} inputs; {len(self.select)} select lines reach at most "
                f"{2 ** len(self.select)}"
            )
        if len(set(used)) != len(used) or not all(1 <= lead <= self.leads for lead in used):
            raise ValueError(
                f"inputs, select, output, supply, ground, enable and negative are on leads "
                f"{sorted(used)}; each needs a lead of its own from 1 to leads = {self.leads}"
            )
        return self
