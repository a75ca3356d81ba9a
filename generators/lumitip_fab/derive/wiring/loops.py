"""The moving part of each finger's cable: its bend radius, and the length that keeps it large."""

from dataclasses import dataclass, replace
from itertools import count

from lumitip_fab.derive.wiring.bending import smallest_radius
from lumitip_fab.design.cabling import Cable, Loop, outer_mm

BEND_RATIO = 8.0
"""Least bend radius of a moving wire by its outer diameter. Assumed: a table of cables up to 8 mm
thick has 5 for free movement, 9 under load and 10 over pulleys (kunshan-nichigoh.com, Bending
Radius). A bundle is loose, so that its wires bend one by one."""


@dataclass(frozen=True)
class Way:
    """The way of a cable from a finger."""

    reach_mm: float
    """On the finger."""
    travel_mm: float
    run_mm: float
    """Along the gripper, to where it is held."""

    @property
    def length_mm(self) -> float:
        """All of it."""
        return self.reach_mm + self.travel_mm + self.run_mm


def loop_of(cable: Cable, way: Way) -> Loop:
    """The moving part of a cable."""
    free_mm = cable.length_mm - way.reach_mm
    radius, at = smallest_radius(way.run_mm, way.travel_mm, free_mm)
    outer = outer_mm(cable.section_mm2)
    return Loop(cable.name, way.run_mm, free_mm, radius, at, outer, BEND_RATIO * outer)


def with_room(cable: Cable, way: Way, step_mm: float) -> Cable:
    """The cable, longer by whole steps until no bend is too tight: a loop grows with its length."""
    lengths = (step_mm * i for i in count())
    longer = (
        replace(cable, length_mm=cable.length_mm + more, added_mm=cable.added_mm + more)
        for more in lengths
    )
    return next(each for each in longer if _is_wide(loop_of(each, way)))


def _is_wide(loop: Loop) -> bool:
    return loop.radius_mm >= loop.least_mm
