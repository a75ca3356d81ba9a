"""Where the solder mask is open."""

from lumitip_fab.boards.model import Component

MASK_MM = 0.05
"""Opening round a pad, each side; vias are covered."""


def fiducial_margin_mm(component: Component) -> float:
    """Clear ring round a fiducial, for cameras: half its diameter more; 0 of other parts."""
    if component.kind != "fiducial":
        return 0.0
    return component.footprint.pads[0].width_mm / 2


def opening_mm(component: Component) -> float:
    """How far the mask stays from a part's pads."""
    return fiducial_margin_mm(component) or MASK_MM
