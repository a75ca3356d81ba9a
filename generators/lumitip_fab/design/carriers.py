"""Boards that carry what is outside the fingers, each in a frame of its own.

Frame of a carrier: seen from its front, origin at the middle of its outline, x to the right, y up.
Every length is in mm.
"""

from dataclasses import dataclass

from lumitip_fab.design.shape import Box, Point


@dataclass(frozen=True)
class Land:
    """A pad of a land pattern, in the part's own frame: seen from its side, y up."""

    number: str
    x_mm: float
    y_mm: float
    width_mm: float
    height_mm: float
    drill_mm: float
    """Diameter of its plated hole; 0 of a surface-mount pad."""
    round: bool


@dataclass(frozen=True)
class Pattern:
    """A land pattern with its body."""

    name: str
    """By IPC-7351 where that has a name for it."""
    lands: tuple[Land, ...]
    body: Box
    height_mm: float
    """Above the board; 0 of bare copper."""


@dataclass(frozen=True)
class Device:
    """A part, or bare copper, in its place on a carrier."""

    ref: str
    kind: str
    """`"socket"`, `"wires"`, `"capacitor"` …, by which its symbol is chosen."""
    value: str
    part: str
    """Order number; empty for bare copper."""
    manufacturer: str
    lcsc: str
    """Number at the distributor LCSC; empty where it is not known."""
    pattern: Pattern
    x_mm: float
    y_mm: float
    angle_deg: float
    """Counter-clockwise, seen from the front."""
    nets: tuple[tuple[str, str], ...]
    """Net of each land, by number."""
    pins: tuple[str, ...]
    """Name of each land, in the order of the lands; empty where a part has no names."""
    side: str = "front"
    """Side of its body: a part on the `"back"` is mirrored in x before it is turned."""

    @property
    def contacts(self) -> bool:
        """Whether it is rows of contacts, where someone plugs or solders: their names are printed
        beside them."""
        return self.kind in ("socket", "header", "wires")


@dataclass(frozen=True)
class Note:
    """A line that is printed on a carrier's front."""

    text: str
    at: Point
    """Its middle."""
    height_mm: float
    angle_deg: float


@dataclass(frozen=True)
class Carrier:
    """A board with everything on it: what its files must hold."""

    name: str
    """Of its folder and its files."""
    title: str
    """Title on its silkscreen."""
    title_at: Point
    """Near which its title stands."""
    box: Box
    corner_mm: float
    """Radius of the outline's corners."""
    holes: tuple[Point, ...]
    """Centres of its screw holes."""
    hole_mm: float
    devices: tuple[Device, ...]
    notes: tuple[Note, ...]
    supplies: tuple[str, ...]
    """Nets that are routed wide; ground is one of them."""
    keep_outs: tuple[Box, ...]
    """Areas without copper on either side, under an antenna."""
    hot_loop: tuple[tuple[str, str], ...]
    """Lands round which the current of a switching regulator jumps, by part and number of the
    land: from its input over the capacitor back to its ground; empty without a regulator."""

    @property
    def nets(self) -> tuple[str, ...]:
        """Every net once, ground first."""
        used = (net for device in self.devices for _, net in device.nets)
        return tuple(dict.fromkeys((*self.supplies, *used)))


@dataclass(frozen=True)
class Holder:
    """A printed tray for a carrier on a cradle that clips round the gripper's body.

    In the carrier's frame, z = 0 on the back of the board and out of its front: the body's axis
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
    carrier: str
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
    """Of a boss under the board: length along x, width along y on top and at the floor."""
    strap_deg: float
    """Where the holes through the arms are, from the middle of the tray."""
    strap_y_mm: tuple[float, ...]
    strap_hole_mm: float
