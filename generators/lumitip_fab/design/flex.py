"""What a compliant finger has beside a rigid one: a bendable plate, and a part that holds it."""

from dataclasses import dataclass

from lumitip_fab.design.making import Letter
from lumitip_fab.design.shape import Box


@dataclass(frozen=True)
class Interface:
    """The rigid part between a bendable plate and the gripper, glued to the plate's back.

    Its front is a pad on the plate's back, with a rim that stands in a groove of the plate. Seen
    from the front, rim and groove are a U that is open at the gripper end:

        ╭───────────╮  groove.y_max
        │ ╭───────╮ │
        │ │  pad  │ │
        │ │       │ │
          notch       gripper end
    """

    groove: Box
    """Outer edge of the groove, from the gripper end."""
    groove_mm: float
    groove_depth_mm: float
    glue_mm: float
    """Gap that is wanted between rim and groove: on each side, and at the groove's floor."""
    gap_mm: float
    """On each side as drawn: the printer's fit is in it, by which the rim is narrower."""
    pad_mm: float
    """Thickness of the pad."""
    thread_hole_mm: float
    """Holes through the plate, behind those of the board, through which it is tied on."""
    letter: Letter
    """On the plate's back: the frame is the mount's, without its tilt."""

    @property
    def box(self) -> Box:
        """The pad, as wide as the rim's outer edge."""
        g, gap = self.groove, self.gap_mm
        return Box(g.x_min_mm + gap, g.x_max_mm - gap, g.y_min_mm, g.y_max_mm - gap)

    @property
    def rim_mm(self) -> float:
        """Width of the rim."""
        return self.groove_mm - 2 * self.gap_mm

    @property
    def rim_height_mm(self) -> float:
        """How far the rim stands out of the pad."""
        return self.groove_depth_mm - self.glue_mm
