"""Couplings in the catalogue: what is between a robot's tool flange and its gripper.

Seen from the gripper along the axis, x towards the locating pin.
"""

from typing import Annotated, Self

from pydantic import Field, model_validator

from lumitip_fab.entry import Entry, Length
from lumitip_fab.gripper_entry import Screw

Place = Annotated[float, Field(ge=-200, le=200)]


class ToolCoupling(Entry):
    """A coupling with the robot's tool flange on its one side, by ISO 9409-1, and a centring
    recess, a locating pin and contacts on its other."""

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
    contacts_at_mm: tuple[Place, Place]
    """Middle of the contacts."""
    contacts_depth_mm: Length
    """From the face down to the contacts."""
    height_mm: Length
    """From the robot's tool flange to the face."""
    iso_pitch_mm: Length
    """Diameter of the circle of bolts in the robot's tool flange."""
    iso_bolts: int = Field(ge=3, le=12)
    """How many bolts that circle has."""
    iso_bolt: Screw
    """Thread of those."""
    iso_face_mm: Length
    """Diameter of the robot's tool flange."""
    iso_pilot_mm: Length
    """Diameter of the centring recess in it."""
    iso_pin_mm: Length
    """Diameter of the locating pin in it."""

    @property
    def iso(self) -> str:
        """Its robot's side as ISO 9409-1 names it."""
        return f"ISO 9409-1-{self.iso_pitch_mm:g}-{self.iso_bolts}-{self.iso_bolt}"

    @model_validator(mode="after")
    def _recess_in_face(self) -> Self:
        if self.recess_mm >= self.face_mm:
            raise ValueError(
                f"recess_mm = {self.recess_mm:g} given, less than face_mm = {self.face_mm:g} is "
                "allowed"
            )
        return self
