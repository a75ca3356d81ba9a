"""`Model`: optics of a fingertip pair, and the circuit that reads it.

    emitter   die ·        depth behind the mask: die / index + film, as seen from air
              ───   ───    mask, hole_mm
                 gap       object at height · gap above the receiver (0 receiver, 1 emitter)
              ───   ───    mask
    receiver  die ·

Figures that the publication does not give (alpha, knee_v, exponents, depths) are chosen so that the
model reproduces its results. Absolute radiometry from the datasheets of similar parts is wrong by
tens of times, so one lumped `gain` replaces it.
"""

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from typing import Any

import numpy as np

from lumitip import arguments
from lumitip.errors import LumitipError
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.values import shown

FULL = 255.0
"""Value of full light."""
GAP_MM = 3.0
"""Default gap of a grasp (mm)."""
_TABLED, _ENTRIES = 4.0, 8192  # range of the even table of drives, and its steps
_LENGTHS = ("gap_mm", "hole_mm", "emitter_depth_mm", "detector_depth_mm")
_POSITIVE = (*_LENGTHS, "knee_v", "supply_v", "gain")
_LIMITS = {
    "alpha": (0.0, 1.0),
    "silicone_index": (1.0, 3.0),
    "led_exponent": (0.0, 100.0),
    "detector_exponent": (0.0, 100.0),
}


class TwinError(LumitipError, ValueError):
    """An invalid model, scene or fault."""


@dataclass(frozen=True)
class Model:
    """Optics and circuit of a fingertip pair; depths are equivalent ones, as seen from air."""

    gap_mm: float = GAP_MM
    """From the emitter's skin to the receiver's (mm)."""
    led_exponent: float = 1.0
    """Exponent m of the LED's radiant intensity, cos(angle) ** m."""
    detector_exponent: float = 2.0
    """Exponent n of the detector's sensitivity, cos(angle) ** n."""
    hole_mm: float = 2.5
    """Mask aperture: across flats of a hexagon, diameter of a circle (mm)."""
    hole_shape: str = "hexagon"
    """`"hexagon"` (flats face the tip) or `"circle"`."""
    emitter_depth_mm: float = 0.9 / 1.41 + 0.1
    """Equivalent depth of the LED die behind its hole (mm)."""
    detector_depth_mm: float = 0.9 / 1.41 + 0.1
    """Equivalent depth of the detector die behind its hole (mm)."""
    alpha: float = 0.6
    """Share of light that silicone and film scatter, so that it comes from the whole hole."""
    knee_v: float = 0.05
    """Knee voltage V_s of the saturating phototransistor (V)."""
    supply_v: float = 3.3
    """Supply of the detectors (V)."""
    gain: float = 0.95
    """Photocurrent of the brightest cell at full light, as a share of the largest current of its
    pull-up. Above about 1 the detectors saturate; with 0.95 free cells read 244 of 255, as in the
    published frame."""
    silicone_index: float = 1.41
    """Refractive index of the silicone; already included in the depths."""

    def __post_init__(self) -> None:
        arguments.finite_fields(self, TwinError)
        for name in _POSITIVE:
            arguments.number(getattr(self, name), name, above=0.0, error=TwinError)
        for name, (least, most) in _LIMITS.items():
            arguments.number(getattr(self, name), name, least, most, error=TwinError)
        if not isinstance(self.hole_shape, str) or self.hole_shape not in ("hexagon", "circle"):
            raise TwinError(
                f'hole_shape is {shown(self.hole_shape)}; "hexagon" or "circle" is needed'
            )

    @classmethod
    def from_layout(cls, layout: Layout, gap_mm: float = GAP_MM, **changes: Any) -> "Model":
        """The model of a design: `layout.optics`, with some fields changed.

        A die at depth h in silicone of index n has the equivalent depth h / n, plus the film.

        Args:
            layout: of the design.
            gap_mm: from skin to skin (mm).
            changes: fields of `Model`; `silicone_index` also changes the depths.

        Raises:
            LayoutError: if `layout` is no layout.
            TwinError: if a field is unknown or invalid.
        """
        optics = arguments.layout(layout).optics
        _known(changes)
        index = arguments.number(
            changes.get("silicone_index", optics.silicone_index),
            "silicone_index",
            above=0.0,
            error=TwinError,
        )
        values: dict[str, Any] = {
            "gap_mm": gap_mm,
            "led_exponent": optics.emitter_exponent,
            "detector_exponent": optics.detector_exponent,
            "hole_mm": optics.hole_mm,
            "hole_shape": optics.hole_shape,
            "emitter_depth_mm": optics.emitter_depth_mm / index + optics.film_mm,
            "detector_depth_mm": optics.detector_depth_mm / index + optics.film_mm,
            "silicone_index": index,
            "supply_v": optics.supply_v,
        }
        return cls(**(values | changes))

    def changed(self, **changes: Any) -> "Model":
        """The model with other fields; the depths stay.

        Raises:
            TwinError: if a field is unknown or invalid.
        """
        _known(changes)
        return replace(self, **changes)

    def reversed(self) -> "Model":
        """The model with emitter and receiver exchanged."""
        return replace(
            self,
            led_exponent=self.detector_exponent,
            detector_exponent=self.led_exponent,
            emitter_depth_mm=self.detector_depth_mm,
            detector_depth_mm=self.emitter_depth_mm,
        )


def _known(changes: Iterable[str]) -> None:
    names = [field.name for field in fields(Model)]
    for name in changes:
        if name not in names:
            raise TwinError(f"a model has no field {name!r}; it has {', '.join(names)}")


def values_of_drive(drive: Floats, model: Model) -> Floats:
    """Values that the circuit reads of photocurrents: 0 to 255, high in light, any shape.

    Phototransistor and pull-up: (Vcc − V) / R = I (1 − exp(−V / V_s)); the value is
    255 (1 − V / Vcc).

    Args:
        drive: photocurrent I · R / Vcc, 0 in the dark, 1 at the largest current of the pull-up.
        model: knee and supply.
    """
    knee = model.knee_v / model.supply_v
    if drive.size and float(drive.max()) >= _TABLED:
        drives, values = _curve(knee)
        read: Floats = np.interp(drive, drives, values)
        return read
    value, growth = _even_curve(knee)
    way = np.maximum(drive, 0.0) * (_ENTRIES / _TABLED)
    entry = way.astype(np.int64)
    looked_up: Floats = value[entry] + growth[entry] * (way - entry)
    return looked_up


def drive_of_values(values: Floats, model: Model) -> Floats:
    """Photocurrents (I · R / Vcc) that are read as these values, 0 to below 255."""
    drives, known = _curve(model.knee_v / model.supply_v)
    drive: Floats = np.interp(values, known, drives)
    return drive


@lru_cache(maxsize=16)
def _curve(knee: float) -> tuple[Floats, Floats]:
    # The drive is an explicit function of the voltage; the table is denser at the knee.
    voltage = np.concatenate(
        [np.geomspace(1e-4 * knee, knee, 1500)[:-1], np.linspace(knee, 1.0, 3000)]
    )[::-1]
    drive = (1.0 - voltage) / -np.expm1(-voltage / knee)
    return drive, FULL * (1.0 - voltage)


@lru_cache(maxsize=16)
def _even_curve(knee: float) -> tuple[Floats, Floats]:
    # Even steps of the drive need no search: ten times as fast.
    drives, values = _curve(knee)
    value = np.interp(np.arange(_ENTRIES + 1) * (_TABLED / _ENTRIES), drives, values)
    return value, np.diff(value, append=value[-1])
