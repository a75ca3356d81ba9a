"""The printed holder of a board on the gripper."""

import math
from dataclasses import dataclass

from lumitip_fab.design.shape import Box, Point
from lumitip_fab.design.tie_lug import TieLug


@dataclass(frozen=True)
class Holder:
    """A printed tray for an auxiliary board on a cradle that clips round the gripper's body.

    In the board's frame, z = 0 on the back of the board and out of its front: the body's axis
    runs along y at `axis_z_mm`. It is printed standing on its end at the lowest y. Sizes are as
    drawn: the printer's fit is in what board, body, screws and nuts go into.

    ```
       ┌┐              ┌┐   z = board's front
       │└─┐▁        ▁┌─┘│   bosses carry the board, z = 0
       │  └──────────┘  │   floor of the tray
       │   ╭────────╮   │
      ╭╯  ╱          ╲  ╰╮  cradle
      │  │     ·      │  │  axis of the body
      ╰──╯            ╰──╯  arms reach beyond it
    ```
    """

    name: str
    auxiliary: str
    """Name of the board in it."""
    tray: Box
    """Inside of the tray, open at both ends along y."""
    outer: Box
    """Outside of the tray, seen along z."""
    top_z_mm: float
    """Rim of the tray."""
    floor_z_mm: float
    """Floor of the tray."""
    seat_z_mm: float
    """Seat of the nuts, below the floor."""
    axis_z_mm: float
    body_mm: float
    """Diameter of the gripper's body."""
    body_from: str
    """Source of that figure: `holder.body_mm`, or the gripper's entry and how sure that is."""
    clearance_mm: float
    """Nominal gap from the cradle to that body, and from the tray to the board, on each side."""
    cradle_mm: float
    """Radius of the cradle."""
    wall_mm: float
    wrap_deg: float
    """Where the arms end, from the middle of the tray."""
    preload_mm: float
    """How far the body, which lies in the middle of the cradle, bends each arm out."""
    holes: tuple[Point, ...]
    """Screws of the board."""
    screw: str
    """Thread of those screws."""
    screw_mm: float
    """Their holes."""
    screw_length_mm: float
    """Under their heads, which are on the board."""
    nut_mm: float
    """Across flats of their nuts' pockets."""
    boss_mm: tuple[float, float, float]
    """Size of a boss under the board: length along x, width along y on top and at the floor."""
    strap_deg: float
    """Where the holes through the arms are, from the middle of the tray."""
    strap_y_mm: tuple[float, ...]
    strap_hole_mm: float
    lugs: tuple[TieLug, ...]
    """For ties round the cables, on the bed of the printer; none where the tray leaves no room."""
    arm_lugs: tuple[TieLug, ...]
    """For ties round the gripper, outside the arms where the body is widest, on the bed of the
    printer: each side has as many, at the same heights."""

    @property
    def rib_mm(self) -> float:
        """Height of the rib on the end of each arm, inward from the cradle.

        The body presses into the cradle's middle, by the clearance away from the axis: at the ribs
        that leaves `clearance * (1 - cos(wrap))` before they touch.
        """
        wrap = math.radians(self.wrap_deg)
        return self.clearance_mm * (1 - math.cos(wrap)) + self.preload_mm

    @property
    def end_mm(self) -> tuple[float, float]:
        """Radius of the bar on an arm's end, with the rib, and its distance from the axis."""
        radius = (self.wall_mm + self.rib_mm) / 2
        return radius, self.cradle_mm + self.wall_mm - radius

    @property
    def tie_loop_mm(self) -> float:
        """Length of a tie that is closed through the lugs of both arms: twice half round the body,
        outside the arms."""
        lug = self.arm_lugs[0]
        first, last = lug.along_mm
        return 2 * (math.pi * (self.cradle_mm + self.wall_mm + lug.out_mm) + last - first)

    @property
    def inward_mm(self) -> float:
        """Least distance of the arms' ends from the plane through axis and middle of the tray."""
        radius, middle = self.end_mm
        return middle * math.sin(math.radians(self.wrap_deg)) - radius
