"""Grippers in the catalogue: where and how each holds a fingertip.

Seen from the gripper along the finger, u to the right and w away from the gripping face:

      ─────────────── rim plane of the finger's plate, w = 0
         \\  nose  /
     ┌────\\      /────┐
     │  ◎ ·  ◎  · ◎   │  bolts and locating pins on the line w = bolt_w_mm
     └────────────────┘
"""

from collections.abc import Mapping
from typing import Annotated, Self

from pydantic import Field, model_validator

from lumitip_fab.entry import Confidence, Entry, Length, Offset, Sourced, Strict

Screw = Annotated[str, Field(pattern=r"^M\d{1,2}(\.\d)?$")]


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


class Origin(Strict):
    """Where a figure comes from that the entry's `source` does not give."""

    source: str = Field(min_length=1)
    """Where it comes from."""
    confidence: Confidence
    """How far to trust it."""


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
    """Of the gripper."""
    payload_kg: float = Field(gt=0, le=100)
    """What it may hold."""

    @property
    def round_mm(self) -> float | None:
        """Diameter of a body that is a cylinder; none of any other."""
        sides = {self.width_mm, self.depth_mm, 2 * self.corner_mm}
        return self.width_mm if len(sides) == 1 else None

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        most = min(self.width_mm, self.depth_mm) / 2
        if self.corner_mm > most:
            raise ValueError(f"corner_mm = {self.corner_mm:g} given, at most {most:g} is allowed")
        if self.length_mm > self.reach_mm:
            raise ValueError(
                f"length_mm = {self.length_mm:g} given, at most reach_mm = {self.reach_mm:g} is "
                "allowed"
            )
        return self


class Gripper(Entry):
    """Where a gripper holds a fingertip; distances w are behind the plate's rim plane. Its bolts
    run along the finger, into the gripper."""

    stroke_mm: Length
    """Opening of the gripper between its own pads."""
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
    pins: Pins | None = None
    """Its locating pins, if it has some."""
    nose: Nose | None = None
    """The tapered seat, if the gripper has one."""
    envelope: Envelope
    """Its body, with a source of its own."""
    origin: Mapping[str, Origin] = Field(default_factory=dict)
    """Of single figures: where they come from, if not from `source`."""

    @property
    def unsure(self) -> tuple[str, ...]:
        """Names of the figures that neither a datasheet nor a measurement gives."""
        told = [name for name in FIGURES if getattr(self, name) is not None]
        trusted = ("datasheet", "measured")
        return tuple(
            name
            for name in told
            if (self.origin[name].confidence if name in self.origin else self.confidence)
            not in trusted
        )

    @model_validator(mode="after")
    def _origins_of_figures(self) -> Self:
        unknown = sorted(set(self.origin) - set(FIGURES))
        if unknown:
            raise ValueError(
                f"origin of {', '.join(unknown)} given, figures of a gripper are "
                f"{', '.join(FIGURES)}"
            )
        return self


FIGURES = tuple(
    name
    for name in Gripper.model_fields
    if name not in {"source", "confidence", "title", "envelope", "origin"}
)
