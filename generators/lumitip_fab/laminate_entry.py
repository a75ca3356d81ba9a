"""What boards are made of: `parts/laminates.toml`."""

from pydantic import Field

from lumitip_fab.entry import Length, Sourced, Strict


class Laminate(Sourced):
    """Core and copper of a board with two layers."""

    density_g_ml: float = Field(ge=0.5, le=5)
    """Density without copper."""
    copper_mm: Length
    """Thickness of the copper on each side."""
    limit_c: float = Field(ge=60, le=400)
    """Highest temperature that it bears for hours: its glass transition, or its adhesive's (°C)."""
    solder_c: float = Field(ge=100, le=400)
    """Highest temperature that it bears for the seconds of soldering (°C)."""


class Laminates(Strict):
    """One for each kind of board."""

    rigid: Laminate
    flexible: Laminate
