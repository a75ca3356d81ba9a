"""Catalogue entries of grippers and of the couplings between gripper and robot."""

from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from lumitip_fab.catalogue.controllers import OPEN, Signal
from lumitip_fab.catalogue.record import Length, Name, Offset, Sourced, Strict, Traced

SCREW = r"^M\d{1,2}(\.\d)?$"
Screw = Annotated[str, Field(pattern=SCREW)]


class Nose(Strict):
    """The tapered end that sits in the V-shaped seat of a gripper's finger."""

    front_width_mm: Length
    """Width at its front."""
    front_w_mm: Offset
    """Distance of its front behind the rim plane."""
    half_angle_deg: float = Field(gt=0, lt=90)
    """Angle of each flank with the finger's centreline, seen along the finger."""
    height_mm: Length
    """Height above the mount plane."""


class Pins(Strict):
    """The gripper's two locating pins, or sleeves round its bolts, and the holes for them."""

    hole_mm: Length
    """Diameter of their holes in the fingertip."""
    spacing_mm: Length
    """Distance between the two, side by side; where it is that of the bolts, they are sleeves
    round them."""
    depth_mm: Length
    """Depth of their holes."""


class Envelope(Sourced):
    """The body of a gripper as a block with round edges along its axis, from the face that stands
    on the coupling, how far its fingers' mount planes are from that face, and the load."""

    width_mm: Length
    """Along the opening."""
    depth_mm: Length
    """Across the opening."""
    corner_mm: float = Field(ge=0, le=500)
    """Radius of the edges along the axis; half of both sides makes a cylinder."""
    length_mm: Length
    """Along the axis."""
    reach_mm: Length
    """From that face to the plane that the fingertips stand on, with the gripper closed."""
    mass_kg: float = Field(gt=0, le=50)
    """Mass of the gripper."""
    payload_kg: float = Field(gt=0, le=100)
    """Its payload."""

    @property
    def round_mm(self) -> float | None:
        """Diameter of a body that is a cylinder; none of any other."""
        sides = {self.width_mm, self.depth_mm, 2 * self.corner_mm}
        return self.width_mm if len(sides) == 1 else None

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        most = min(self.width_mm, self.depth_mm) / 2
        if self.corner_mm > most:
            raise ValueError(f"corner_mm is {self.corner_mm:g}; at most {most:g} is allowed")
        if self.length_mm > self.reach_mm:
            raise ValueError(
                f"length_mm is {self.length_mm:g}; at most reach_mm = {self.reach_mm:g} is allowed"
            )
        return self


class Gripper(Traced):
    """Mounting geometry of a gripper; distances w are behind the plate's rim plane. Its bolts
    run along the finger, into the gripper."""

    KIND: ClassVar = "a gripper"

    base: Name | None = None
    """Name of its bottom, as the entry of a coupling in `parts/couplings.toml` has it; left out, no
    coupling there is known to fit, and no flange is made."""
    stroke_mm: Length
    """Opening of the gripper between its own pads."""
    force_n: float | None = Field(default=None, gt=0, le=5000)
    """Greatest force that it closes with; left out where it is not known (N)."""
    supply_a: float | None = Field(default=None, gt=0, le=100)
    """Greatest current from its supply; left out where it is not known (A)."""
    pad_w_mm: Length
    """Distance of the gripper's own pad face before the bolts' axes."""
    tilt_deg: float = Field(ge=-10, le=10)
    """Tilt of the mount plane; above zero the tip leans towards the other finger."""
    block_width_mm: Length
    """Width of the mounting block."""
    block_corner_mm: Length
    """Corner radius of the block's back."""
    block_back_w_mm: Length
    """Distance of the block's back behind the rim plane."""
    bolt: Screw
    """Thread of the bolts, like M5: socket head cap screws."""
    bolt_w_mm: Length
    """Distance of the bolts' axes behind the rim plane."""
    bolt_spacing_mm: Length | None = None
    """Distance between two bolts side by side; left out, there is one, in the middle."""
    bolt_hole_mm: Length
    """Clearance hole of a bolt."""
    counterbore_mm: Length
    """Diameter of the counterbore for a bolt's head."""
    land_mm: Length
    """Material between counterbore and mount plane, on a bolt's axis."""
    seat_width_mm: Length
    """Width of the gripper's finger where the fingertip stands on it."""
    seat_back_w_mm: Length | None = None
    """Distance behind the rim plane to which the gripper's finger bears the fingertip; left out, as
    far as the block."""
    pins: Pins | None = None
    """Its locating pins, if it has some."""
    nose: Nose | None = None
    """The tapered seat, if the gripper has one."""
    envelope: Envelope
    """Its body, with a source of its own."""

    @model_validator(mode="after")
    def _seat_behind_bolts(self) -> Self:
        back = self.seat_back_w_mm
        if back is not None and back <= self.bolt_w_mm:
            raise ValueError(
                f"seat_back_w_mm is {back:g}; more than bolt_w_mm = {self.bolt_w_mm:g} is needed, "
                "for the seat holds the finger upright behind the bolts. Measure it, or leave it "
                "out where the seat reaches as far as the block"
            )
        return self


FIGURES = Gripper.figures()


Place = Annotated[float, Field(ge=-200, le=200)]


Kind = Literal["supply", "ground", "shield", "control", "data", "output", "open"]


class Contact(Strict):
    """A contact of a coupling, by what the robot's side puts on it."""

    at_mm: tuple[Place, Place]
    """Its place, from the axis."""
    carries: Signal
    """Name of its signal; `NC` of a contact to leave open."""
    kind: Kind
    """Kind of that signal: only `SUPPLY` may be on a supply, only `GND` on a ground, and nothing
    on an open contact."""

    @model_validator(mode="after")
    def _open_is_nc(self) -> Self:
        if (self.kind == "open") != (self.carries == OPEN):
            raise ValueError(
                f"carries is {self.carries!r} and kind is {self.kind!r}; {OPEN!r} and 'open' need "
                "each other"
            )
        return self


class ToolCoupling(Traced):
    """A coupling with the robot's tool flange on its one side, by ISO 9409-1, and a centring
    recess, a locating pin and contacts on its other."""

    KIND: ClassVar = "a coupling"

    base: Name
    """Name of the bottom of the grippers that stand on it, as their entries have it."""
    height_mm: Length
    """From the robot's tool flange to the face that the gripper stands on."""
    robot_mm: Length
    """Outer diameter of the robot's tool flange by ISO 9409-1."""
    face_mm: Length
    """Diameter of the face that the gripper stands on."""
    recess_mm: Length
    """Diameter of the recess that centres the gripper."""
    recess_depth_mm: Length
    """Depth of that recess: what stands in it rests on its floor."""
    bolt: Screw
    """Thread of the bolts that hold the gripper."""
    bolt_hole_mm: Length
    """Clearance hole of such a bolt."""
    bolts_mm: tuple[tuple[Place, Place], ...] = Field(min_length=2, max_length=12)
    """Axes of those bolts."""
    pin_mm: Length
    """Diameter of the locating pin."""
    pin_at_mm: tuple[Place, Place]
    """Axis of the locating pin."""
    pin_depth_mm: Length
    """Depth in the coupling, below the floor of the recess."""
    contacts: tuple[Contact, ...] = Field(min_length=1, max_length=64)
    """Every contact, in the order of their numbers from 1."""
    contacts_depth_mm: Length
    """From the face down to the contacts."""
    iso: str = Field(pattern=r"^\d+(\.\d+)?-\d+-M\d+$")
    """Its robot's side by ISO 9409-1: circle of the bolts (mm), how many, their thread."""

    @property
    def contacts_at_mm(self) -> tuple[float, float]:
        """Middle of the contacts."""
        places = [contact.at_mm for contact in self.contacts]
        count = len(places)
        return sum(x for x, _ in places) / count, sum(y for _, y in places) / count

    @model_validator(mode="after")
    def _recess_in_face(self) -> Self:
        if self.recess_mm >= self.face_mm:
            raise ValueError(
                f"recess_mm is {self.recess_mm:g}; less than face_mm = {self.face_mm:g} is allowed"
            )
        if self.recess_depth_mm >= self.height_mm:
            raise ValueError(
                f"recess_depth_mm is {self.recess_depth_mm:g}; less than height_mm = "
                f"{self.height_mm:g} is allowed"
            )
        return self
