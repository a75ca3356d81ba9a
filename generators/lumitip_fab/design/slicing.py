"""What the slicer is told."""

import re
from dataclasses import dataclass


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
    bearing_mpa: float
    """Compressive strength of a solid print."""
    layer_mm: float
    part: str = ""
    """What alone is printed in such layers; without a name everything that is of this filament."""

    @property
    def file(self) -> str:
        """Path of its settings below the output folder."""
        name = f"{self.name} {self.part}".lower()
        return f"print/{re.sub(r'[^a-z0-9]+', '_', name).strip('_')}.ini"


@dataclass(frozen=True)
class Slicing:
    """What is printed from what, and the nozzle."""

    nozzle_mm: float
    backing: Filament
    rigid: Filament
    """Of everything but backings and moulds."""
    mould: Filament
    """As `rigid`, in layers that the mould's heights are whole multiples of."""

    @property
    def filaments(self) -> tuple[Filament, ...]:
        """Each once."""
        return tuple(dict.fromkeys((self.backing, self.rigid, self.mould)))

    def of(self, path: str) -> Filament:
        """What a part is printed from, by its path below the output folder."""
        kinds = {"backing": self.backing, "mould": self.mould}
        return kinds.get(path.partition("/")[0], self.rigid)
