"""The smooth film on a mould's floor, which gives the silicone its face in front of the cells."""

from dataclasses import dataclass

from lumitip_fab.design.shape import Box

LEAST_MARGIN_MM = 0.8
"""From an aperture to the film's edge: a film that is cut 0.3 mm short and lies against one side of
its recess still covers it."""

LAND_MM = 0.5
"""Least floor from the recess, and so from the film, to stops, walls, rounding and taper."""


@dataclass(frozen=True)
class Insert:
    """A rectangle of film, alike for both fingers, in a recess of the floor that is as deep as the
    film is thick. Side view, open side up:

              film
        ────╮┌──────┐╭──── floor
            ╰────────╯     recess; its clearance is beside the film
        ══════════════════ bed
    """

    name: str
    film: str
    """Title of the film."""
    thickness_mm: float
    box: Box
    """The film, in the sensor frame; as wide on both sides of x = 0."""
    clearance_mm: float
    """From the film to the side of its recess, all round."""

    @property
    def recess(self) -> Box:
        """Where the floor is lower."""
        return self.box.grown(self.clearance_mm)

    @property
    def volume_mm3(self) -> float:
        """Volume of the film."""
        return self.box.width_mm * self.box.length_mm * self.thickness_mm
