"""Light that an object takes from each cell at any gap and scattered share, quickly.

The twin's planes and tables are computed once at a few gaps and shares, apart for the light of a
cell's own LED and for that of the others. Between the gaps the light is linear, in the scattered
share it is quadratic, as in the twin: light is scattered at both ends or not.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import LineTable, Model
from lumitip.twin.pairs import Emitter, Pairs
from lumitip.twin.raster import Plane, direct_plane
from lumitip.twin.scene import Singles
from lumitip.twin.tables import cable_table

GAPS_MM = (2.0, 3.0, 4.0, 5.0, 6.0)
ALPHAS = (0.2, 0.6, 1.0)
DIAMETER_MM = 3.0
"""Diameter of the published cable (mm)."""


@dataclass(frozen=True)
class Parts:
    """Light of each cell from its own LED and from the others, both of shape `(cells,)`."""

    own: Floats
    others: Floats

    def together(self, crosstalk: float) -> Floats:
        """The light of both, with the others' taken `crosstalk` times."""
        return self.own + crosstalk * self.others


@dataclass(frozen=True)
class _Node:
    """Planes, tables and full light at one gap and scattered share: own LED, other LEDs."""

    full: tuple[Floats, Floats]
    planes: tuple[Singles, Singles]
    tables: tuple[LineTable, LineTable]

    def uncovered(self, part: int) -> Floats:
        """All of the light."""
        return np.ones(self.full[part].size)


class RealLight:
    """Light that reaches the cells, and that an opaque object takes."""

    def __init__(self, layout: Layout, alphas: tuple[float, ...] = ALPHAS) -> None:
        self.layout, self._alphas = layout, alphas
        planes: list[Plane] = []
        nodes = []
        for gap_mm in GAPS_MM:
            for alpha in alphas:
                emitter = Emitter(Model.from_layout(layout, gap_mm, alpha=alpha))
                split = _split(Pairs.of(layout, emitter))
                planes += [direct_plane(layout, pairs, emitter, 0.5) for pairs in split]
                nodes.append([(pairs.full, cable_table(pairs, DIAMETER_MM)) for pairs in split])
        places = [plane.x_mm + 1j * plane.y_mm for plane in planes]
        pixels = np.unique(np.concatenate(places))
        self.x_mm, self.y_mm = pixels.real.astype(np.float64), pixels.imag.astype(np.float64)
        self.pixel_mm = planes[0].pixel_mm
        dense = []
        for plane, at in zip(planes, places, strict=True):
            weights = np.zeros((len(layout), pixels.size), np.float32)
            weights[:, np.searchsorted(pixels, at)] = plane.weights
            dense.append(weights)
        self._nodes = [
            _Node(
                (own[0], others[0]),
                (dense[2 * i], dense[2 * i + 1]),
                (own[1], others[1]),
            )
            for i, (own, others) in enumerate(nodes)
        ]

    def full(self, gap_mm: float, alpha: float) -> Parts:
        """Light with nothing in the gap."""
        return self._mean(gap_mm, alpha, _Node.uncovered)

    def covered(self, coverage: Floats, gap_mm: float, alpha: float) -> Parts:
        """Light that a coverage of the pixels takes, halfway up the gap."""
        single = coverage.astype(np.float32)

        def share(node: _Node, part: int) -> Floats:
            return np.asarray(node.planes[part] @ single, np.float64)

        return self._mean(gap_mm, alpha, share)

    def cable(self, angle_deg: Floats, left_mm: Floats, gap_mm: float, alpha: float) -> Parts:
        """Light that a cable takes: its direction beside each cell, and the cells' distances."""
        return self._mean(gap_mm, alpha, lambda node, part: node.tables[part](angle_deg, left_mm))

    def _mean(self, gap_mm: float, alpha: float, share: Callable[[_Node, int], Floats]) -> Parts:
        below = min(int(np.searchsorted(GAPS_MM, gap_mm, side="right")) - 1, len(GAPS_MM) - 2)
        up = (gap_mm - GAPS_MM[below]) / (GAPS_MM[below + 1] - GAPS_MM[below])
        light = np.zeros((2, len(self.layout)))
        for gap, by_gap in ((below, 1.0 - up), (below + 1, up)):
            for number, by_alpha in enumerate(self._by_alpha(alpha)):
                node = self._nodes[gap * len(self._alphas) + number]
                for part in (0, 1):
                    light[part] += by_gap * by_alpha * node.full[part] * share(node, part)
        return Parts(light[0], light[1])

    def _by_alpha(self, alpha: float) -> list[float]:
        nodes = self._alphas
        return [
            float(np.prod([(alpha - other) / (node - other) for other in nodes if other != node]))
            for node in nodes
        ]


def _split(pairs: Pairs) -> tuple[Pairs, Pairs]:
    """The pairs of each cell with its own LED, and with the others."""
    facing = np.array([x == y == 0.0 for _, x, y, _ in pairs.kinds])[pairs.kind]
    own, others = (
        Pairs(pairs.cells, pairs.cell[some], pairs.kind[some], pairs.kinds)
        for some in (facing, ~facing)
    )
    return own, others
