"""Catalogue entries of diodes that clamp a voltage: at a supply, and at the wires that leave a
board."""

from typing import Self

from pydantic import Field, model_validator

from lumitip_fab.catalogue.electronics import Chip
from lumitip_fab.catalogue.record import Voltages

_RATED_AT_C = 25.0


class TvsDiode(Chip):
    """A unidirectional TVS diode: terminal 1 is its cathode."""

    standoff_v: float = Field(gt=0, le=1000)
    """Voltage up to which it carries no more than a leakage current."""
    breakdown_v: Voltages
    """Least and greatest breakdown voltage at 25 °C."""
    breakdown_per_k: float = Field(default=1e-3, ge=0, le=5e-3)
    """Rise of the breakdown voltage for each kelvin, as a fraction of it. The default is assumed:
    the most that silicon above 10 V has, by figures of several makers' series."""
    clamping_v: float = Field(gt=0, le=1000)
    """Largest voltage at `pulse_a`."""
    pulse_a: float = Field(gt=0, le=1e4)
    """Largest peak current of a pulse of 10/1000 µs."""

    def conducts_v(self, at_c: float) -> float:
        """Least voltage at which it conducts at a temperature (°C)."""
        return self.breakdown_v[0] * (1 + self.breakdown_per_k * (at_c - _RATED_AT_C))

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
