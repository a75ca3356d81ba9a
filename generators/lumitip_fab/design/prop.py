"""The prop under the gripper end of a mould, by which the silicone stands higher at the tip."""

import math
from dataclasses import dataclass
from typing import overload

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.design.shape import Box


@dataclass(frozen=True)
class Prop:
    """A strip with a stop, alike for both fingers. Side view, the mould open side up:

            weir                            tip
        ──╮      ╭ ─ ─ ─ level ─ ─ ─ ─ ─ ─ ─ ─ ─ ╮
        │ ╰──────╯                               │
        ├────────────────────────────────────────┘ bed of the mould
      ┌─┤─────┐
      └───────┘ prop

    Surplus leaves over the weir, whose height is that of the rim plane: so the tilt sets how high
    the silicone stands at the tip. In the narrow gap round the plate it creeps higher.
    """

    name: str
    plate: Box
    """Under the mould, in the sensor frame."""
    height_mm: float
    """Of the plate."""
    stop: Box
    """Behind the mould's end."""
    stop_mm: float
    """Height of the stop over the plate."""
    tilt_deg: float
    """Of a mould that lies on its foot at the tip and on the plate's inner edge."""
    lip_mm: float
    """Silicone on the back of the plate where its edge is set back, at least."""
    weir_y_mm: float
    """Where the surplus leaves: the outer edge of the weir."""

    @property
    def file(self) -> str:
        """Path of its STL below the output folder."""
        return f"mould/{self.name}.stl"

    @property
    def slope(self) -> float:
        """Of the level to the mould."""
        return math.tan(math.radians(self.tilt_deg))

    @overload
    def level_mm(self, y_mm: float) -> float: ...

    @overload
    def level_mm(self, y_mm: NDArray[np.float64]) -> NDArray[np.float64]: ...

    def level_mm(self, y_mm: float | NDArray[np.float64]) -> float | NDArray[np.float64]:
        """Height of the silicone over the rim plane, at one or several y of the sensor frame. That
        of a liquid at rest: what it creeps up the wall is not in it."""
        return (y_mm - self.weir_y_mm) * self.slope
