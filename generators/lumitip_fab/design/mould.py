"""The silicone mould, and what is poured into it."""

from dataclasses import dataclass

from lumitip_fab.design.clamp import Clamp
from lumitip_fab.design.insert import Insert
from lumitip_fab.design.making import Letter
from lumitip_fab.design.prop import Prop
from lumitip_fab.design.shape import Outline, Point, Tip

MOULDS = 2
"""To print: both fingers cure at once, each in its own mould, with what holds and tilts it."""


@dataclass(frozen=True)
class Grip:
    """The gaps in both side walls, in which the plate is taken between two fingers."""

    y_min_mm: float
    y_max_mm: float
    """Ends of their flat bottoms, in the sensor frame; they open wider upward."""
    bottom_mm: float
    """Over the rim plane."""
    over_level_mm: float
    """From the silicone's level to a bottom, at least: it creeps up the slit round the plate."""

    @property
    def centre_y_mm(self) -> float:
        """Their middle, in the sensor frame."""
        return (self.y_min_mm + self.y_max_mm) / 2


@dataclass(frozen=True)
class Mould:
    """The silicone mould and what is poured into it."""

    taper_length_mm: float
    tip_silicone_mm: float
    end_round_mm: float
    """Rounding of the skin at the gripper end."""
    wall_gap_mm: float
    draft_deg: float
    guided_mm: float
    """How far its wall reaches along the plate's side, over the rim plane."""
    wall_mm: float
    """Thickness of its walls, and of its floor, under an insert too."""
    outside_mm: float
    """From the outline to the outside of its wall, at its top."""
    weir_y_mm: float
    """Outer edge of the weir, where the trough begins, in the sensor frame."""
    inserts: tuple[Insert, ...]
    """The smooth film on its floor; none if the file names none, or there is no room for it."""
    props: tuple[Prop, ...]
    """Tilts it for a skin that is wrapped round the tip; none for another."""
    grip: Grip
    pads: tuple[Point, ...]
    """Hard stops on the plate's rim, beside the board."""
    pad_mm: float
    letter: Letter
    """On the outside of the trough's end, which is where it says."""
    layer_mm: float
    """Layer thickness of its print: the thickest, up to the printer's own, that divides floor,
    recess and stops into whole layers."""
    off_layer_mm: float
    """From the farthest of them to a whole layer; 0 but where no layer divides all."""
    silicone: str
    density_g_ml: float
    mix_ratio: Point
    pot_life_min: float
    """Time for which the mixed silicone can be worked; 0 where it is not known."""
    cure_h: float
    cure_c: float
    """Temperature to cure at (°C)."""
    waste_fraction: float
    inhibited_by: tuple[str, ...]
    """Substances that keep the silicone from curing."""
    primer: str
    """Title of the primer under it; empty without one."""
    primer_dry_min: float
    """Time that the primer dries; 0 without one."""
    tape: str
    """Title of the tape over windows and holes of the back."""
    glue_hard_h: float
    """Time until the glue is hard, where it meets the silicone; else 0."""

    @property
    def trial_g(self) -> Point:
        """Parts A and B to mix for a trial of a few drops: the smaller one is 1 g."""
        a, b = (part / min(self.mix_ratio) for part in self.mix_ratio)
        return a, b

    @property
    def floor_mm(self) -> float:
        """The silicone's face over the bed: beside an insert, and on it."""
        return self.wall_mm + sum(insert.thickness_mm for insert in self.inserts)

    def level_mm(self, y_mm: float) -> float:
        """Height of the silicone over the rim plane, as the mould stands while it cures."""
        return sum(prop.level_mm(y_mm) for prop in self.props)

    @property
    def level_slope(self) -> float:
        """Height that this level gains for each mm towards the tip."""
        return sum(prop.slope for prop in self.props)

    def lip_length_mm(self, outline: Outline, tip: Tip) -> float:
        """From the tip edge to where the silicone's level meets the back of the plate."""
        over = self.level_mm(outline.tip_y_mm) - tip.edge_mm
        return over / (self.level_slope + tip.slope) if self.props else 0.0

    def stops_mm(self, cover_mm: float) -> float:
        """Height of the stops over the bed, by the silicone's cover of the plate."""
        return self.floor_mm + cover_mm


def printed_times(mould_accessories: tuple[Clamp | Prop, ...], path: str) -> int:
    """How often a part is printed for a pair of fingers, by the path of its STL."""
    return MOULDS if path in {part.file for part in mould_accessories} else 1
