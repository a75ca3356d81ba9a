"""The section on the mask, and the apertures that it gives the cells."""

from typing import Annotated, Literal

from pydantic import Field

from lumitip_fab.catalogue.record import Name, Strict


class Mask(Strict):
    """The black sheet with an aperture above each cell."""

    route: Literal["film", "tpu", "cut"]
    """How it is made: `"film"`, printed on a clear film; `"tpu"`, a sheet with holes from a 3D
    printer; `"cut"`, cut from an opaque film. Files for all three are written; thickness, notes,
    bill and manual follow the route."""
    film: Name
    """Name of a film in `parts/films.toml`: a clear one to print on, an opaque one to cut. Not used
    with `route = "tpu"`."""
    filament: Name
    """Name of the sheet's filament in `parts/filaments.toml`."""
    layers: int = Field(ge=1, le=3)
    """Layers of the printed sheet, each as high as the printer's. From two layers on, its folds are
    grooves that leave one."""
    hole_mm: float = Field(ge=0.3, le=20)
    """Aperture above each cell: across flats of a hexagon, diameter of a circle (mm)."""
    cell_holes_mm: tuple[Annotated[float, Field(ge=0.3, le=20)], ...]
    """Aperture of each cell (mm), in place of `hole_mm`, where they differ: by columns from the
    left of the receiver, in each from the tip down, as in frames. Empty: all have `hole_mm`."""
    hole_shape: Literal["hexagon", "circle"]
    """Shape of the apertures; flats of hexagons face the tip."""
    measured_ruler_mm: tuple[
        Annotated[float, Field(ge=90, le=110)], Annotated[float, Field(ge=90, le=110)]
    ]
    """Length of the printed 100 mm rulers, horizontal and vertical, as your printer drew them on
    a page made with `[100.0, 100.0]` (mm); the next page is scaled to come out true."""
    allowance_mm: float = Field(ge=0, le=20)
    """Finger outline to the first fold, for the mask's bend (mm)."""
    flap_mm: float = Field(ge=3, le=40)
    """Length of the fold flaps, where coupling and notch leave room (mm)."""

    def holes_mm(self, cells: int) -> tuple[float, ...]:
        """Aperture of each of so many cells."""
        own = self.cell_holes_mm
        return own if len(own) == cells else (self.hole_mm,) * cells

    @property
    def extremes_mm(self) -> tuple[float, float]:
        """The smallest and the largest aperture."""
        sizes = self.cell_holes_mm or (self.hole_mm,)
        return min(sizes), max(sizes)

    @property
    def holes_field(self) -> str:
        """The field that the apertures come from."""
        return "mask.cell_holes_mm" if self.cell_holes_mm else "mask.hole_mm"

    @property
    def holes_text(self) -> str:
        """Its value, for messages."""
        least, most = self.extremes_mm
        return f"has {least:g} to {most:g}" if self.cell_holes_mm else f"is {self.hole_mm:g}"

    @property
    def mean_text(self) -> str:
        """What a limit of neighbours' apertures is of, for messages."""
        return " as the mean of two neighbours" if self.cell_holes_mm else ""
