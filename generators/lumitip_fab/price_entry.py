"""What parts cost: `parts/prices.toml`, which a user's own replaces."""

from collections.abc import Mapping
from typing import Annotated

from pydantic import Field

from lumitip_fab.entry import Sourced, Strict

Price = Annotated[float, Field(ge=0, le=1e6)]


class BoardPrice(Strict):
    """One bare board."""

    each: Price
    """Whatever its size."""
    per_cm2: Price
    """By its area."""


class PlacingPrice(Strict):
    """Placing and soldering."""

    each: Price
    """Of one part."""


class Prices(Sourced):
    """What parts cost, in one currency."""

    currency: str = Field(pattern=r"^[A-Z]{3}$")
    """Three letters, such as EUR."""
    dated: str = Field(pattern=r"^\d{4}-\d{2}$")
    """Year and month of the prices."""
    each: Mapping[str, Price]
    """One piece, by name of the entry in another file of `parts/`."""
    board: BoardPrice
    placing: PlacingPrice
    kg: Mapping[str, Price]
    """A kilogram of a filament or a silicone, by its name in the catalogue."""
    sheet: Mapping[str, Price]
    """A sheet of A4 of a film, by its name in the catalogue."""
    wire_m: Price
    """A metre of stranded wire."""
