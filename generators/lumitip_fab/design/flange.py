"""The printed flange between a robot's coupling and its gripper, round the board in it.

Frame of the flange: origin on the axis, in the coupling's face; z towards the gripper, x to the
locating pin. Every length is in mm, and as drawn: the printer's fit is in what goes into something.

```
   ┌─┐                         ┌─┐   top_z: the gripper's face
   │ │_________________________│ │   floor of the gripper's recess
   │ upper                       │
   ├─────┐                 ┌─────┤   split_z
   │     │  ▒▒▒       ▒▒▒  │     │   headers
   │lower│  ═════board═════│     │   board_z: the board's back
   └╲    └─╴ ╶──┐┆┆┆┌──╴ ╶─┘    ╱┘   z = 0: the coupling's face; cone of 45°, to print
     └──────────┘ ┆ └──────────┘     seat_z: floor of the coupling's recess; tail reliefs above
                  ┆  spring contacts
```
"""

from dataclasses import dataclass

from lumitip_fab.design.shape import Box, Point


@dataclass(frozen=True)
class ToolContact:
    """A contact of the coupling, by the map of its entry in the catalogue."""

    number: str
    at: Point
    """Its place, seen from the gripper."""
    carries: str
    """Name of its signal on the robot's side."""
    kind: str
    """`"supply"`, `"ground"`, `"open"`, or another kind of signal."""


@dataclass(frozen=True)
class Flange:
    """Both printed parts of the flange: lower and upper."""

    name: str
    carrier: str
    """Name of the board in it."""
    coupling: str
    """Name of the coupling in the catalogue."""
    iso: str
    """The coupling's robot's side by ISO 9409-1, such as `50-4-M6`."""
    face_mm: float
    """Diameter of both parts."""
    centring_mm: float
    """Diameter of the coupling's recess, and of what the gripper has to stand in it."""
    clearance_mm: float
    """Wanted from the printed parts to coupling, gripper and board, on each side."""
    spigot_mm: float
    """Diameter of the lower part in the coupling's recess."""
    seat_z_mm: float
    """Where the lower part rests: the floor of that recess."""
    recess_mm: float
    """Diameter of the gripper's recess in the upper part."""
    recess_depth_mm: float
    bolt: str
    bolts: tuple[Point, ...]
    """Axes of the bolts that go through both parts."""
    bolt_hole_mm: float
    pin_at: Point
    """Axis of the coupling's locating pin, and of the gripper's."""
    pin_mm: float
    """Diameter of a bought pin that is glued into the lower part."""
    pin_hole_mm: float
    pin_length_mm: float
    pin_depth_mm: float
    """How deep it stands in the lower part."""
    socket_mm: float
    """Diameter of the hole for the gripper's pin."""
    socket_z_mm: float
    """Where that hole ends, in the lower part."""
    peg_at: Point
    """Axis of a peg of the lower part, which finds a hole in the upper one."""
    peg_mm: float
    peg_hole_mm: float
    peg_height_mm: float
    board_at: Point
    """Where the board's own origin is."""
    board_z_mm: float
    """Its back."""
    pocket: Box
    """Room of the board."""
    pocket_corner_mm: float
    reliefs: tuple[Box, ...]
    """Below the board, where solder tails stand out of its back."""
    tail_mm: float
    """Depth of those."""
    window: Box
    """Through the floor, for the spring contacts on the board's back."""
    contacts: tuple[ToolContact, ...]
    """The coupling's contacts."""
    contacts_z_mm: float
    """Where the coupling's contacts are."""
    contacts_mm: float
    """Height of the free spring contacts above the board's back."""
    stroke_mm: float
    """How far they give."""
    openings: tuple[Box, ...]
    """Through the walls, for the headers and their cables, above the board's front."""
    screws: tuple[Point, ...]
    """Countersunk screws through floor and board."""
    screw: str
    """Their thread."""
    screw_mm: float
    """Their holes."""
    screw_head_mm: float
    """Countersinks for their heads."""
    split_z_mm: float
    """Where the parts meet."""
    web_mm: float
    """Thickness of the upper part under the gripper's recess."""

    @property
    def top_z_mm(self) -> float:
        """What the flange adds between coupling and gripper."""
        return self.split_z_mm + self.web_mm + self.recess_depth_mm
