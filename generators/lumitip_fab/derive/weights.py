"""What the fingers' layers weigh."""

from lumitip_fab.design import Densities, Slicing
from lumitip_fab.load import Input

FR4_G_ML = 1.85
"""Glass epoxy laminate, as data sheets of FR-4 have it (1.8 to 1.95)."""


def derive_densities(given: Input, slicing: Slicing) -> Densities:
    """Densities of backing, interface, board, silicone and film."""
    p, parts = given.parameters, given.catalogue
    return Densities(
        backing_g_ml=p.backing.density_g_ml,
        interface_g_ml=slicing.rigid.density_g_ml,
        board_g_ml=FR4_G_ML,
        silicone_g_ml=parts.silicones[p.mould.silicone].density_g_ml,
        film_g_ml=parts.films[p.mask.film].density_g_ml,
    )
