"""Gripper coupling, closing of the fingers, and the printed flange between robot and gripper."""

import math
from dataclasses import dataclass

from lumitip_fab.catalogue.record import TRUSTED
from lumitip_fab.design.making import Letter
from lumitip_fab.design.shape import Box, Point
from lumitip_fab.design.tie_lug import TieLug

_FLARE_THINS = 0.4  # of its depth at the ramp, where a flare ends: the bending moment thins so


@dataclass(frozen=True)
class Unsure:
    """A figure of a catalogue entry that neither a datasheet nor a measurement gives."""

    name: str
    """Its name in the entry, with that of its table: `pins.hole_mm`."""
    value: str
    """Its value in the entry, with its unit."""
    confidence: str
    measured: bool = True
    """Whether a printed part rests on it, and it is not chosen."""
    others: tuple[tuple[str, str], ...] = ()
    """Name and value of other figures that it is measured from."""


@dataclass(frozen=True)
class Nose:
    """The tapered end of the mounting block; see `Mount` for the frame."""

    front_width_mm: float
    front_w_mm: float
    half_angle_deg: float
    height_mm: float


@dataclass(frozen=True)
class Mount:
    """The gripper coupling, in its own frame.

    Mount frame: origin where the mount plane meets the plate's rim plane in x = 0, axes u to
    the right (= x), w back from the gripping face along the mount plane, h along the bolt
    towards the tip. It is the sensor frame turned by `tilt_deg` about x, so that the tip leans
    towards the other finger; the part stands on h = 0 in the printer.
    """

    gripper: str
    title: str
    """Name of the gripper in `parts/grippers.toml`, and title for documents."""
    origin_y_mm: float
    """y of the mount frame's origin in the sensor frame; its z is the rim's."""
    tilt_deg: float
    block_width_mm: float
    block_corner_mm: float
    block_front_w_mm: float
    """Front of the block where the plate is open: leaves room for solder tails."""
    block_back_w_mm: float
    bolt: str
    """Thread of the bolts, like M5."""
    bolt_length_mm: float
    """Under their heads: through the land, and far enough into the gripper."""
    bolt_u_mm: tuple[float, ...]
    bolt_w_mm: float
    bolt_hole_mm: float
    counterbore_mm: float
    land_mm: float
    pin_mm: float
    pin_u_mm: tuple[float, ...]
    pin_depth_mm: float
    seat_width_mm: float
    seat_back_w_mm: float
    """To which the gripper bears the foot."""
    nose: Nose | None
    stroke_mm: float
    pad_w_mm: float
    flare_mm: float
    """How far the ramp flares out along the plate, beyond where its 45° would end."""
    flare_depth_mm: float
    """Height over the plate's back at which the ramp turns into its flare."""
    letter: Letter
    """On the back of the block, beside the bolt's land."""
    lugs: tuple[TieLug, ...]
    """For ties round the cable, beside the block; none where it leaves no room."""
    force_n: float
    supply_a: float
    """Greatest force and current of the gripper; 0 if unknown."""
    unsure: tuple[Unsure, ...]
    """Figures of the gripper's entry to measure."""

    @property
    def to_measure(self) -> tuple[Unsure, ...]:
        """Those of them that are measured before parts are printed."""
        return tuple(figure for figure in self.unsure if figure.measured)

    @property
    def into_gripper_mm(self) -> float:
        """How far the bolts go into the gripper."""
        return self.bolt_length_mm - self.land_mm

    @property
    def flare_end_mm(self) -> float:
        """Height over the plate's back to which the flare thins; it ends there at 45°."""
        return min(_FLARE_THINS * self.flare_depth_mm, self.flare_mm / 2)

    def ramp_end_y_mm(self, back_z_mm: float, rim_z_mm: float) -> float:
        """y at which the ramp would reach the plate's back without its flare."""
        tilt = math.radians(self.tilt_deg)
        shoulder = self.land_mm * math.cos(tilt) - self.block_back_w_mm * math.sin(tilt)
        shoulder_z = -self.land_mm * math.sin(tilt) - self.block_back_w_mm * math.cos(tilt)
        rise = back_z_mm - rim_z_mm - shoulder_z
        return self.origin_y_mm + shoulder + rise / math.tan(math.pi / 4 - tilt)

    @property
    def sleeved(self) -> bool:
        """Whether the pins are sleeves round the bolts."""
        return self.pin_u_mm == self.bolt_u_mm


@dataclass(frozen=True)
class Closing:
    """Contact of the two fingers, in the gripper frame."""

    contact_y_mm: float
    """y, in the sensor frame, of the line that touches first."""
    most_from_tip_mm: float
    """Largest distance of that line from the tip."""
    contact_z_mm: float
    """How far that line stands out beyond the sensor frame's origin, after the lean."""
    max_opening_mm: float
    """Skin to skin, with the gripper open."""


@dataclass(frozen=True)
class Fastener:
    """A metric thread with its heads and nut, as the catalogue has them."""

    name: str
    """Of the thread, such as M5."""
    thread_mm: float
    hole_mm: tuple[float, float]
    """Clearance holes, fine and coarse."""
    cap_head_mm: float
    """Diameter of the head of a socket head cap screw; that of a countersunk one follows."""
    countersunk_mm: float
    nut_mm: float
    """Width of its nut, across flats."""
    nut_height_mm: float


BOLTS_MM = (10, 12, 16, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 80, 90, 100)
"""Lengths of socket head screws as they are commonly sold (inferred)."""
SHORTER_MM = 0.5
"""By which such a screw may be shorter than it ought to be: less than a turn of M4."""


def standard_bolt_mm(least_mm: float) -> int:
    """The shortest of these lengths that is long enough."""
    return next(length for length in BOLTS_MM if length >= least_mm - SHORTER_MM)


@dataclass(frozen=True)
class System:
    """Heights along the tool axis, and the body of the gripper."""

    robot_mm: float
    """Diameter of the robot's tool flange; 0 without a coupling."""
    coupling_mm: float
    """From there to the coupling's face; 0 without one."""
    gripper_z_mm: float
    """Plane that the gripper stands on."""
    width_mm: float
    """Width of the gripper's body, along the opening."""
    depth_mm: float
    corner_mm: float
    length_mm: float
    reach_mm: float
    """From where the gripper stands to the mount plane of the fingers, closed."""
    load_kg: float
    """Gripper and payload, taken to be at the tool centre point."""
    confidence: str
    """Confidence in the figures of the gripper's body."""
    holders: tuple[str, ...]
    """Names of the holders that go round that body."""
    holder_z_mm: float
    """Middle of those."""

    @property
    def body_is_known(self) -> bool:
        """Whether parts that go round the body are printed without a measurement."""
        return self.confidence in TRUSTED


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
    auxiliary: str
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
    """Nominal gap from the printed parts to coupling, gripper and board, on each side."""
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
    pin_play_mm: float
    """Play of a glued pin in its hole, without the fit."""
    pin_hole_mm: float
    pin_length_mm: float
    pin_depth_mm: float
    """How deep it stands in the lower part."""
    socket_play_mm: float
    """Play of the gripper's pin in its hole, without the fit."""
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
    """Travel of the spring contacts."""
    contact_a: float
    """Largest current of one of them; 0 where it is not known."""
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
    unsure: tuple[Unsure, ...]
    """Figures of the coupling's entry to measure."""

    @property
    def top_z_mm(self) -> float:
        """Height of the flange between coupling and gripper."""
        return self.split_z_mm + self.web_mm + self.recess_depth_mm
