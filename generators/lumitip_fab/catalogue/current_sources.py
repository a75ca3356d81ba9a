"""Catalogue entries of the current sources of LED strings."""

from typing import Self

from pydantic import Field, model_validator

from lumitip_fab.catalogue.controllers import OPEN, Leaded
from lumitip_fab.catalogue.record import Currents


class CurrentSource(Leaded):
    """A programmable current source with two terminals, IN and OUT: its OUT follows its SET, out of
    which a reference current flows, so that a resistor at each of the two sets the current."""

    set_ua: float = Field(gt=0, le=1000)
    """Reference current out of SET."""
    set_tolerance: float = Field(ge=0, le=0.2)
    """Fraction by which that of a part may be off at 25 °C, either way."""
    set_drift: float = Field(ge=0, le=0.2)
    """Fraction by which that of one part changes with the temperature of its chip, either way."""
    line_per_v: float = Field(ge=0, le=0.1)
    """Fraction by which the current of one part changes for each volt from IN to OUT."""
    offset_mv: float = Field(ge=0, le=50)
    """Largest voltage from SET to OUT, either way."""
    dropout_v: float = Field(gt=0, le=20)
    """Voltage from IN to OUT that it needs."""
    range_ma: Currents
    """Least and greatest current."""
    rated_v: float = Field(gt=0, le=1000)
    """Largest voltage from IN to OUT."""
    junction_c: float = Field(gt=60, le=200)
    """Highest temperature of the chip."""
    thermal_k_per_w: float = Field(gt=0, le=1000)
    """Thermal resistance from chip to air on a board with little copper."""

    def rated_w(self, ambient_c: float) -> float:
        """Power with which the chip reaches its highest temperature."""
        return (self.junction_c - ambient_c) / self.thermal_k_per_w

    @model_validator(mode="after")
    def _has_its_leads(self) -> Self:
        if set(self.names) - {OPEN} != {"IN", "OUT", "SET"} or self.names.count("SET") != 1:
            raise ValueError(
                f"names are {', '.join(self.names)}; IN, OUT and one SET are needed, and NC for "
                "leads that are left open"
            )
        return self
