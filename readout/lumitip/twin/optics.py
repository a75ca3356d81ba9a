"""Optical parameters of a fingertip pair, `Model`, and its readout circuit.

    emitter   die ·        depth behind the mask: die / index + film, as seen from air
              ───   ───    mask, hole_mm
                 gap       object at height · gap above the receiver (0 receiver, 1 emitter)
              ───   ───    mask
    receiver  die ·

The figures that the publication does not give (alpha, knee_v, exponents, depths) are those that
reproduce its behaviour; the absolute radiometry of sibling datasheets is off by tens of times, so
one lumped `gain` stands for all of it.
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


_TABLED, _ENTRIES = 4.0, 8192  # drives below this one, in so many steps
_LIMITS = {"alpha": 1.0, "silicone_index": 3.0, "led_exponent": 100.0, "detector_exponent": 100.0}


class TwinError(LumitipError, ValueError):
    """A model, scene or fault that the twin cannot have."""


@dataclass(frozen=True)
class Model:
    """Optics and circuit of a fingertip pair; lengths in mm.

    Depths are equivalent ones, as seen from air: see `from_layout`.
    """

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
    """Share of light that silicone and film scatter, so that it comes from all of the hole."""
    knee_v: float = 0.05
    """Voltage V_s at which a saturating phototransistor gives way (V)."""
    supply_v: float = 3.3
    """Supply of the detectors (V)."""
    gain: float = 0.95
    """Photocurrent of the brightest cell at full light, as a share of what its pull-up carries.
    Above about 1 the detectors saturate; free cells of the published frame read up to 244 of 255,
    which 0.95 gives."""
    silicone_index: float = 1.41
    """Refractive index of the silicone, already within the depths; kept for `changed_index`."""

    def __post_init__(self) -> None:
        arguments.finite_fields(self, TwinError)
        for name in (
            "gap_mm",
            "hole_mm",
            "emitter_depth_mm",
            "detector_depth_mm",
            "knee_v",
            "supply_v",
            "gain",
        ):
            if not getattr(self, name) > 0.0:
                raise TwinError(f"{name} is {getattr(self, name)}; it must be above 0")
        for name, most in _LIMITS.items():
            least = 1.0 if name == "silicone_index" else 0.0
            if not least <= getattr(self, name) <= most:
                raise TwinError(f"{name} is {getattr(self, name)}; {least:g} to {most:g} is needed")
        if not isinstance(self.hole_shape, str) or self.hole_shape not in ("hexagon", "circle"):
            raise TwinError(
                f'hole_shape is {shown(self.hole_shape)}; allowed are "hexagon" and "circle"'
            )

    @classmethod
    def from_layout(cls, layout: Layout, gap_mm: float = GAP_MM, **changes: Any) -> "Model":
        """The model of a design: `layout.optics`, with single fields changed at will.

        A die at depth h in silicone of index n looks h / n deep from air; the film adds to it.

        Args:
            layout: what `lumitip-fab` built.
            gap_mm: from skin to skin (mm).
            changes: fields of `Model`; `silicone_index` also changes the depths.

        Raises:
            LayoutError: if it is no layout.
            TwinError: if there is no such field, or it cannot be so.
        """
        optics = arguments.layout(layout).optics
        _known(changes)
        index = arguments.number(
            changes.get("silicone_index", optics.silicone_index),
            "silicone_index",
            above=0.0,
            error=TwinError,
        )
        fields: dict[str, Any] = {
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
        return cls(**(fields | changes))

    def changed(self, **changes: Any) -> "Model":
        """The same with other fields; depths stay as they are.

        Raises:
            TwinError: if there is no such field, or it cannot be so.
        """
        _known(changes)
        return replace(self, **changes)

    def reversed(self) -> "Model":
        """Light the other way round: emitter and receiver change their parts."""
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
            raise TwinError(f"{name!r} is no field of a model; it has {', '.join(names)}")


def values_of_drive(drive: Floats, model: Model) -> Floats:
    """Values of the circuit from photocurrents: 0 to 255, high in light, any shape.

    The phototransistor works against the pull-up, (Vcc − V) / R = I (1 − exp(−V / V_s)), and the
    value is 255 (1 − V / Vcc).

    Args:
        drive: photocurrent I · R / Vcc, 0 in the dark, 1 where the pull-up carries no more.
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
    """The photocurrent (I · R / Vcc) that is read as these values, 0 to below 255."""
    drives, known = _curve(model.knee_v / model.supply_v)
    drive: Floats = np.interp(values, known, drives)
    return drive


@lru_cache(maxsize=16)
def _curve(knee: float) -> tuple[Floats, Floats]:
    # The drive is an explicit function of the voltage, so the curve is tabulated that way round,
    # closer where it bends.
    voltage = np.concatenate(
        [np.geomspace(1e-4 * knee, knee, 1500)[:-1], np.linspace(knee, 1.0, 3000)]
    )[::-1]
    drive = (1.0 - voltage) / -np.expm1(-voltage / knee)
    return drive, FULL * (1.0 - voltage)


@lru_cache(maxsize=16)
def _even_curve(knee: float) -> tuple[Floats, Floats]:
    # Entries at even steps of the drive are found without a search, ten times as fast.
    drives, values = _curve(knee)
    value = np.interp(np.arange(_ENTRIES + 1) * (_TABLED / _ENTRIES), drives, values)
    return value, np.diff(value, append=value[-1])
