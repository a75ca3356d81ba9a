"""A bridge on a printed part that a cable tie goes through."""

from dataclasses import dataclass

from lumitip_fab.design.shape import Box, Point


@dataclass(frozen=True)
class TieLug:
    """A bridge on an upright wall of a printed part, in the frame in which that is printed: the tie
    goes along the wall, between it and a bar, and round the cable outside the bar.

        up  wall
        │    ┌─────┐
        │    │  ┌┐ │
        │    │  ││ │  bar: the cable lies outside
        │    │  └┘ │
        │    │   ╱     45°, or the bed
        └──── out
    """

    name: str
    side: int
    """Sign of the first axis, along which it stands out."""
    face_mm: float
    """Distance of the wall from that axis' origin."""
    profile: tuple[Point, ...]
    """Its corners, out of the wall and up; below zero inside the wall."""
    opening: Box
    """For the tie: out of the wall, and up."""
    along_mm: tuple[float, float]
    """Its ends on the second axis."""
    wall_mm: float
    """Material round the opening, at least."""
    tie_mm: tuple[float, float]
    """Width and thickness of the tie."""

    @property
    def out_mm(self) -> float:
        """How far it stands out of the wall."""
        return max(out for out, _ in self.profile)
