"""Catalogue entries of diodes that clamp a voltage: at a supply, and at the wires that leave a
board."""

from typing import Self

from pydantic import Field, model_validator

from lumitip_fab.catalogue.electronics import Chip
from lumitip_fab.catalogue.record import Voltages


class TvsDiode(Chip):
    """A unidirectional TVS diode: terminal 1 is its cathode."""

    standoff_v: float = Field(gt=0, le=1000)
    """Voltage up to which it carries no more than a leakage current."""
    breakdown_v: Voltages
    """Least and greatest breakdown voltage."""
    clamping_v: float = Field(gt=0, le=1000)
    """Largest voltage at `pulse_a`."""
    pulse_a: float = Field(gt=0, le=1e4)
    """Largest peak current of a pulse of 10/1000 µs."""

    @property
    def dynamic_ohm(self) -> float:
        """Dynamic resistance from breakdown to clamping."""
        return (self.clamping_v - self.breakdown_v[1]) / self.pulse_a

    @model_validator(mode="after")
    def _in_order(self) -> Self:
        if not self.standoff_v < self.breakdown_v[0] <= self.breakdown_v[1] < self.clamping_v:
            raise ValueError(
                f"standoff_v, breakdown_v and clamping_v are {self.standoff_v:g}, "
                f"{self.breakdown_v[0]:g} to {self.breakdown_v[1]:g} and {self.clamping_v:g}; each "
                "must be higher than the one before it"
            )
        return self


class EsdDiode(TvsDiode):
    """A TVS diode with a small capacitance, for a signal."""

    pulse_a: float = Field(gt=0, le=1e4)
    """Largest peak current of a pulse of 8/20 µs."""
    capacitance_pf: float = Field(gt=0, le=1000)
    """Largest capacitance without voltage."""
