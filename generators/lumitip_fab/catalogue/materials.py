"""Catalogue entries of materials, of printers, and of screws and nuts."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from lumitip_fab.catalogue.record import Entry, Length, Name, Share, Sourced, Strict


class Laminate(Sourced):
    """Core and copper of a board with two layers."""

    density_g_ml: float = Field(ge=0.5, le=5)
    """Density without copper."""
    copper_mm: Length
    """Thickness of the copper on each side."""
    modulus_mpa: float = Field(gt=0, le=100000)
    """Young's modulus."""
    most_strain: float = Field(gt=0, le=0.05)
    """Most that its surface may be strained, with parts soldered on."""
    limit_c: float = Field(ge=60, le=400)
    """Highest temperature that it bears for hours: its glass transition, or its adhesive's (°C)."""
    solder_c: float = Field(ge=100, le=400)
    """Highest temperature that it bears for the seconds of soldering (°C)."""


class Laminates(Strict):
    """One for each kind of board."""

    rigid: Laminate
    flexible: Laminate


Substance = Literal[
    "sulphur",
    "latex",
    "amine",
    "uncured polyurethane",
    "PVC",
    "tin compounds",
    "masking tape adhesive",
]
"""Substances that keep silicones with a platinum catalyst from curing."""
_Percent = Annotated[int, Field(ge=0, le=100)]


class Filament(Entry):
    """A filament of 1.75 mm."""

    kind: Literal["ABS", "ASA", "FLEX", "PA", "PC", "PET", "PLA", "PP"]
    """Its kind in PrusaSlicer."""
    density_g_ml: float = Field(ge=0.5, le=3)
    """Density."""
    nozzle_c: int = Field(ge=150, le=450)
    """Temperature of the nozzle (°C)."""
    bed_c: int = Field(ge=0, le=150)
    """Temperature of the bed (°C)."""
    fan_percent: tuple[_Percent, _Percent]
    """Least and most that the fan blows."""
    speed_mm_s: float = Field(ge=5, le=300)
    """Speed of perimeters; outer ones and the first layer go slower."""
    max_flow_mm3_s: float = Field(ge=0.5, le=50)
    """Largest volume that the nozzle melts each second."""
    retract_mm: float = Field(ge=0, le=10)
    """Retraction before a move."""
    layer_mpa: float = Field(gt=0, le=500)
    """Tensile strength from layer to layer."""
    plane_mpa: float | None = Field(default=None, gt=0, le=500)
    """Tensile strength within a layer, at 45° to its lines; left out, that from layer to layer."""
    bearing_mpa: float = Field(gt=0, le=500)
    """Compressive strength of a solid print."""
    modulus_mpa: float = Field(gt=0, le=20000)
    """Young's modulus of a solid print."""
    limit_c: float = Field(ge=30, le=300)
    """Highest temperature at which a printed part keeps its shape (°C): the lower end of its
    heat deflection temperature."""
    rigid_parts: Name | None = None
    """For a flexible filament: the filament of rigid parts, such as moulds."""
    hole_loss_mm: float = Field(default=0.0, ge=0, le=0.5)
    """How much smaller than drawn a hole of some millimetres is printed, in diameter, as measured;
    holes of a printed mask are drawn so much larger (mm)."""

    @model_validator(mode="after")
    def _fan_in_order(self) -> Self:
        if self.fan_percent[0] > self.fan_percent[1]:
            raise ValueError(f"fan_percent is {self.fan_percent}; the smaller value comes first")
        return self


class Fastener(Entry):
    """A metric thread with the heads and the nut that go with it."""

    thread_mm: Length
    """Outer diameter of the thread."""
    hole_mm: tuple[Length, Length]
    """Clearance holes by ISO 273: fine and coarse."""
    cap_head_mm: Length
    """Diameter of the head of a socket head cap screw, ISO 4762."""
    countersunk_mm: Length
    """Diameter of the head of a countersunk screw, ISO 7046."""
    nut_mm: Length
    """Width of a nut across flats, ISO 4032."""
    nut_height_mm: Length
    """Height of a nut, ISO 4032."""

    @model_validator(mode="after")
    def _goes_through(self) -> Self:
        fine, coarse = self.hole_mm
        if not self.thread_mm < fine <= coarse:
            raise ValueError(
                f"hole_mm is [{fine:g}, {coarse:g}]; both must be more than thread_mm = "
                f"{self.thread_mm:g}, the smaller first"
            )
        if min(self.cap_head_mm, self.countersunk_mm, self.nut_mm) <= coarse:
            raise ValueError(
                f"cap_head_mm is {self.cap_head_mm:g}, countersunk_mm is {self.countersunk_mm:g}, "
                f"nut_mm is {self.nut_mm:g}; each must be more than the coarse hole of {coarse:g}"
            )
        return self


class Silicone(Entry):
    """A two-part casting silicone."""

    density_g_ml: float = Field(gt=0.5, le=3)
    """Density of the mixture."""
    mix_ratio: tuple[Share, Share]
    """Parts A and B by mass."""
    refractive_index: float = Field(ge=1.0, le=2.0)
    """Refractive index when cured."""
    cure_h: float = Field(gt=0, le=200)
    """Time to cure at `cure_c` (h)."""
    cure_c: float = Field(ge=5, le=200)
    """Temperature to cure at, in the mould with backing and board (°C)."""
    limit_c: float = Field(ge=20, le=400)
    """Highest temperature that it withstands when cured (°C)."""
    inhibited_by: tuple[Substance, ...]
    """Substances that keep it from curing where it touches them."""
    pot_life_min: float | None = Field(default=None, ge=1, le=2000)
    """Time for which it can be worked once it is mixed, at room temperature (min); none where it is
    not known."""
    needs_primer: bool
    """Whether it holds on printed plastics and boards by a primer alone."""


class Adhesive(Entry):
    """A glue between parts of a finger."""

    shear_mpa: float = Field(gt=0, le=100)
    """Lap shear strength on the parts that it holds here."""
    lap_mm: Length
    """Overlap of the test joint that gave it."""
    gives_off: tuple[Substance, ...] = ()
    """Substances in it that may keep a silicone from curing."""
    hard_h: float | None = Field(default=None, ge=0.1, le=200)
    """Time after which it is hard and harmless under a primer (h); none where it never is."""
    limit_c: float = Field(ge=20, le=300)
    """Highest temperature at which a hard joint holds, for hours (°C)."""


class Primer(Entry):
    """A primer between a part and the silicone that is cast on it."""

    coverage_cm2_ml: float = Field(gt=0, le=1000)
    """Area that a millilitre covers (cm²)."""
    dry_min: float = Field(ge=0, le=1440)
    """Time to dry before the silicone is poured (min)."""
    limit_c: float = Field(ge=20, le=400)
    """Highest temperature that it bears when dry, for hours (°C)."""


class Tape(Entry):
    """A tape that closes windows while the silicone is cast."""

    width_mm: Length
    """Width."""
    limit_c: float = Field(ge=20, le=400)
    """Highest temperature at which it holds and comes off clean, for hours (°C)."""
    gives_off: tuple[Substance, ...] = ()
    """Substances in it that may keep a silicone from curing."""


class Film(Entry):
    """A film for the mask: clear, to print on, or opaque, to cut; or for the mould's floor."""

    thickness_mm: Length
    """Thickness."""
    density_g_ml: float = Field(gt=0.5, le=3)
    """Density (g/mL)."""
    soften_c: float = Field(gt=20, le=200)
    """Temperature at which it can be creased (°C)."""
    limit_c: float = Field(gt=20, le=300)
    """Highest temperature that it bears without melting or shrinking (°C)."""
    opaque: bool = False
    """Whether it lets no light through, infrared included."""
    smooth: bool = False
    """Whether both faces are as smooth as glass, and silicone cures on them and peels off them."""


class Printer(Entry):
    """A 3D printer with its nozzle: what the walls can be."""

    nozzle_mm: Length
    """Bore of the nozzle."""
    line_mm: Length
    """Width of one extruded line."""
    layer_mm: Length
    """Height of one layer."""
    bed_mm: tuple[Length, Length, Length]
    """Print volume."""
    bridge_mm: Length
    """Longest line over nothing that does not sag away: a bridge, or an edge of a layer."""
