"""A gauge of the published layout, and frames of fingers with known deviations."""

from collections.abc import Mapping

import numpy as np

from lumitip.acceptance.gauge import Gauge
from lumitip.acceptance.response import NAMES, Response
from lumitip.acceptance.steps import Frames
from lumitip.layout import Layout
from lumitip.links.twin import published_layout
from lumitip.twin import Twin
from lumitip.twin.optics import FULL, values_of_drive

NOISE, STEADY = 1.5, 40


def record() -> dict:
    """The contents of a `gauge.json`."""
    lines = [("edge", 12.0, 0.0), ("edge", -12.0, 0.0), ("strip", 102.0, 3.0), ("strip", 78.0, 3.0)]
    return {
        "schema_version": 1,
        "design_hash": published_layout().design_hash,
        "gap_mm": 3.0,
        "placements": [
            {
                "name": f"{kind} on the {on}",
                "on": on,
                "kind": kind,
                "offset_mm": 0.0,
                "angle_deg": angle,
                "width_mm": width,
                "low_mm": low,
                "high_mm": low + 0.8,
            }
            for (kind, angle, width), on, low in zip(
                lines, ("receiver", "emitter") * 2, (2.2, 0.0) * 2, strict=True
            )
        ],
    }


class Bench:
    """Makes frames with the rays of the verdict itself, so that its answers are known."""

    def __init__(self, layout: Layout, gauge: Gauge) -> None:
        self._layout = layout
        self._response = Response(layout, gauge)
        self._twin = Twin(layout, self._response.model)

    def frames(self, deviations: Mapping[str, float] | None = None, seed: int = 0) -> Frames:
        """Frames of fingers with some deviations."""
        chance = np.random.default_rng(seed)
        off = np.zeros(len(self._response.priors))
        for name, value in (deviations or {}).items():
            off[NAMES.index(name)] = value
        drive, model = self._response.drive, self._response.model
        empty = values_of_drive(drive, model)
        gauge = self._response.values(off, drive) * empty / FULL
        dark = np.zeros(len(self._layout))
        return Frames(
            _read(np.tile(empty, (STEADY, 1)), chance),
            _read(np.tile(dark, (STEADY, 1)), chance),
            _read(self._sweeps(chance) * empty / FULL, chance),
            tuple(_read(np.tile(row, (STEADY, 1)), chance) for row in gauge),
        )

    def _sweeps(self, chance: np.random.Generator) -> np.ndarray:
        """A sheet's edge to and fro over all cells, in many directions."""
        offset = np.tile(np.linspace(-26.0, 26.0, 25), 12)
        angle = np.repeat(chance.permutation(12) * 30.0 + 4.0, 25)
        return self._twin.edges(offset, angle)


def _read(light: np.ndarray, chance: np.random.Generator) -> np.ndarray:
    noisy = light + NOISE * chance.standard_normal(light.shape)
    return np.clip(np.floor(noisy), 0.0, FULL).astype(np.float32)
