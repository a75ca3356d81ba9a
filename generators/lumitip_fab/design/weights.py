"""What a finger's mass comes from."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Densities:
    """Densities of a finger's layers."""

    backing_g_ml: float
    interface_g_ml: float
    """Of what holds a bendable backing."""
    board_g_ml: float
    """Of the laminate; the small parts on it weigh about the same for their size."""
    silicone_g_ml: float
    film_g_ml: float
