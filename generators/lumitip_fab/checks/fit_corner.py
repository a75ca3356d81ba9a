"""Corners of the pocket on the fit test plate, measured as on a backing: in its sensor frame."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from lumitip_fab.checks.printed import RAY_MM, circles
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.solids import Vectors, cast, section
from lumitip_fab.checks.result import Measurement, Subject
from lumitip_fab.design import Design, PocketCorner, Point
from lumitip_fab.design.frames import fit_corner_to_sensor

TIGHT_MM = 0.02  # less than half a step: no step passes for its neighbour
PLACE_MM = 0.05
FLOOR_MM = 0.05  # over the pocket's floor, where the roof's end is measured
_ALONG = (0.25, 0.4, 0.5)  # of the way from the board's corner to its pin
_BESIDE_MM = (0.1, 0.25, 0.4)  # the board's edge, short of the pin
_DOWN = np.array([0.0, 0.0, -1.0])


@dataclass(frozen=True, eq=False)
class FitCoupons(Subject):
    """The plate as it was read."""

    mesh: Any
    design: Design

    def names(self) -> list[str]:
        """Values of the steps."""
        hundredths = [f"{100 * fits.fit_mm:+.0f}" for fits in self.design.fit_plate.steps]
        return ["0" if value in {"+0", "-0"} else value for value in hundredths]

    def looser_mm(self, step: int) -> float:
        """How much looser than the backing a step is to be."""
        return self.design.fit_plate.steps[step].fit_mm - self.design.printing.fit_mm

    def mounted(self, step: int, us: tuple[float, ...]) -> tuple[Point, ...]:
        """Places on the line of the bolts, of those in the slice that is shown."""
        plate, w = self.design.fit_plate, self.design.mount.bolt_w_mm
        x, y = plate.at(step, plate.slice_at)
        return tuple((x - u, y - w) for u in us if plate.slice.x_min_mm < u < plate.slice.x_max_mm)


def measure_corners(plate: FitCoupons) -> Iterator[Measurement]:
    """At each corner: gaps from a board's edges to wall and roof, the pin, and the floor."""
    for corner in plate.design.fit_plate.corners:
        yield from _corners(plate, corner)


def _corners(plate: FitCoupons, corner: PocketCorner) -> Iterator[Measurement]:
    wanted, board, stack = plate.design.fit_plate, plate.design.board, plate.design.stack
    mesh = solids.moved(plate.mesh, fit_corner_to_sensor(corner, plate.design.mount, stack))
    half_way, low = (section(mesh, z) for z in _heights(plate.design))
    rings = [p.exterior for p in shapely.get_parts(half_way) if p.geom_type == "Polygon"]
    pin_x, pin_y = corner.pin
    edge_x, edge_y = board.box.x_min_mm, board.box.y_max_mm
    free = np.array(_ALONG)
    leans = board.roof_mm / stack.pcb_mm * FLOOR_MM
    for step, name in enumerate(plate.names()):
        looser, by = plate.looser_mm(step), step * wanted.pitch_mm
        beside = [(edge_x + by, edge_y + (pin_y - edge_y) * f) for f in free]
        behind = [(edge_x + (pin_x - edge_x) * f + by, edge_y) for f in free]
        wall = _gaps(half_way, beside, (-1.0, 0.0))
        roof = _gaps(low, behind, (0.0, 1.0)) - leans
        gaps = np.concatenate([wall, roof])
        yield plate.near("pocket_gap", gaps, board.pocket_clearance_mm + looser, TIGHT_MM, at=name)
        off, wide = circles(rings, ((pin_x + by, pin_y),), board.hole_mm / 2)
        yield plate.near("pins", off, 0.0, PLACE_MM, at=name)
        yield plate.near("pin", wide, board.pin_mm - 2 * looser, TIGHT_MM, at=name)
        floor = [(edge_x + beside_mm + by, pin_y) for beside_mm in _BESIDE_MM]
        deep = stack.rim_z_mm - _front_z(mesh, np.array(floor), stack.rim_z_mm + RAY_MM)
        yield plate.near("pocket_depth", deep, stack.pcb_mm, PLACE_MM, at=name)


def _heights(design: Design) -> tuple[float, float]:
    """Where walls and pins are cut: half way up the pocket, and just over its floor."""
    stack = design.stack
    return stack.rim_z_mm - stack.pcb_mm / 2, stack.pocket_z_mm + FLOOR_MM


def _gaps(cut: Any, starts: list[Point], outward: Point) -> Vectors:
    """From points on a board's edge outward to the wall."""
    from_ = np.array(starts) - np.array(outward) * 0.1
    lines = shapely.linestrings(np.stack([from_, from_ + np.array(outward) * 2.0], axis=1))
    return np.asarray(
        shapely.distance(shapely.points(from_), shapely.intersection(lines, cut)) - 0.1
    )


def _front_z(mesh: Any, points: Vectors, above_mm: float) -> Vectors:
    """Height of what is seen from the front at points (x, y)."""
    origins = np.column_stack([points, np.full(len(points), above_mm)])
    drop, _ = cast(mesh, origins, _DOWN, 4 * RAY_MM).first(len(points))
    return np.asarray(above_mm - drop)
