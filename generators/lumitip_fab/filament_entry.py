"""A filament of the catalogue: what the slicer is told about it."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from lumitip_fab.entry import Entry, Name

_Percent = Annotated[int, Field(ge=0, le=100)]


class Filament(Entry):
    """A filament of 1.75 mm."""

    kind: Literal["ABS", "ASA", "FLEX", "PA", "PC", "PET", "PLA", "PP"]
    """What PrusaSlicer calls its kind."""
    density_g_ml: float = Field(ge=0.5, le=3)
    """Density."""
    nozzle_c: int = Field(ge=150, le=450)
    """Temperature of the nozzle (°C)."""
    bed_c: int = Field(ge=0, le=150)
    """Temperature of the bed (°C)."""
    fan_percent: tuple[_Percent, _Percent]
    """Least and most that the fan blows."""
    speed_mm_s: float = Field(ge=5, le=300)
    """Speed of perimeters; outer ones and the first layer go slower."""
    max_flow_mm3_s: float = Field(ge=0.5, le=50)
    """What the nozzle melts."""
    retract_mm: float = Field(ge=0, le=10)
    """How far it is pulled back before a move."""
    layer_mpa: float = Field(gt=0, le=500)
    """Tensile strength from layer to layer."""
    bearing_mpa: float = Field(gt=0, le=500)
    """Compressive strength of a solid print."""
    limit_c: float = Field(ge=30, le=300)
    """Highest temperature at which a printed part keeps its shape (°C): the lower end of its
    heat deflection temperature."""
    rigid_parts: Name | None = None
    """For a filament that bends: the filament of parts that must not, such as moulds."""

    @model_validator(mode="after")
    def _fan_in_order(self) -> Self:
        if self.fan_percent[0] > self.fan_percent[1]:
            raise ValueError(f"fan_percent {self.fan_percent} given, the least comes first")
        return self
