"""Tolerances of a design: their spreads, and how far its masks may be off if that was computed."""

import hashlib
from collections.abc import Mapping

from lumitip.layout import Layout
from lumitip.twin import Model
from lumitip_fab.config.load import Input
from lumitip_fab.design.encoding import canonical

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


def fingerprint(config: Input, layout: Layout) -> str:
    """Identifies what a study of tolerances depends on: cells, optics, backing and tolerances."""
    kinds = {name: entry.distribution for name, entry in config.catalogue.tolerances}
    places, model = (layout.x_mm.tolist(), layout.y_mm.tolist()), Model.from_layout(layout)
    inputs = [places, model, config.parameters.backing.variant, spreads(config), kinds]
    return hashlib.sha256(canonical(inputs).encode()).hexdigest()[:_LENGTH]


def known_mask_shift_mm(config: Input, layout: Layout) -> float | None:
    """How far each mask may be off (mm); none of a design that it was not computed for."""
    return config.catalogue.mask_shifts.each.get(fingerprint(config, layout))
