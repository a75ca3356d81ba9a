"""`Stacked`: both printed parts of the flange and its board, as their files have them, in the
frame of the flange."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import ReadCarrier
from lumitip_fab.checks.fasteners import Figures
from lumitip_fab.checks.printed import farthest
from lumitip_fab.checks.result import Measurement
from lumitip_fab.checks.solids import Vectors, cast, section
from lumitip_fab.design import Design, Flange, Point
from lumitip_fab.frames import applied, carrier_to_flange

CONTACTS = "J1"  # on the board's back, towards the robot
REACH_MM = 100.0


@dataclass(frozen=True, eq=False)
class Stacked:
    """The flange as it was read."""

    lower: Any
    """Mesh of the lower part."""
    upper: Any
    """Mesh of the upper part."""
    board: ReadCarrier
    flange: Flange
    design: Design

    def figure(
        self, check: str, measured: float, low: float, high: float, unit: str = "mm", note: str = ""
    ) -> Measurement:
        """A measurement of both files."""
        return Measurement(
            f"flange.{check}", "flange/*.stl", float(measured), low, high, unit, note
        )

    def near(
        self, check: str, measured: Any, wanted: float, by: float, note: str = ""
    ) -> Measurement:
        """The value that strays farthest from what is wanted; NaN if one could not be taken."""
        worst = farthest(np.atleast_1d(np.asarray(measured, dtype=np.float64)), wanted)
        return self.figure(check, worst, wanted - by, wanted + by, note=note)

    def clear(self, check: str, found: Figures) -> Measurement:
        """Room round a fastener."""
        measured, low, high, note = found
        return self.figure(check, measured, low, high, note=note)

    @property
    def gap_mm(self) -> float:
        """Wanted from the printed parts to coupling, gripper and board, by the printer's fit."""
        return self.flange.clearance_mm + self.design.printing.fit_mm

    def places(self, page: list[Point]) -> Vectors:
        """Places on the board's page, shape `(n, 2)`."""
        on_board = self.board.sensor(page)
        return applied(carrier_to_flange(self.flange), on_board)[:, :2]

    def pads(self, ref: str) -> Vectors:
        """Plated holes of a part of the board."""
        part = self.board.parts[ref]
        return self.places([t.at for t in part.terminals if t.drill_mm and t.copper is not None])

    @cached_property
    def outline(self) -> BaseGeometry:
        """The board's edge."""
        return shapely.transform(
            self.board.outline, lambda points: self.places([(x, y) for x, y in points])
        )

    @cached_property
    def headers(self) -> tuple[str, ...]:
        """Headers and pads for cables, on the board's front."""
        return tuple(d.ref for d in self.board.carrier.devices
                     if d.kind in ("header", "wires") and d.ref != CONTACTS)  # fmt: skip

    @cached_property
    def board_z_mm(self) -> float:
        """What carries the board, round its screws."""
        ring = 0.5 * self.flange.screw_mm + 0.6
        around = [(x + dx, y + dy) for x, y in self.flange.screws
                  for dx, dy in ((ring, 0), (-ring, 0), (0, ring), (0, -ring))]  # fmt: skip
        return farthest(heights(self.lower, np.array(around)), self.flange.board_z_mm)

    @cached_property
    def split_mm(self) -> float:
        """Where the upper part lies on the lower one, round the bolts."""
        ring = 0.5 * self.flange.bolt_hole_mm + 0.5
        around = [(x + dx, y + dy) for x, y in self.flange.bolts
                  for dx, dy in ((ring, 0), (-ring, 0), (0, ring), (0, -ring))]  # fmt: skip
        return farthest(heights(self.lower, np.array(around)), self.flange.split_z_mm)


def heights(mesh: Any, points: Vectors) -> Vectors:
    """Height of what is seen from above at points (x, y); minus infinity through a hole."""
    above = np.column_stack([points[:, :2], np.full(len(points), REACH_MM / 2)])
    drop, _ = cast(mesh, above, np.array([0.0, 0.0, -1.0]), 2 * REACH_MM).first(len(points))
    return np.asarray(above[:, 2] - drop)


def hole_walls(mesh: Any, z_mm: float) -> float:
    """Least distance from a hole to another or to the outside, in a section."""
    least = np.inf
    for part in shapely.get_parts(section(mesh, z_mm)):
        rings = [part.exterior, *part.interiors]
        for at, ring in enumerate(rings):
            rest = rings[at + 1 :]
            least = min(least, *(ring.distance(other) for other in rest), np.inf)
    return float(least)
