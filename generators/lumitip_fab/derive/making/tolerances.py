"""Tolerances of a design: their spreads, and how far its masks may be off if that was computed."""

import hashlib
from collections.abc import Mapping

from lumitip.layout import Layout
from lumitip.twin import Model
from lumitip_fab.catalogue.tolerances import MaskConditions
from lumitip_fab.config.load import Input
from lumitip_fab.design.encoding import canonical
from lumitip_fab.design.making import MaskShift

MODEL_VERSION = 3
"""Version of the model of built fingers and their estimates. Increase it with every change of
`lumitip_fab.tolerance` that moves figures: it makes the stored shifts of masks invalid."""
_LENGTH = 12


def spreads(config: Input) -> Mapping[str, float]:
    """Spread of each tolerance for a design, in mm, degrees or shares."""
    p, printer = config.parameters, config.parts.printer.profile
    lengths = {
        "": 1.0,
        "line": printer.line_mm,
        "layer": printer.layer_mm,
        "pin": min(p.backing.pin_clearance_mm, p.backing.pocket_clearance_mm),
    }
    return {name: entry.spread * lengths[entry.of] for name, entry in config.catalogue.tolerances}


def fingerprint(config: Input, layout: Layout, conditions: MaskConditions) -> str:
    """Identifies what the largest shift of the masks depends on.

    Args:
        config: for backing and tolerances.
        layout: for cells and optics.
        conditions: goals, gap, poses, fingers and seed.

    Returns:
        12 hexadecimal digits, which `MODEL_VERSION` changes as well.
    """
    kinds = {name: entry.distribution for name, entry in config.catalogue.tolerances}
    places = (layout.x_mm.tolist(), layout.y_mm.tolist())
    own = layout.hole_mm.tolist() if (layout.hole_share != 1.0).any() else ()
    model = Model.from_layout(layout, conditions.gap_mm)
    inputs = [
        MODEL_VERSION,
        conditions,
        places,
        model,
        config.parameters.backing.variant,
        spreads(config),
        kinds,
        *own,
    ]
    return hashlib.sha256(canonical(inputs).encode()).hexdigest()[:_LENGTH]


def known_mask_shift(config: Input, layout: Layout) -> MaskShift | None:
    """How far both masks may be off; none of a design that it was not computed for."""
    stored = config.catalogue.mask_shifts
    most_mm = stored.each.get(fingerprint(config, layout, stored.conditions))
    if most_mm is None:
        return None
    conditions = stored.conditions
    return MaskShift(most_mm, conditions.good_percent, conditions.position_mm, conditions.angle_deg)
