"""Faults of fingers that acceptance is to find, and which fingers are out of tolerance."""

import numpy as np

from accept_fingers import Fault
from lumitip.acceptance import findings
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Model
from lumitip_fab.tolerance.draws import Draws

KINDS = (
    "none", "open", "dead LED", "short", "bridged", "swapped", "receiver mask", "emitter mask",
    "gap", "silicone", "milky", "thickness",
)  # fmt: skip
"""Half of the fingers have none of them."""
NAMES = (
    *KINDS[1:6], "receiver mask", "emitter mask", "gap", "silicone", "receiver thickness",
    "emitter thickness", "holes",
)  # fmt: skip
"""Names of what may be out of tolerance."""
NAMED = {
    "open": {"dark", "weak"},
    "dead LED": {"dark", "weak"},
    "short": {"saturated"},
    "bridged": {"odd", "swapped"},
}
"""Findings that name a fault rightly, where they have another name."""
_LIMITS = {
    "mask": (findings.MASK_MM, 1.8),
    "turn": (findings.MASK_DEG, 5.0),
    "gap": (findings.GAP_MM, 1.2),
    "clear": (findings.SCATTER[0], 0.6),
    "milky": (findings.SCATTER[1], 0.6),
    "thickness": (findings.THICK_MM, 0.6),
}
"""Faults are drawn evenly from the limit to this, in mm or as a share; not more than all light is
scattered."""


def drawn(layout: Layout, chance: np.random.Generator, share: float = 0.5) -> Fault:
    """A random fault, or with a probability of 1 - `share` none."""
    if chance.random() > share:
        return Fault()
    kind = str(chance.choice(KINDS[1:]))
    if kind in ("open", "dead LED", "short"):
        return Fault(kind, (int(chance.integers(len(layout))),))
    if kind in ("swapped", "bridged"):
        one, two = chance.choice(len(layout), 2, replace=False)
        return Fault(kind, (int(one), int(two)))
    if kind.endswith("mask"):
        way, size = chance.uniform(0.0, 2.0 * np.pi), chance.uniform(*_LIMITS["mask"])
        first = 0 if kind == "emitter mask" else 2
        if chance.random() < 0.25:
            turn = chance.choice([-1.0, 1.0]) * chance.uniform(*_LIMITS["turn"])
            return Fault(kind, moved=(("mask_turn", first // 2, turn),))
        return Fault(kind, moved=(("mask_shift", first, size * np.cos(way)),
                                  ("mask_shift", first + 1, size * np.sin(way))))  # fmt: skip
    if kind == "gap":
        way = chance.choice([-1.0, 1.0])
        return Fault(kind, moved=(("gap", 0, way * chance.uniform(*_LIMITS["gap"])),))
    if kind == "thickness":
        way = chance.choice([-1.0, 1.0])
        finger = int(chance.integers(2))
        return Fault(kind, moved=(("silicone", finger, way * chance.uniform(*_LIMITS[kind])),))
    if kind == "milky":
        return Fault(kind, moved=(("scatter", 0, chance.uniform(*_LIMITS[kind])),))
    return Fault(kind, moved=(("scatter", 0, -chance.uniform(*_LIMITS["clear"])),))


def true_deviations(draws: Draws, finger: int, fault: Fault) -> dict[str, Floats]:
    """Deviations of a finger with its fault, by name."""
    own = {name: rows[finger].copy() for name, rows in draws.items()}
    for name, entry, value in fault.moved:
        own[name][entry] += value
    # No more than all light is scattered, and no less than none.
    own["scatter"] = own["scatter"].clip(-Model.alpha, 1.0 - Model.alpha)
    return own


def out_of_tolerance(own: dict[str, Floats], fault: Fault, good_scatter: float = 0.0) -> set[str]:
    """Names of what is out of tolerance in a finger with its fault, by the limits of `verdict`.

    Args:
        own: true deviations of the finger.
        fault: its fault.
        good_scatter: mean true deviation of the scattered share of good fingers.
    """
    shift = own["mask_shift"].reshape(2, 2)
    found = {
        f"{end} mask"
        for number, end in enumerate(("emitter", "receiver"))
        if np.hypot(*shift[number]) > findings.MASK_MM
        or abs(own["mask_turn"][number]) > findings.MASK_DEG
    }
    if abs(own["gap"][0]) > findings.GAP_MM:
        found.add("gap")
    less, more = findings.SCATTER
    if not -less <= own["scatter"][0] - good_scatter <= more:
        found.add("silicone")
    for number, end in enumerate(("emitter", "receiver")):
        if abs(own["silicone"][number]) > findings.THICK_MM:
            found.add(f"{end} thickness")
    if float(np.abs(own["hole"]).max()) > findings.HOLE_MM:
        found.add("holes")
    return found | ({fault.kind} if fault.cells else set())
