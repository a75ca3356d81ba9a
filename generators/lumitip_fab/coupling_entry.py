"""Couplings in the catalogue: what is between a robot's tool flange and its gripper.

Seen from the gripper along the axis, x towards the locating pin.
"""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from lumitip_fab.carrier_entry import OPEN, Signal
from lumitip_fab.entry import Entry, Length, Strict
from lumitip_fab.gripper_entry import Screw

Place = Annotated[float, Field(ge=-200, le=200)]


Kind = Literal["supply", "ground", "shield", "control", "data", "output", "open"]


class Contact(Strict):
    """A contact of a coupling, by what the robot's side puts on it."""

    at_mm: tuple[Place, Place]
    """Its place, from the axis."""
    carries: Signal
    """Name of its signal; `NC` of a contact to leave open."""
    kind: Kind
    """What that signal is: `SUPPLY` goes to a supply alone, `GND` to a ground alone, and nothing
    to a contact that is open."""

    @model_validator(mode="after")
    def _open_is_nc(self) -> Self:
        if (self.kind == "open") != (self.carries == OPEN):
            raise ValueError(
                f"carries = {self.carries!r} with kind = {self.kind!r} given: {OPEN} and open "
                "belong together"
            )
        return self


class ToolCoupling(Entry):
    """A coupling with the robot's tool flange on its one side, by ISO 9409-1, and a centring
    recess, a locating pin and contacts on its other."""

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
    """How deep it stands in the coupling, below the floor of the recess."""
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
                f"recess_mm = {self.recess_mm:g} given, less than face_mm = {self.face_mm:g} is "
                "allowed"
            )
        if self.recess_depth_mm >= self.height_mm:
            raise ValueError(
                f"recess_depth_mm = {self.recess_depth_mm:g} given, less than height_mm = "
                f"{self.height_mm:g} is allowed"
            )
        return self
