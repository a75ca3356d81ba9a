"""What the masses of fingers and boards come from."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Densities:
    """Densities of a finger's layers and parts, and of the boards."""

    backing_g_ml: float
    interface_g_ml: float
    """Of what holds a bendable backing."""
    board_g_ml: float
    """Of the fingers' boards, copper included."""
    carrier_g_ml: float
    """Of the boards outside the fingers."""
    part_g_ml: float
    """Of the small parts on the fingers' boards: moulded or ceramic, as heavy as the laminate of
    a rigid one for their size (assumed)."""
    silicone_g_ml: float
    film_g_ml: float
