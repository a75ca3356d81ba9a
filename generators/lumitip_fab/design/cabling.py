"""The wires between the boards, from the fingers to the supply."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Terminal:
    """Where a wire ends."""

    board: str
    """`"emitter"`, `"receiver"`, a carrier such as `"breakout"`, `"controller"` or `"supply"`."""
    connector: str
    """Such as `"J1"`; empty where a board has single pins."""
    pin: str
    """Number of the pad, or name of the pin."""
    name: str
    """What is printed there."""
    order: int
    """Its place among the pins of that connector, from 1."""

    @property
    def label(self) -> str:
        """Such as `"J1.3"`, or the pin alone."""
        return f"{self.connector}.{self.pin}" if self.connector else self.pin


@dataclass(frozen=True)
class Wire:
    """A wire with both its ends."""

    number: str
    """Unique, such as `"W2.3"`: the third wire of the second cable."""
    signal: str
    """Its net."""
    start: Terminal
    end: Terminal
    colour: str
    """Codes of IEC 60757, such as `"GN"` or `"WHGN"`."""
    current_ma: float
    """Largest; 0 of signals."""


@dataclass(frozen=True)
class Cable:
    """Wires that run together."""

    name: str
    least_mm: float
    """What its way and the slack make together."""
    length_mm: float
    """To cut each wire to."""
    section_mm2: float
    """Copper of each wire."""
    wires: tuple[Wire, ...]

    @property
    def start(self) -> Terminal:
        """One end of its first wire."""
        return self.wires[0].start

    @property
    def end(self) -> Terminal:
        """The other end of its first wire."""
        return self.wires[0].end


@dataclass(frozen=True)
class Cabling:
    """All cables, and what their lengths are made of."""

    cables: tuple[Cable, ...]
    travel_mm: float
    """Of a finger, from closed to open."""
    supply_mm: float
    """Way to the supply: from the controller's breakout, or from the fingers where it has none."""
    controller_mm: float
    """From the fingers' gripper end to the controller."""
    slack_mm: float
