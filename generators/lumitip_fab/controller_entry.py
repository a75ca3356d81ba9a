"""Catalogue entries of microcontrollers: boards that plug into sockets, and modules."""

from typing import Annotated, Self

from pydantic import Field, model_validator

from lumitip_fab.carrier_entry import Plug
from lumitip_fab.entry import Capacitances, Entry, Length, Offset, Pin, Strict

ANALOG_PORTS = ("P0_02", "P0_03", "P0_04", "P0_05", "P0_28", "P0_29", "P0_30", "P0_31")
"""AIN0 to AIN7 of the nRF52840, by its product specification."""
_SINGLE = ("VDD", "VDDH", "VBUS", "USB_DM", "USB_DP", "SWDIO", "SWDCLK", "P0_18")
"""Pads that are joined by their names; P0.18 is the reset."""


class Module(Strict):
    """A module with Nordic's nRF52840 and an antenna, soldered to the flange's board.

    Places are in mm from the middle of its body, seen from above with the antenna at the top.
    """

    manufacturer: str = Field(min_length=1, max_length=64)
    """Who makes it, for the bill of materials."""
    order_number: str = Field(min_length=1, max_length=64)
    """What to order."""
    lcsc: str = Field(default="", pattern=r"^(C[1-9]\d*)?$")
    """Number at the distributor LCSC; empty where it is not known."""
    body_mm: tuple[Length, Length, Length]
    """Body: across, along, height above the board."""
    bypass_nf: Capacitances
    """Least and greatest capacitance beside its supply."""
    crystal: tuple[Pin, Pin]
    """Ports of the crystal of 32.768 kHz."""
    keep_out_mm: tuple[tuple[Offset, Offset, Offset, Offset], ...]
    """Rectangles under the antenna without copper on either side: left, low, right, high."""
    names: Annotated[tuple[Pin, ...], Field(min_length=8, max_length=128)]
    """Name of each pad from pad 1: ports such as `P0_04`, `GND`, `VDD`, `VDDH`, `VBUS`, `USB_DM`,
    `USB_DP`, `SWDIO`, `SWDCLK`."""
    pads_mm: tuple[tuple[Offset, Offset, Length, Length], ...]
    """Of each pad its middle, width and height."""
    ports: dict[Pin, Pin]
    """Port of each pin that the firmware's board definition has: `A0 = "P0_04"`."""

    def measures(self, pin: str) -> bool:
        """Whether a pin is an analog input."""
        return self.ports[pin] in ANALOG_PORTS

    @model_validator(mode="after")
    def _pads_exist(self) -> Self:
        if len(self.names) != len(self.pads_mm):
            raise ValueError(
                f"{len(self.names)} names and {len(self.pads_mm)} places of pads given, each pad "
                "needs both"
            )
        ports = (*self.crystal, *self.ports.values())
        for name in (*_SINGLE, *ports):
            if self.names.count(name) != 1:
                raise ValueError(f"{self.names.count(name)} pads named {name} given, 1 is needed")
        twice = sorted({port for port in ports if ports.count(port) > 1})
        if twice:
            raise ValueError(f"{', '.join(twice)} given twice, each port is used once")
        if "GND" not in self.names:
            raise ValueError("no pad named GND given, at least one is needed")
        return self


class Controller(Entry):
    """A microcontroller that reads the multiplexers: a board, or a module on the flange's board."""

    analog_pins: tuple[Pin, ...] = Field(min_length=1)
    """Analog inputs in the order in which they are used."""
    unlimited_analog_pins: bool = False
    """Whether further inputs are invented as needed: for benchmarks only."""
    select_pins: tuple[Pin, ...] = Field(min_length=1)
    """Digital outputs for the select lines, least significant first."""
    adc_bits: int = Field(ge=8, le=16)
    """Resolution of the analog-to-digital converter."""
    input_pf: float = Field(ge=0, le=1e4)
    """Capacitance of an analog input with the wire to it."""
    supply_v: float = Field(gt=0, le=5.5)
    """Supply of its inputs, which is also the detectors' supply."""
    draws_ma: float = Field(default=0.0, ge=0, le=2000)
    """Largest current of the board itself; 0 where it is not known (mA)."""
    plug: Plug | None = None
    """How it stands on sockets, if it does."""
    module: Module | None = None
    """How it is soldered to the flange's board, if it is."""

    @model_validator(mode="after")
    def _pins_differ(self) -> Self:
        pins = (*self.analog_pins, *self.select_pins)
        twice = sorted({pin for pin in pins if pins.count(pin) > 1})
        if twice:
            raise ValueError(f"{', '.join(twice)} given twice, each pin is used once")
        if self.plug is not None:
            there = {*self.plug.rows[0], *self.plug.rows[1]}
            wanted = (*pins, self.plug.ground, self.plug.supply, self.plug.regulated)
            lost = sorted(set(wanted) - there)
            if lost:
                raise ValueError(f"{', '.join(lost)} given, which no row of its plug has")
        if self.module is not None:
            lost = sorted(set(pins) - set(self.module.ports))
            if lost:
                raise ValueError(f"{', '.join(lost)} given, for which its module has no port")
            deaf = sorted(set(self.analog_pins) - {*filter(self.module.measures, self.analog_pins)})
            if deaf:
                raise ValueError(
                    f"{', '.join(deaf)} given as analog, only the ports {', '.join(ANALOG_PORTS)} "
                    "measure voltages"
                )
        return self
