"""What the fingers' layers and the boards weigh."""

from lumitip_fab.derive.flex import is_flex, stiff_mm
from lumitip_fab.design import Densities, Slicing
from lumitip_fab.laminate_entry import Laminate
from lumitip_fab.load import Input

COPPER_G_ML = 8.96  # the element's, at 20 °C
POURED = 0.7
"""Share of both sides that copper covers: of the published receiver's board file, where the ground
pour alone covers 69 %."""


def derive_densities(given: Input, slicing: Slicing) -> Densities:
    """Densities of backing, interface, boards, the parts on them, silicone and film."""
    p, parts = given.parameters, given.catalogue
    rigid, flexible = parts.laminates.rigid, parts.laminates.flexible
    return Densities(
        backing_g_ml=p.backing.density_g_ml,
        interface_g_ml=slicing.rigid.density_g_ml,
        board_g_ml=_clad_g_ml(flexible if is_flex(p) else rigid, p.stack.pcb_mm),
        carrier_g_ml=_clad_g_ml(rigid, stiff_mm(p)),
        part_g_ml=rigid.density_g_ml,
        silicone_g_ml=parts.silicones[p.mould.silicone].density_g_ml,
        film_g_ml=parts.films[p.mask.film].density_g_ml,
    )


def _clad_g_ml(laminate: Laminate, thick_mm: float) -> float:
    """Of a board with copper on both sides, by its thickness in all."""
    share = POURED * 2 * laminate.copper_mm / thick_mm
    return (1 - share) * laminate.density_g_ml + share * COPPER_G_ML
