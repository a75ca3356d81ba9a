"""`Design`: everything that is derived from the parameters, once. Types only.

Every length is in mm and in the sensor frame of the finger it belongs to, unless it says
otherwise: gripping face seen with the tip up, origin at the mean of the cell centres on the
film's outer face, x to the right, y towards the tip, z out of the face.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip.layout import Layout

Point = tuple[float, float]
Cubic = tuple[Point, Point, Point, Point]


@dataclass(frozen=True)
class Box:
    """An upright rectangle."""

    x_min_mm: float
    x_max_mm: float
    y_min_mm: float
    y_max_mm: float

    @property
    def width_mm(self) -> float:
        """Extent along x."""
        return self.x_max_mm - self.x_min_mm

    @property
    def length_mm(self) -> float:
        """Extent along y."""
        return self.y_max_mm - self.y_min_mm

    @property
    def centre_mm(self) -> Point:
        """Its middle."""
        return (self.x_min_mm + self.x_max_mm) / 2, (self.y_min_mm + self.y_max_mm) / 2

    def grown(self, by_mm: float) -> "Box":
        """The rectangle with every side moved out."""
        return Box(
            self.x_min_mm - by_mm, self.x_max_mm + by_mm,
            self.y_min_mm - by_mm, self.y_max_mm + by_mm,
        )  # fmt: skip

    def mirrored(self) -> "Box":
        """The rectangle with x negated."""
        return Box(-self.x_max_mm, -self.x_min_mm, self.y_min_mm, self.y_max_mm)


@dataclass(frozen=True)
class Stack:
    """Layers of a finger, and the heights of the planes between them.

    z = 0      ────────────── skin: outer face of the film
    silicone_z ────────────── inner face of the film
    rim_z      ────────────── front of the board and of the plate
    pocket_z   ────────────── back of the board
    back_z     ────────────── back of the plate
    """

    floor_mm: float
    pcb_mm: float
    silicone_mm: float
    film_mm: float

    @property
    def plate_mm(self) -> float:
        """Thickness of the printed plate."""
        return self.floor_mm + self.pcb_mm

    @property
    def thickness_mm(self) -> float:
        """Thickness of the whole finger without its coupling."""
        return self.plate_mm + self.silicone_mm + self.film_mm

    @property
    def silicone_z_mm(self) -> float:
        """Inner face of the film."""
        return -self.film_mm

    @property
    def rim_z_mm(self) -> float:
        """Front of board and plate."""
        return -(self.film_mm + self.silicone_mm)

    @property
    def pocket_z_mm(self) -> float:
        """Back of the board: the pocket's floor."""
        return self.rim_z_mm - self.pcb_mm

    @property
    def back_z_mm(self) -> float:
        """Back of the plate."""
        return self.rim_z_mm - self.plate_mm


@dataclass(frozen=True)
class Outline:
    """The silhouette of the gripping face: closed, counter-clockwise, mirror-symmetric in x.

    Starts at the left end of the straight gripper end. A straight piece is a cubic whose inner
    control points lie on its chord at the thirds.
    """

    curve: tuple[Cubic, ...]
    tip_y_mm: float
    end_y_mm: float
    tip_width_mm: float
    end_width_mm: float

    @property
    def length_mm(self) -> float:
        """From tip edge to gripper end."""
        return self.tip_y_mm - self.end_y_mm

    def polygon(self, steps: int = 64) -> NDArray[np.float64]:
        """Corners of the outline, shape `(n, 2)`, without repeating the first.

        Args:
            steps: chords for each curved piece; straight pieces need one.
        """
        corners = []
        for piece in self.curve:
            p = np.array(piece)
            straight = np.allclose(p[1], p[0] + (p[3] - p[0]) / 3, atol=1e-9)
            t = np.linspace(0.0, 1.0, (1 if straight else steps) + 1)[:-1, None]
            b = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3)
            corners.append(sum(w * q for w, q in zip(b, p, strict=True)))
        return np.concatenate(corners)


@dataclass(frozen=True)
class Tip:
    """The wedge on the back of the plate: from full thickness at `slant_start_y_mm` to
    `edge_mm` at the tip edge."""

    slant_start_y_mm: float
    edge_mm: float
    angle_deg: float


@dataclass(frozen=True)
class Board:
    """Outline shared by both boards, and the pocket that holds one."""

    box: Box
    hole_mm: float
    pocket: Box
    pocket_clearance_mm: float
    pin_mm: float
    """Diameter of the pocket's locating pins, which stand at the board's holes."""


@dataclass(frozen=True)
class Part:
    """A part on a board: land pattern with body, seen from the front whatever its side."""

    name: str
    kind: str
    x_mm: float
    y_mm: float
    size_x_mm: float
    size_y_mm: float
    height_mm: float
    side: str
    """`"front"` (under the silicone) or `"back"`."""

    @property
    def box(self) -> Box:
        """Its land pattern with body."""
        dx, dy = self.size_x_mm / 2, self.size_y_mm / 2
        return Box(self.x_mm - dx, self.x_mm + dx, self.y_mm - dy, self.y_mm + dy)


@dataclass(frozen=True)
class Zone:
    """A region of a board kept for a purpose; placement works inside it or fails."""

    name: str
    box: Box


@dataclass(frozen=True)
class Connector:
    """A row of through-hole pads for wires."""

    signals: tuple[str, ...]
    """Signal of each pad, left to right in the finger's frame."""
    pads: tuple[Point, ...]
    pitch_mm: float
    pad_mm: float
    drill_mm: float


@dataclass(frozen=True)
class Relief:
    """Room in the pocket's floor for parts on the back of the board."""

    box: Box
    depth_mm: float
    """Below the pocket's floor; the floor's thickness where it is a window."""
    through: bool
    """Whether it is a window through the plate."""


@dataclass(frozen=True)
class Finger:
    """What differs between the two fingers, in the finger's own sensor frame."""

    name: str
    """`"emitter"` or `"receiver"`."""
    cells: tuple[Point, ...]
    """LED or photodetector of each cell, in frame order."""
    turned: bool
    """Whether the terminals of LEDs or photodetectors lie along y instead of x."""
    holes: tuple[Point, ...]
    """Holes of the board and pins of the pocket."""
    connector: Connector
    parts: tuple[Part, ...]
    zones: tuple[Zone, ...]
    reliefs: tuple[Relief, ...]
    notch: Box
    """Opening through the plate behind the connector, to beyond the gripper end."""
    window: Box
    """Opening of mask and film over the connector."""


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
    origin_y_mm: float
    """y of the mount frame's origin in the sensor frame; its z is the rim's."""
    tilt_deg: float
    block_width_mm: float
    block_corner_mm: float
    block_front_w_mm: float
    """Front of the block where the plate is open: leaves room for solder tails."""
    block_back_w_mm: float
    bolt_w_mm: float
    bolt_hole_mm: float
    counterbore_mm: float
    land_mm: float
    pin_mm: float
    pin_u_mm: tuple[float, ...]
    pin_depth_mm: float
    seat_width_mm: float
    nose: Nose | None
    stroke_mm: float
    pad_w_mm: float


@dataclass(frozen=True)
class Closing:
    """How the two fingers meet, in the gripper frame."""

    contact_y_mm: float
    """y, in the sensor frame, of the line that touches first."""
    contact_z_mm: float
    """How far that line stands out beyond the sensor frame's origin, after the lean."""
    max_opening_mm: float
    """Skin to skin, with the gripper open."""


@dataclass(frozen=True)
class Wiring:
    """What is connected to what, beyond the layout."""

    multiplexer: str
    muxes: int
    select_pins: tuple[str, ...]
    adc_pins: tuple[str, ...]
    strings: tuple[tuple[int, ...], ...]
    """LEDs of each series string, by cell."""
    resistor: str
    """Package of the string resistors."""
    resistor_ohm: tuple[float, ...]
    current_ma: tuple[float, ...]
    """Nominal current of each string."""
    supply_v: float


@dataclass(frozen=True)
class Mask:
    """The print on the film, in the finger's frame but for the page."""

    hole_mm: float
    hole_shape: str
    allowance_mm: float
    flap_mm: float
    film: str
    soften_c: float
    measured_ruler_mm: Point
    registration: tuple[Point, ...]
    """Marks round the artwork, in both x and -x, so the same on the page and in the frame."""
    mark: Box
    """Box of the letter F on the tip flap, which tells a mirror image from half a turn."""


@dataclass(frozen=True)
class Mould:
    """The silicone mould and what is poured into it."""

    taper_length_mm: float
    tip_silicone_mm: float
    end_round_mm: float
    """Rounding of the skin at the gripper end."""
    wall_gap_mm: float
    draft_deg: float
    wall_mm: float
    pads: tuple[Point, ...]
    """Hard stops on the plate's rim, beside the board."""
    pad_mm: float
    silicone: str
    density_g_ml: float
    mix_ratio: Point
    cure_h: float
    waste_fraction: float


@dataclass(frozen=True)
class Printing:
    """Material and limits of the printed parts."""

    material: str
    density_g_ml: float
    min_wall_mm: float
    line_mm: float
    layer_mm: float
    bed_mm: tuple[float, float, float]


@dataclass(frozen=True)
class Controller:
    """The microcontroller board."""

    board: str
    name: str
    adc_bits: int


@dataclass(frozen=True)
class Grid:
    """The grid as it was asked for; the cells are in `Design.layout`."""

    columns: tuple[int, ...]
    pitch_mm: float


@dataclass(frozen=True)
class Title:
    """What goes on drawings and boards."""

    name: str
    revision: str


@dataclass(frozen=True)
class Design:
    """A whole sensor. A generator's arguments are named after these fields."""

    title: Title
    grid: Grid
    layout: Layout
    stack: Stack
    outline: Outline
    tip: Tip
    board: Board
    emitter: Finger
    receiver: Finger
    mount: Mount
    closing: Closing
    wiring: Wiring
    mask: Mask
    mould: Mould
    printing: Printing
    controller: Controller
    parameters_hash: str

    @property
    def fingers(self) -> tuple[Finger, Finger]:
        """Both fingers, emitter first."""
        return self.emitter, self.receiver
