"""Threads that hold the printed parts, and their clearance holes."""

import math

from lumitip_fab.catalogue.materials import Fastener as FastenerEntry
from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.design import Fastener

BOARD_SCREW = "M2"  # of the flange's board
HEAD_PLAY_MM = 0.3  # of a plain head in its counterbore, at least: a knurled one is 0.27 wider


def derive_fasteners(config: Input, faults: Diagnostics) -> tuple[Fastener, ...]:
    """Every thread that is used, once; refused, and nothing derived, where the catalogue does not
    have one or where its bolts do not go through the holes that an entry has for them."""
    p, known = config.parameters, config.catalogue.fasteners
    gripper = config.parts.coupling.gripper
    coupling = config.parts.flange.coupling
    threads = [("coupling.gripper", gripper.bolt)]
    if p.flange.enabled:
        threads += [("flange.coupling", coupling.bolt), ("flange.enabled", BOARD_SCREW)]
    if p.breakout.enabled:
        threads.append(("holder.screw", p.holder.screw))
    for field, thread in threads:
        faults.unless(
            thread in known,
            "thread_unknown",
            field=field,
            thread=thread,
            value=_shown(config, field),
            known=", ".join(known),
        )
    if not all(thread in known for _, thread in threads):
        faults.stop()
    _refuse_hole(config, "coupling.gripper", gripper.bolt, gripper.bolt_hole_mm, faults)
    head = known[gripper.bolt].cap_head_mm + HEAD_PLAY_MM
    faults.unless(
        gripper.counterbore_mm >= head - 1e-9, "counterbore_small", gripper=gripper, head=head
    )
    if p.flange.enabled:
        _refuse_hole(config, "flange.coupling", coupling.bolt, coupling.bolt_hole_mm, faults)
    used = sorted({thread for _, thread in threads})
    return tuple(
        Fastener(
            name,
            e.thread_mm,
            e.hole_mm,
            e.cap_head_mm,
            e.countersunk_mm,
            e.nut_mm,
            e.nut_height_mm,
        )
        for name, e in ((thread, known[thread]) for thread in used)
    )


def screw_length_mm(through_mm: float, nut: FastenerEntry) -> float:
    """The shortest even length that goes through what it holds and through its nut."""
    return 2.0 * math.ceil((through_mm + nut.nut_height_mm) / 2)


def bolt_length_mm(through_mm: float, thread_mm: float) -> float:
    """The shortest even length that goes through a part and 1.5 threads into a gripper, as light
    metals need (a rule of thumb)."""
    return 2.0 * math.ceil((through_mm + 1.5 * thread_mm) / 2)


def _refuse_hole(
    config: Input, field: str, thread: str, hole_mm: float, faults: Diagnostics
) -> None:
    """Refuse a clearance hole of an entry that is none by ISO 273."""
    fine, coarse = config.catalogue.fasteners[thread].hole_mm
    faults.unless(
        fine - 1e-9 <= hole_mm <= coarse + 1e-9,
        "bolt_hole",
        field=field,
        hole_mm=hole_mm,
        thread=thread,
        fine=fine,
        coarse=coarse,
        value=_shown(config, field),
    )


def _shown(config: Input, field: str) -> str:
    """A field's value as the parameter file has it."""
    value = config.value(field)
    return "true" if value is True else repr(value)
