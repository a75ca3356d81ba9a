"""The gauge card: the printed card between both fingers by which a finished pair is accepted."""

from dataclasses import dataclass, replace
from typing import Literal

from lumitip_fab.design.shape import Box

Hugged = Literal["receiver", "emitter"]
NAME = "gauge_card"


@dataclass(frozen=True)
class Target:
    """A straight edge or strip in the gap, in the receiver's sensor frame.

    It is an edge of a sheet that covers everything right of the line, or a strip along the line.
    """

    name: str
    on: Hugged
    """The finger between the rails."""
    kind: Literal["edge", "strip"]
    offset_mm: float
    """Signed distance of the line from the origin, along its left normal (-sin, cos)."""
    angle_deg: float
    """Direction of the line."""
    width_mm: float
    """Of a strip; 0 of an edge."""
    low_mm: float
    """Height over the receiver's skin, from `low_mm` to `high_mm`."""
    high_mm: float

    def turned(self, gap_mm: float) -> "Target":
        """The same end on the other finger: half a turn about y, so x and height are mirrored."""
        edge = self.kind == "edge"
        # A strip has no side: its direction is from 0 to 180 degrees, which turns its normal.
        return replace(
            self,
            name=f"{self.kind} on the emitter",
            on="emitter",
            offset_mm=self.offset_mm if edge else 0.0 - self.offset_mm,
            angle_deg=-self.angle_deg if edge else 180.0 - self.angle_deg,
            low_mm=round(gap_mm - self.high_mm, 6),
            high_mm=round(gap_mm - self.low_mm, 6),
        )


@dataclass(frozen=True)
class GaugeCard:
    """A flat card with two ends. End E has an edge, end S, which is end E turned by half a turn
    about z, a strip. Plan of end E in the sensor frame of the finger that it hugs, side view:

        ═══════╤══╧══╤═══════  stop, shared with end S
        │  ┌───┴─────┴────┐  │
        ║  │   window     │  ║         frame     blade
        ║  │         ___--│  ║       ┌───────┬───────────┬───────┐ gap: the other finger
        ║  │___---        │  ║       │       └───────────┘       │
        ║  │    blade     │  ║       │ ┌───────────────────────┐ │ 0: skin of this finger
        ║  └──────────────┘  ║       └─┘                       └─┘
        ╚════════════════════╝      rail                       rail
    """

    name: str
    gap_mm: float
    """Thickness of the frame, which lies on the faces of both fingers."""
    blade_mm: float
    """Thickness of blade and strip, at the other finger."""
    rail_mm: float
    """Height of rails and stop behind this finger's skin."""
    wall_mm: float
    """Thickness of rails and stop."""
    rail_gap_mm: float
    """From the outline to the inner face of a rail: skin, film, and clearance."""
    rail_y_max_mm: float
    stop: Box
    """Before the tip, its middle the middle of the card."""
    window: Box
    low_y_mm: float
    """End of the frame, and of the rails, towards the gripper."""
    edge: Target
    """On the receiver."""
    strip: Target
    """On the receiver, with end S there."""
    letter_mm: float
    """Height of the letters E and S on the frame; 0 where they have no room."""
    letter_depth_mm: float

    @property
    def file(self) -> str:
        """Path of its STL below the output folder."""
        return f"gauge/{self.name}.stl"

    @property
    def middle_y_mm(self) -> float:
        """Axis of the half turn from end to end."""
        return self.stop.centre_mm[1]

    @property
    def high_y_mm(self) -> float:
        """Far end of end S while end E is on a finger."""
        return 2 * self.middle_y_mm - self.low_y_mm

    @property
    def placements(self) -> tuple[Target, ...]:
        """Each end on each finger, as `gauge.json` lists them."""
        on_receiver = (self.edge, self.strip)
        return tuple(t for each in on_receiver for t in (each, each.turned(self.gap_mm)))
