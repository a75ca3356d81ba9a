"""How the parts are made: printed, cast, wrapped and heated, with their materials and masses."""

import re
from dataclasses import dataclass

from lumitip_fab.design.shape import Box, Point

LEDGE_MM = 0.5
"""Between the weir and the trough of a mould."""

TIP_STOP_FRACTION, MOST_TIP_STOP_FRACTION, LEAST_TIP_STOP_MM = 1 / 6, 1 / 3, 4.0


def tip_stop_mm(tip_width_mm: float) -> float:
    """Width of the stop under the middle of a straight tip edge (mm), on which a finger stands in
    its mould; the rest keeps its silicone."""
    wanted_mm = max(TIP_STOP_FRACTION * tip_width_mm, LEAST_TIP_STOP_MM)
    return min(wanted_mm, MOST_TIP_STOP_FRACTION * tip_width_mm)


FOOT_CHAMFER_MM = 0.4
"""Of mould and clamp where they stand on the bed: the first layer spreads."""

FOLD_OFF_MM = 0.3
"""Of a mask's straight fold from the finger's outline grown by the allowance, at most."""


@dataclass(frozen=True)
class Sheet:
    """The mask as a printed sheet: the film's outline, its holes and folds, without any print."""

    filament: str
    layers: int
    layer_mm: float
    line_mm: float
    hole_loss_mm: float
    """By what a hole is drawn wider than its aperture, since the print loses it."""
    fold_mm: float
    """Width of the groove along each fold; 0 without grooves, in a single layer."""
    letter: bool
    """Whether the first letter of the finger's name is sunk into the inside: in more than one
    layer, with strokes as wide as a line."""

    @property
    def thickness_mm(self) -> float:
        """Height of all layers."""
        return round(self.layers * self.layer_mm, 6)


@dataclass(frozen=True)
class MaskShift:
    """Largest shift of both masks against their fingers, in any direction; simulated."""

    most_mm: float
    good_percent: float
    """Share of the fingers that then meet the goals (%)."""
    position_mm: float
    """Goal of the position of edges and cables, rms (mm)."""
    angle_deg: float
    """Goal of their angle (degrees)."""


@dataclass(frozen=True)
class Mask:
    """The mask in the finger's frame, but for the page that it is printed on."""

    route: str
    """`"film"`, `"tpu"` or `"cut"`."""
    holes_mm: tuple[float, ...]
    """Aperture of each cell, in frame order: across flats, or the diameter."""
    hole_shape: str
    """Of film and printed sheet; a plotter cuts circles."""
    allowance_mm: float
    flap_mm: float
    film: str
    soften_c: float
    measured_ruler_mm: Point
    registration: tuple[Point, ...]
    """Marks round the artwork, in both x and -x, so the same on the page and in the frame."""
    mark: Box
    """Box of the letter F on the tip flap, which distinguishes a mirror image from half a turn."""
    sheet: Sheet
    coupon: Box
    """A piece of the mask's material without holes that covers all cells of the receiver."""
    shift: MaskShift | None = None
    """How far both masks may be off their fingers; none where it was not computed."""

    @property
    def sizes_text(self) -> str:
        """Size of its apertures, or the smallest and the largest (mm)."""
        least, most = min(self.holes_mm), max(self.holes_mm)
        return f"{least:g}" if least == most else f"{least:g} to {most:g}"

    @property
    def material(self) -> str:
        """Title of what it is made of by its route."""
        return self.sheet.filament if self.route == "tpu" else self.film


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
    bridge_mm: float
    """Longest line that may hang over nothing."""


@dataclass(frozen=True)
class Interface:
    """The rigid part between a bendable plate and the gripper, glued to the plate's back.

    Its front is a pad on the plate's back, with a rim that stands in a groove of the plate. Seen
    from the front, rim and groove are a U that is open at the gripper end:

        ╭───────────╮  groove.y_max
        │ ╭───────╮ │
        │ │  pad  │ │
        │ │       │ │
          notch       gripper end
    """

    groove: Box
    """Outer edge of the groove, from the gripper end."""
    groove_mm: float
    groove_depth_mm: float
    glue_mm: float
    """Nominal gap between rim and groove: on each side, and at the groove's floor."""
    gap_mm: float
    """On each side as drawn: the printer's fit is in it, by which the rim is narrower."""
    pad_mm: float
    """Thickness of the pad."""
    thread_hole_mm: float
    """Holes through the plate, behind those of the board, through which it is tied on."""
    letter: Letter
    """On the plate's back: the frame is the mount's, without its tilt."""

    @property
    def box(self) -> Box:
        """The pad, as wide as the rim's outer edge."""
        g, gap = self.groove, self.gap_mm
        return Box(g.x_min_mm + gap, g.x_max_mm - gap, g.y_min_mm, g.y_max_mm - gap)

    @property
    def rim_mm(self) -> float:
        """Width of the rim."""
        return self.groove_mm - 2 * self.gap_mm

    @property
    def rim_height_mm(self) -> float:
        """Height of the rim over the pad."""
        return self.groove_depth_mm - self.glue_mm


@dataclass(frozen=True)
class HeatedPart:
    """A part that a step heats."""

    name: str
    """`"backing"`, `"board"`, `"film"`, `"glue"`, `"insert"`, `"insulation"`, `"interface"`,
    `"mask"`, `"mould"`, `"primer"`, `"silicone"`, `"tape"` or `"thread"`."""
    material: str
    limit_c: float
    """Highest temperature that its material bears in this step (°C)."""

    @property
    def title(self) -> str:
        """Its name and material, such as "board of FR-4"; a material that says what it is alone."""
        alone = self.name in self.material
        return self.material if alone else f"{self.name} of {self.material}"


@dataclass(frozen=True)
class HeatStep:
    """A step that heats parts, all of them to one temperature."""

    name: str
    """`"solder"`, `"cure"`, `"crease"` or `"use"`."""
    place: str
    """Description of the heated object, for the manual."""
    temperature_c: float
    """Highest temperature that a part reaches (°C)."""
    parts: tuple[HeatedPart, ...]

    @property
    def weakest(self) -> HeatedPart:
        """The part that bears the least heat."""
        return min(self.parts, key=lambda part: part.limit_c)

    @property
    def limit_c(self) -> float:
        """The lowest limit of its parts (°C)."""
        return self.weakest.limit_c


@dataclass(frozen=True)
class Filament:
    """A filament, as it is printed."""

    name: str
    kind: str
    density_g_ml: float
    nozzle_c: int
    bed_c: int
    fan_percent: tuple[int, int]
    speed_mm_s: float
    max_flow_mm3_s: float
    retract_mm: float
    layer_mpa: float
    """Tensile strength from layer to layer."""
    plane_mpa: float
    """Tensile strength within a layer."""
    bearing_mpa: float
    """Compressive strength of a solid print."""
    layer_mm: float
    part: str = ""
    """The only part printed in such layers; empty for everything of this filament."""

    @property
    def first_nozzle_c(self) -> int:
        """Nozzle temperature of the first layer, which is to stick."""
        return self.nozzle_c + 5

    @property
    def file(self) -> str:
        """Path of its settings below the output folder."""
        name = f"{self.name} {self.part}".lower()
        return f"print/{re.sub(r'[^a-z0-9]+', '_', name).strip('_')}.ini"


@dataclass(frozen=True)
class Slicing:
    """Filament of each printed part, and the nozzle."""

    nozzle_mm: float
    backing: Filament
    rigid: Filament
    """Filament of everything but backings and moulds."""
    mould: Filament
    """As `rigid`, in layers that the mould's heights are whole multiples of."""
    sheet: Filament
    """Filament of the mask's printed sheet."""

    @property
    def filaments(self) -> tuple[Filament, ...]:
        """Each once."""
        return tuple(dict.fromkeys((self.backing, self.rigid, self.mould, self.sheet)))

    def of(self, path: str) -> Filament:
        """Filament of a part, by its path below the output folder."""
        kinds = {"backing": self.backing, "mould": self.mould, "mask": self.sheet}
        return kinds.get(path.partition("/")[0], self.rigid)


@dataclass(frozen=True)
class Densities:
    """Densities of a finger's layers and parts, and of the boards."""

    backing_g_ml: float
    interface_g_ml: float
    """Density of the interface that holds a bendable backing."""
    board_g_ml: float
    """Density of the fingers' boards, with copper."""
    auxiliary_g_ml: float
    """Density of the boards outside the fingers."""
    part_g_ml: float
    """Density of the small parts on the fingers' boards: moulded or ceramic, as dense as the
    laminate of a rigid board (assumed)."""
    silicone_g_ml: float
    film_g_ml: float
