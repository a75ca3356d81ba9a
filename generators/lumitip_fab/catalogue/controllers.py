"""Catalogue entries of controllers, and of sockets, regulators and transistors beside them."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from lumitip_fab.catalogue.record import (
    Capacitances,
    Entry,
    Length,
    Name,
    Offset,
    Ordered,
    Pin,
    Share,
    Strict,
    Voltages,
)

Signal = Annotated[str, Field(pattern=r"^[A-Za-z0-9_+\-]{1,12}$")]
OPEN = "NC"
"""Signal of an open contact."""
PinName = Annotated[str, Field(pattern=r"^[A-Z0-9]{1,6}$")]


class Shroud(Strict):
    """The shroud of a right-angle box header, beside its rows of contacts."""

    body_mm: tuple[Length, Length]
    """Along the rows, and from its back to the end where the plug goes in."""
    beyond_mm: Length
    """From the nearest row of contacts to its back."""
    notch_mm: Length
    """Width of the notch in its upper wall, for the key of the plug."""


class Strip(Ordered, Entry):
    """One or two rows of contacts in plated holes."""

    ways: int = Field(ge=1, le=64)
    """Contacts in a row."""
    rows: int = Field(default=1, ge=1, le=2)
    """Rows, as far apart as contacts."""
    pitch_mm: Length
    """From contact to contact."""
    pad_mm: Length
    """Diameter of the copper round a hole."""
    drill_mm: Length
    """Diameter of a hole."""
    height_mm: Length
    """Above the board."""
    stroke_mm: float = Field(default=0, ge=0, le=10)
    """Travel of spring contacts; 0 for others."""
    contact_a: float = Field(default=0, ge=0, le=100)
    """Largest current of one; 0 where it is not known."""
    hand_soldered: bool = False
    """Whether it is soldered on by hand, and so in no PCB fab's bill or placement list."""
    shroud: Shroud | None = None
    """Shroud of a right-angle box header; none for others, whose body is over their contacts."""
    mate: Name | None = None
    """Name of the mating connector in `packs.toml`; none where wires are soldered on."""


class Plug(Strict):
    """A controller board on two socket strips, its USB plug to the left.

    ```
         rows[1][0] … rows[1][-1]
    USB ▐                        ▌
         rows[0][0] … rows[0][-1]
    ```
    """

    rows: tuple[
        Annotated[tuple[PinName, ...], Field(min_length=2, max_length=64)],
        Annotated[tuple[PinName, ...], Field(min_length=2, max_length=64)],
    ]
    """Names of the pins of both rows from left to right, the lower row first."""
    spacing_mm: Length
    """From row to row."""
    body_mm: tuple[Length, Length]
    """Length and width of the controller board."""
    ground: PinName
    """Its ground pins."""
    supply: PinName
    """Pin that takes the regulated supply."""
    least_v: float = Field(default=4.4, gt=0, le=30)
    """Least voltage at the supply pin with which it works (V); by default USB's least, assumed."""
    regulated: PinName
    """Pin that feeds the receiver."""


class Leaded(Ordered, Entry):
    """A small part with gull-wing leads in two rows, lead 1 at the lower left."""

    body_mm: tuple[Length, Length, Length]
    """Body: along the rows of leads, across them, height above the board."""
    lead_span_mm: Length
    """Outer ends of the pads of the two rows."""
    lead_tips_mm: Length | None = None
    """Outer ends of the leads of the two rows; by default 0.4 mm inside those of the pads."""
    lead_pitch_mm: Length
    """Distance between neighbouring leads of the lower row."""
    lead_pad_mm: tuple[Length, Length]
    """Pad of one lead: along the lead, across it."""
    names: tuple[PinName, ...] = Field(min_length=3, max_length=16)
    """Counter-clockwise from lead 1; of an odd number the upper row has one less, in its middle."""


class Regulator(Leaded):
    """A step-down switching regulator with a fixed output: FB, EN, VIN, GND, SW and BST."""

    output_v: float = Field(gt=0, le=24)
    input_v: Voltages
    """Least and greatest input voltage."""
    output_a: float = Field(gt=0, le=20)
    """Largest continuous output current."""
    switching_khz: float = Field(gt=0, le=1e5)
    """Switching frequency."""
    soft_start_ms: float = Field(gt=0, le=1000)
    """Until its output stands."""
    boot_nf: Capacitances
    """Least and greatest capacitance between SW and BST."""
    switch_ohm: tuple[Share, Share]
    """Resistance of the switch to the input and of that to ground."""

    @model_validator(mode="after")
    def _has_its_leads(self) -> Self:
        if set(self.names) != {"FB", "EN", "VIN", "GND", "SW", "BST"}:
            raise ValueError(
                f"names are {', '.join(self.names)}; FB, EN, VIN, GND, SW and BST are needed"
            )
        return self


class LinearRegulator(Leaded):
    """A linear regulator with a fixed output: GND, OUT and IN."""

    output_v: float = Field(gt=0, le=24)
    """Output voltage."""
    input_v: Voltages
    """Least and greatest input voltage."""
    output_a: float = Field(gt=0, le=20)
    """Largest continuous output current."""
    stable_nf: Capacitances
    """Least and greatest capacitance at its output."""

    @model_validator(mode="after")
    def _has_its_leads(self) -> Self:
        if set(self.names) != {"GND", "OUT", "IN"}:
            raise ValueError(f"names are {', '.join(self.names)}; GND, OUT and IN are needed")
        return self


class Transistor(Leaded):
    """A MOSFET: G, S and D. Voltages are magnitudes."""

    channel: Literal["P", "N"] = "P"
    """P where it keeps a reversed supply out, N where it switches the LEDs."""
    rated_v: float = Field(gt=0, le=1000)
    """Largest voltage between source and drain."""
    gate_v: float = Field(gt=0, le=100)
    """Largest voltage between source and gate."""
    gate_on_v: float = Field(gt=0, le=100)
    """Voltage between source and gate at which it is on for certain."""
    on_ohm: float | None = Field(default=None, gt=0, le=100)
    """Largest resistance from drain to source at `gate_on_v`; needed of a switch."""
    drain_a: float | None = Field(default=None, gt=0, le=1000)
    """Largest continuous current; needed of a switch."""
    pulse_a: float | None = Field(default=None, gt=0, le=1e4)
    """Largest current of a pulse of 10 µs, through its channel or its body diode."""

    @model_validator(mode="after")
    def _has_its_leads(self) -> Self:
        if set(self.names) != {"G", "S", "D"}:
            raise ValueError(f"names are {', '.join(self.names)}; G, S and D are needed")
        return self

    @model_validator(mode="after")
    def _switches(self) -> Self:
        if self.channel == "N" and (self.on_ohm is None or self.drain_a is None):
            raise ValueError('has channel = "N"; on_ohm and drain_a are needed too')
        return self


ANALOG_PORTS = ("P0_02", "P0_03", "P0_04", "P0_05", "P0_28", "P0_29", "P0_30", "P0_31")
"""AIN0 to AIN7 of the nRF52840, by its product specification."""
_SINGLE = ("VDD", "VDDH", "VBUS", "USB_DM", "USB_DP", "SWDIO", "SWDCLK", "P0_18")
"""Pads that are wired by name; P0.18 is the reset."""


class Module(Ordered):
    """A module with Nordic's nRF52840 and an antenna, soldered to the flange's board.

    Places are in mm from the middle of its body, seen from above with the antenna at the top.
    """

    body_mm: tuple[Length, Length, Length]
    """Body: across, along, height above the board."""
    bypass_nf: Capacitances
    """Least and greatest capacitance beside its supply."""
    crystal: tuple[Pin, Pin]
    """Ports of the crystal of 32.768 kHz."""
    keep_out_mm: tuple[tuple[Offset, Offset, Offset, Offset], ...]
    """Rectangles under the antenna without copper on either side: left, low, right, high."""
    names: Annotated[tuple[Pin, ...], Field(min_length=8, max_length=128)]
    """Name of each pad from pad 1: ports such as `P0_04`, `GND`, and those wired by name."""
    pads_mm: tuple[tuple[Offset, Offset, Length, Length], ...]
    """Middle, width and height of each pad."""
    ports: dict[Pin, Pin]
    """Port of each pin that the firmware's board definition has: `A0 = "P0_04"`."""

    def measures(self, pin: str) -> bool:
        """Whether a pin is an analog input."""
        return self.ports[pin] in ANALOG_PORTS

    @model_validator(mode="after")
    def _pads_exist(self) -> Self:
        if len(self.names) != len(self.pads_mm):
            raise ValueError(
                f"has {len(self.names)} names and {len(self.pads_mm)} places of pads; each pad "
                "needs both"
            )
        ports = (*self.crystal, *self.ports.values())
        for name in (*_SINGLE, *ports):
            if self.names.count(name) != 1:
                raise ValueError(f"has {self.names.count(name)} pads named {name}; 1 is needed")
        twice = sorted({port for port in ports if ports.count(port) > 1})
        if twice:
            raise ValueError(f"has {', '.join(twice)} twice; each port is used once")
        if "GND" not in self.names:
            raise ValueError("has no pad named GND; at least one is needed")
        return self


class Controller(Entry):
    """A microcontroller that reads the multiplexers: a board, or a module on the flange's board."""

    analog_pins: tuple[Pin, ...] = Field(min_length=1)
    """Analog inputs in the order in which they are used; those of `pulled_up_ohm` come last."""
    pulled_up_ohm: dict[Pin, float] = Field(default_factory=dict)
    """Pull-up resistor on the controller, by analog input: beside that of the multiplexer it makes
    the signal smaller. Such pins are used when no other is left."""
    unlimited_analog_pins: bool = False
    """Whether there are as many inputs as needed: for benchmarks only."""
    select_pins: tuple[Pin, ...] = Field(min_length=1)
    """Digital outputs for the select lines, least significant first."""
    emitter_pin: Pin | None = None
    """Digital output that switches the LEDs; none where they are always on."""
    adc_bits: int = Field(ge=8, le=16)
    """Resolution of the analog-to-digital converter."""
    input_pf: float = Field(ge=0, le=1e4)
    """Capacitance of an analog input."""
    supply_v: float = Field(gt=0, le=5.5)
    """Supply of its inputs, which is also the detectors' supply."""
    hbm_v: float | None = Field(default=None, gt=0, le=1e5)
    """Discharge of the human-body model that its pins bear; none where it is not known (V)."""
    draws_ma: float = Field(default=0.0, ge=0, le=2000)
    """Largest current of the board itself; 0 where it is not known (mA)."""
    plug: Plug | None = None
    """Its pins, if it plugs into sockets."""
    module: Module | None = None
    """Its pads, if it is soldered to the flange's board."""

    @property
    def inputs(self) -> tuple[str, ...]:
        """Analog inputs in the order in which they are used."""
        return tuple(sorted(self.analog_pins, key=self.pulled_up_ohm.__contains__))

    @model_validator(mode="after")
    def _pulled_up_pins_are_inputs(self) -> Self:
        lost = sorted(set(self.pulled_up_ohm) - set(self.analog_pins))
        if lost:
            raise ValueError(f"has {', '.join(lost)} in pulled_up_ohm, missing in analog_pins")
        return self

    @model_validator(mode="after")
    def _pins_differ(self) -> Self:
        switching = () if self.emitter_pin is None else (self.emitter_pin,)
        pins = (*self.analog_pins, *self.select_pins, *switching)
        twice = sorted({pin for pin in pins if pins.count(pin) > 1})
        if twice:
            raise ValueError(f"has {', '.join(twice)} twice; each pin is used once")
        if self.plug is not None:
            there = {*self.plug.rows[0], *self.plug.rows[1]}
            needed = (*pins, self.plug.ground, self.plug.supply, self.plug.regulated)
            lost = sorted(set(needed) - there)
            if lost:
                raise ValueError(f"has {', '.join(lost)}, missing in the rows of its plug")
        if self.module is not None:
            lost = sorted(set(pins) - set(self.module.ports))
            if lost:
                raise ValueError(f"has {', '.join(lost)}, missing in the ports of its module")
            deaf = sorted(set(self.analog_pins) - {*filter(self.module.measures, self.analog_pins)})
            if deaf:
                raise ValueError(
                    f"has {', '.join(deaf)} in analog_pins; analog inputs are only the ports "
                    f"{', '.join(ANALOG_PORTS)}"
                )
        return self
