"""Sheets of the publication, each by one transmittance that is fitted to its published mean.

This is a calibration, no validation: one free number to each mean fits by construction. What the
twin adds is that the transmittances then serve at any gap, in any shape and for any design.
"""

from dataclasses import dataclass

from lumitip.twin.optics import TwinError
from lumitip.twin.scene import Sheet
from lumitip.values import shown

MEASURED_GAP_MM = 6.0
"""Gap at which the publication measured its materials (mm)."""


@dataclass(frozen=True)
class Material:
    """A sheet that the publication measured."""

    key: str
    """Short name, for addresses and tables."""
    name: str
    clear: float
    diffuse: float
    published_mean: float
    """Of all cells, 0 to 255."""
    published_bar: float | None
    """The published error bar, where there is one."""

    def sheet(self, height: float = 0.5) -> Sheet:
        """A sheet of it that covers everything."""
        return Sheet(clear=self.clear, diffuse=self.diffuse, height=height)


MATERIALS = (
    Material("cardboard", "cardboard", 0.0, 0.025, 6.0, None),
    Material("towel", "hand towel", 0.0, 0.305, 72.5, 9.7),
    Material("paper", "paper, 70 g/m²", 0.0, 0.411, 97.7, 9.3),
    Material("napkin", "white napkin", 0.0, 0.489, 116.2, 12.6),
    Material("bag", "ziplock bag", 0.872, 0.0, 223.1, 9.3),
)


def material(key: str) -> Material:
    """The material of a key.

    Raises:
        TwinError: if there is none.
    """
    for one in MATERIALS:
        if isinstance(key, str) and one.key == key:
            return one
    raise TwinError(f"material is {shown(key)}; allowed are {', '.join(m.key for m in MATERIALS)}")
