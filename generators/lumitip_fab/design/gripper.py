"""How a finger is held, and how two of them meet."""

from dataclasses import dataclass

from lumitip_fab.design.making import Letter


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
    """Its name in `parts/grippers.toml`."""
    title: str
    """What people call it."""
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
    bolt_u_mm: tuple[float, ...]
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
    letter: Letter
    """On the back of the block, beside the bolt's land."""
    unsure: tuple[str, ...]
    """Figures of the gripper that neither a datasheet nor a measurement gives."""

    @property
    def sleeved(self) -> bool:
        """Whether the pins are sleeves round the bolts."""
        return self.pin_u_mm == self.bolt_u_mm


@dataclass(frozen=True)
class Closing:
    """How the two fingers meet, in the gripper frame."""

    contact_y_mm: float
    """y, in the sensor frame, of the line that touches first."""
    contact_z_mm: float
    """How far that line stands out beyond the sensor frame's origin, after the lean."""
    max_opening_mm: float
    """Skin to skin, with the gripper open."""
