"""Catalogue entries of what carriers hold: sockets, how a controller plugs into them, power."""

from typing import Annotated, Self

from pydantic import Field, model_validator

from lumitip_fab.entry import Capacitances, Entry, Length, Share, Strict, Voltages

Signal = Annotated[str, Field(pattern=r"^[A-Za-z0-9_+\-]{1,12}$")]
OPEN = "NC"
"""Signal of a contact that is joined to nothing."""
PinName = Annotated[str, Field(pattern=r"^[A-Z0-9]{1,6}$")]


class Strip(Entry):
    """One or two rows of contacts in plated holes."""

    manufacturer: str = Field(min_length=1, max_length=64)
    """Who makes it, for the bill of materials; "any" where it does not matter."""
    order_number: str = Field(min_length=1, max_length=64)
    """What to order."""
    lcsc: str = Field(default="", pattern=r"^(C[1-9]\d*)?$")
    """Number at the distributor LCSC; empty where it is not known."""
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
    """How far spring contacts give; 0 of others."""


class Plug(Strict):
    """How a controller board stands on two socket strips, its USB plug to the left.

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
    regulated: PinName
    """Pin that feeds the receiver."""


class Leaded(Entry):
    """A small part with gull-wing leads in two rows, lead 1 at the lower left."""

    manufacturer: str = Field(min_length=1, max_length=64)
    """Who makes it, for the bill of materials."""
    order_number: str = Field(min_length=1, max_length=64)
    """What to order."""
    lcsc: str = Field(default="", pattern=r"^(C[1-9]\d*)?$")
    """Number at the distributor LCSC; empty where it is not known."""
    body_mm: tuple[Length, Length, Length]
    """Body: along the rows of leads, across them, height above the board."""
    lead_span_mm: Length
    """Outer ends of the pads of the two rows."""
    lead_pitch_mm: Length
    """Distance between neighbouring leads of the lower row."""
    lead_pad_mm: tuple[Length, Length]
    """Pad of one lead: along the lead, across it."""
    names: tuple[PinName, ...] = Field(min_length=3, max_length=16)
    """Name of each lead, counter-clockwise from lead 1; of an odd number the upper row has one
    less, in its middle."""


class Regulator(Leaded):
    """A step-down switching regulator with a fixed output: FB, EN, VIN, GND, SW and BST."""

    output_v: float = Field(gt=0, le=24)
    """Output voltage."""
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
            raise ValueError(f"leads {', '.join(self.names)} given, FB, EN, VIN, GND, SW and BST "
                             "are needed")  # fmt: skip
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
            raise ValueError(f"leads {', '.join(self.names)} given, GND, OUT and IN are needed")
        return self


class Transistor(Leaded):
    """A P-channel MOSFET: G, S and D."""

    rated_v: float = Field(gt=0, le=1000)
    """Largest voltage from source to drain."""
    gate_v: float = Field(gt=0, le=100)
    """Largest voltage from source to gate."""
    gate_on_v: float = Field(gt=0, le=100)
    """Voltage from source to gate at which it is on for certain."""

    @model_validator(mode="after")
    def _has_its_leads(self) -> Self:
        if set(self.names) != {"G", "S", "D"}:
            raise ValueError(f"leads {', '.join(self.names)} given, G, S and D are needed")
        return self
