"""Catalogue entries of diodes that let a current through one way."""

import math
from typing import Self

from pydantic import Field, model_validator

from lumitip_fab.catalogue.electronics import Chip
from lumitip_fab.catalogue.record import Voltages


class SchottkyDiode(Chip):
    """A Schottky diode: terminal 1 is its cathode."""

    rated_v: float = Field(gt=0, le=1000)
    """Largest reverse voltage."""
    rated_ma: float = Field(gt=0, le=1e5)
    """Largest continuous forward current."""
    small_ma: float = Field(gt=0, le=1e5)
    """A smaller current, at which its forward voltage is known, too."""
    forward_v: Voltages
    """Largest forward voltage at `small_ma`, and at `rated_ma`, at 25 °C."""

    def drop_v(self, ma: float) -> float:
        """Largest forward voltage at a current: straight over the logarithm of the current from
        `small_ma` on, and not less below it."""
        low_v, high_v = self.forward_v
        share = math.log(max(ma / self.small_ma, 1.0)) / math.log(self.rated_ma / self.small_ma)
        return low_v + (high_v - low_v) * share

    @model_validator(mode="after")
    def _smaller_is_smaller(self) -> Self:
        if self.small_ma >= self.rated_ma:
            raise ValueError(
                f"small_ma is {self.small_ma:g}; less than rated_ma, {self.rated_ma:g}, is needed"
            )
        return self
