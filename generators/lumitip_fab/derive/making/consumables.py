"""How much a pair of fingers uses of what cleans, protects, mixes and joins. The amounts for one
use are assumed."""

from collections.abc import Iterator

import numpy as np

from lumitip_fab.config.load import Input
from lumitip_fab.derive.making.supplies import Assembled, Used

FINGERS = 2
WIPE_ML = 5.0
"""Of isopropanol, for a wipe of one finger, mould or film."""
GLOVED = ("gluing", "priming", "casting", "wrapping")
"""Work that is done in gloves, a pair for each."""
SOLDER_G = 5.0
"""Of solder, for the wires and for parts that the PCB fab did not place."""
BOND_MM, ADHESIVE_MM = 5.0, 0.2
"""Width and thickness of the adhesive at the ends of a mask's flaps."""


def derive_consumables(config: Input, of: Assembled) -> tuple[Used, ...]:
    """All of them, in the order of their first use."""
    return tuple(_consumed(config, of))


def _consumed(config: Input, of: Assembled) -> Iterator[Used]:
    p, primed = config.parameters, config.parts.mould.primer is not None
    inserts = len(of.inserts)
    yield Used("solder", "wires, and parts that are not placed", SOLDER_G, "g")
    if any(board.module for board in of.auxiliary_boards):
        yield Used("flux pen", "pads under the module", 1, "piece")
    # The place of the glue, mould, plate and board before primer or casting, and a smooth film.
    wipes = FINGERS * (3 + inserts)
    yield Used("isopropanol", "cleaning before glue and silicone", wipes * WIPE_ML, "mL")
    yield Used("lint-free cloth", "cleaning before glue and silicone", wipes, "sheet")
    yield Used("sandpaper", "roughening before glue", 1, "sheet")
    gloved = [work for work in GLOVED if primed or work != "priming"]
    yield Used("nitrile gloves", ", ".join(gloved), 2 * len(gloved), "piece")
    yield Used("clean cup", "mixing silicone, and a drop of the trial", FINGERS + 2, "piece")
    sticks = 2 + FINGERS + bool(of.keys)
    yield Used("wooden stick", "spreading glue, mixing silicone", sticks, "piece")
    yield Used("fine brush", "primer and silicone" if primed else "silicone", 1 + primed, "piece")
    yield Used("plain paper", *_paper(p.mask.route, inserts), "sheet")
    blades = 1 + (p.mask.route == "film") + bool(inserts)
    yield Used("knife blade", "films, and flash on the skin", blades, "piece")
    bonded_mm3 = FINGERS * _perimeter_mm(of) * BOND_MM * ADHESIVE_MM
    where = "flaps of both masks, where no double-sided tape is used"
    yield Used("silicone adhesive", where, round(bonded_mm3 / 1000, 2), "mL")


def _paper(route: str, inserts: int) -> tuple[str, int]:
    """Under both moulds, for true prints and carriers of the film, and a trial of the plotter."""
    uses = {"under both moulds": FINGERS}
    if route == "film":
        uses["true prints and carriers of the film"] = 2 * FINGERS
    if route == "cut":
        uses["a trial of the plotter"] = 1
    if inserts:
        uses["drawing of the smooth film"] = 1
    return ", ".join(uses), sum(uses.values())


def _perimeter_mm(of: Assembled) -> float:
    corners = of.outline.polygon()
    return float(np.hypot(*(np.roll(corners, -1, axis=0) - corners).T).sum())
