"""Faults of fingers that acceptance is to find, and which fingers are out of tolerance."""

import numpy as np

from accept_fingers import Fault
from lumitip.acceptance import findings
from lumitip.layout import Layout
from lumitip_fab.tolerance.draws import Draws

KINDS = (
    "none", "open", "dead LED", "short", "bridged", "swapped", "receiver mask", "emitter mask",
    "gap", "silicone",
)  # fmt: skip
"""Half of the fingers have none of them."""
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
    "scatter": (findings.SCATTER, 0.6),
}
"""Faults are drawn evenly from the limit to this, in mm or as a share."""


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
    return Fault(kind, moved=(("scatter", 0, -chance.uniform(*_LIMITS["scatter"])),))


def out_of_tolerance(draws: Draws, finger: int, fault: Fault) -> set[str]:
    """Names of what is out of tolerance in a finger with its fault, by the limits of `verdict`."""
    own = {name: rows[finger].copy() for name, rows in draws.items()}
    for name, entry, value in fault.moved:
        own[name][entry] += value
    shift = own["mask_shift"].reshape(2, 2)
    found = {
        f"{end} mask"
        for number, end in enumerate(("emitter", "receiver"))
        if np.hypot(*shift[number]) > findings.MASK_MM
        or abs(own["mask_turn"][number]) > findings.MASK_DEG
    }
    if abs(own["gap"][0]) > findings.GAP_MM:
        found.add("gap")
    if abs(own["scatter"][0]) > findings.SCATTER:
        found.add("silicone")
    if float(np.abs(own["hole"]).max()) > findings.HOLE_MM:
        found.add("holes")
    return found | ({fault.kind} if fault.cells else set())
