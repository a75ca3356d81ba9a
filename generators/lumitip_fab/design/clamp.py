"""The printed clamp that holds a finger on the stops of its mould, and how hard it presses."""

from dataclasses import dataclass

from lumitip_fab.design.mount import Fastener
from lumitip_fab.design.shape import Box, Point
from lumitip_fab.design.torsion import SHEAR

MARK_MM = 0.4
"""Depth of a mark: a V-groove, twice as high as deep."""
QUARTER_TURN = 0.25
"""Of both nuts, after all feet touch."""
PITCH_MM = 0.5
"""Of an M3 thread, coarse by ISO 261."""


@dataclass(frozen=True)
class Clamp:
    """A flat U with feet and legs. Plan in the sensor frame, alike for both fingers:

        leg ┌─┐        bar         ┌─┐ leg
            └─┼─────┬────────┬─────┼─┘
        rail ││ arm │ foot foot │ arm ││ rail: on the mould, between two legs
        screw◯├─────┤        ├─────┤◯
             ││     │ block  │     ││
            ┌─┼─foot┤        ├foot─┼─┐
        leg └─┘     └        ┘     └─┘ leg

    Feet stand on the plate's back, behind the stops. Legs hang beside the ends of the rails; leg
    and rail end in one plane, and a mark runs across both.
    """

    name: str
    arms: tuple[Box, Box]
    bar: Box
    lugs: tuple[Box, ...]
    """From the arms to legs and screws."""
    legs: tuple[Box, ...]
    feet: tuple[Box, ...]
    """Two behind the pads, then two towards the tip line."""
    rails: tuple[Box, ...]
    """On the mould's outside; their inner sides are within its wall."""
    screws: tuple[Point, Point]
    screw: Fastener
    screw_length_mm: float
    hole_mm: float
    """Of a screw through the clamp."""
    rail_hole_mm: float
    """Of a screw through a rail."""
    head_mm: float
    """Countersink in the rail's underside."""
    thickness_mm: float
    """Of arms, bar and lugs."""
    foot_mm: float
    """Height of the feet."""
    back_mm: float
    """Plate's back over the mould's bed, when the plate is on its stops."""
    rail_mm: float
    """Height of the rails over that bed."""
    mark_mm: float
    """Height of the marks over that bed."""
    leg_end_mm: float
    """Height of the legs' ends over that bed."""
    modulus_mpa: float
    """Of the print."""
    needed_n: float
    """On both pads together, against wires and buoyancy, with the reserve."""

    @property
    def file(self) -> str:
        """Path of its STL below the output folder."""
        return f"mould/{self.name}.stl"

    @property
    def top_mm(self) -> float:
        """Its flat back over the mould's bed, which lies on its own bed when it is printed."""
        return self.back_mm + self.foot_mm + self.thickness_mm

    @property
    def span_mm(self) -> float:
        """From the feet at the pads to those at the tip."""
        return self.feet[2].centre_mm[1] - self.feet[0].centre_mm[1]

    @property
    def pads_share(self) -> float:
        """Of the press, on the feet behind the pads: by the lever."""
        return (self.feet[2].centre_mm[1] - self.screws[0][1]) / self.span_mm

    def pads_n(self, thickness_mm: float) -> float:
        """Press on both pads after a quarter turn of both nuts.

        Beams of an even thickness: each arm between its feet, its lug, its twist, and the bar
        between arm and foot. The plate and the screws give way by next to nothing beside them.
        """
        arm, lug = self.arms[1], self.lugs[-1]
        stiff = self.modulus_mpa * thickness_mm**3 / 12
        middle = (arm.x_min_mm + arm.x_max_mm) / 2
        over = self.screws[1][0] - middle
        ahead, behind = (1 - self.pads_share) * self.span_mm, self.pads_share * self.span_mm
        bent = ahead**2 * behind**2 / (3 * stiff * arm.width_mm * self.span_mm)
        reached = over**3 / (3 * stiff * lug.length_mm)
        twist = self.modulus_mpa * SHEAR * torsion_mm4(arm.width_mm, thickness_mm)
        twisted = over**2 * ahead * behind / (self.span_mm * twist)
        inner = self.feet[3].centre_mm[0]
        reach = middle - inner
        bar = reach**2 * (reach + 3 * inner) / (3 * stiff * self.bar.length_mm)
        carried = (1 - self.pads_share) ** 2 * bar
        each_n = QUARTER_TURN * PITCH_MM / (bent + reached + twisted + carried)
        return 2 * each_n * self.pads_share


def torsion_mm4(width_mm: float, thickness_mm: float) -> float:
    """Torsion constant of a rectangular bar (Roark's Formulas for Stress and Strain, table of
    torsion)."""
    long, short = max(width_mm, thickness_mm), min(width_mm, thickness_mm)
    flat = short / long
    return long * short**3 * (1 / 3 - 0.21 * flat * (1 - flat**4 / 12))
