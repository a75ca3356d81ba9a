"""What is printed, cast and wrapped, and with what.

Every length is in mm and in the sensor frame of the finger it belongs to, unless it says
otherwise.
"""

from dataclasses import dataclass

from lumitip_fab.design.shape import Box, Point


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
class Letter:
    """The first letter of the finger's name, sunk into an upright wall of a printed part.

    In the frame in which the part is printed. The wall looks along the second axis, so that the
    letter, read from before the wall, runs against the first.
    """

    box: Box
    """Along the first axis, and upward."""
    wall_mm: float
    """Where the wall stands on the second axis."""
    depth_mm: float


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
    letter: Letter
    """On the outside of the trough's end, which is where it says."""
    layer_mm: float
    """Of its print: the thickest, up to the printer's own, of which floor and stops are whole
    layers."""
    off_layer_mm: float
    """From the farther of floor and stops to a whole layer; 0 but where no layer divides both."""
    silicone: str
    density_g_ml: float
    mix_ratio: Point
    cure_h: float
    cure_c: float
    """Temperature to cure at (°C)."""
    waste_fraction: float


@dataclass(frozen=True)
class Printing:
    """Material and limits of the printed parts."""

    material: str
    density_g_ml: float
    min_wall_mm: float
    fit_mm: float
    """Added to every gap round board, metal and gripper, on each side."""
    line_mm: float
    layer_mm: float
    bed_mm: tuple[float, float, float]
