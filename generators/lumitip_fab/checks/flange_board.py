"""The flange's board in its pocket: edge, seat, contacts, cables, screws, by the board's file."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import manifold3d
import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.printed import circles, holes_at, room, round_head, round_thread
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.solids import Vectors, cast, section
from lumitip_fab.checks.result import Measure, Measurement, Subject, farthest
from lumitip_fab.design import Box, Component, Design, Flange, Point
from lumitip_fab.design.frames import applied, auxiliary_to_flange

CONTACTS = "J1"  # on the board's back, towards the robot
REACH_MM = 100.0
SIZE_MM = 0.05
HOLE_MM = 0.05
WIRE_MM = 2.0  # room for wires over their pads
LEAST_HEADROOM_MM = 0.1
LEAST_AROUND_MM = 0.3  # from the spring contacts' body to the window's edge
LEAST_SHARE, MOST_SHARE = 0.2, 0.9  # of the stroke that the springs are pressed by
_NEAR_MM = 2.0


@dataclass(frozen=True, eq=False)
class Stacked(Subject):
    """The flange as it was read."""

    lower: Any
    """Mesh of the lower part."""
    upper: Any
    """Mesh of the upper part."""
    board: ReadBoard
    flange: Flange
    design: Design

    @property
    def gap_mm(self) -> float:
        """Wanted from the printed parts to coupling, gripper and board, by the printer's fit."""
        return self.flange.clearance_mm + self.design.printing.fit_mm

    def places(self, page: list[Point]) -> Vectors:
        """Places on the board's page, shape `(n, 2)`."""
        on_board = self.board.sensor(page)
        return applied(auxiliary_to_flange(self.flange), on_board)[:, :2]

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
        return tuple(
            d.ref
            for d in self.board.components
            if d.kind in ("header", "wires") and d.ref != CONTACTS
        )

    @cached_property
    def board_z_mm(self) -> float:
        """Area that carries the board, around its screws."""
        ring = 0.5 * self.flange.screw_mm + 0.6
        around = [
            (x + dx, y + dy)
            for x, y in self.flange.screws
            for dx, dy in ((ring, 0), (-ring, 0), (0, ring), (0, -ring))
        ]
        return farthest(heights(self.lower, np.array(around)), self.flange.board_z_mm)

    @cached_property
    def split_mm(self) -> float:
        """Where the upper part lies on the lower one, round the bolts."""
        ring = 0.5 * self.flange.bolt_hole_mm + 0.5
        around = [
            (x + dx, y + dy)
            for x, y in self.flange.bolts
            for dx, dy in ((ring, 0), (-ring, 0), (0, ring), (0, -ring))
        ]
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


def measure_pocket(of: Stacked) -> Iterator[Measurement]:
    """The board's edge in its pocket, what it lies on, and room for its solder tails."""
    flange, pcb_mm = of.flange, of.design.stack.auxiliary_mm
    middle = flange.board_z_mm + pcb_mm / 2
    rings = [shapely.Polygon(ring) for ring in holes_at(of.lower, middle)]
    pocket = max(rings, key=lambda ring: ring.area)
    wanted = of.gap_mm
    inside = pocket.contains(of.outline)
    gap = pocket.exterior.distance(of.outline) if inside else math.nan
    yield of.near("board_gap", gap, wanted, SIZE_MM, "board to pocket, at its nearest")
    loose = shapely.hausdorff_distance(pocket.exterior, of.outline.exterior, densify=0.02)
    yield of.near("board_play", loose, wanted, SIZE_MM, "board to pocket, at its farthest")
    yield of.near("board_seat", of.board_z_mm, flange.board_z_mm, SIZE_MM, "height of the floor")
    tails = np.concatenate([of.pads(ref) for ref in of.headers])
    floor = heights(of.lower, tails)
    room = float((of.board_z_mm - floor).min())
    note = f"under {len(tails)} pads of headers"
    yield of.figure("tails", room, flange.tail_mm - SIZE_MM, math.inf, note=note)
    left = float((floor - of.lower.bounds[0][2]).min())
    note = "left under the solder tails"
    yield of.figure(
        "tail_floor", left, of.design.printing.min_wall_mm - SIZE_MM, math.inf, note=note
    )


def measure_contacts(of: Stacked) -> Iterator[Measurement]:
    """The spring contacts: through their window, and pressed by the coupling's contacts."""
    flange, pads = of.flange, of.pads(CONTACTS)
    seen = heights(of.lower, pads)
    blocked = int(np.isfinite(seen).sum())
    yield of.figure("window", blocked, 0, 0, "contacts", f"of {len(pads)} that do not come through")
    rings = holes_at(of.lower, (flange.seat_z_mm + flange.board_z_mm) / 2)
    middle = shapely.Point(*pads.mean(axis=0))
    here = [shapely.Polygon(ring) for ring in rings if shapely.Polygon(ring).contains(middle)]
    body = _footprint(of, _device(of, CONTACTS))
    free = [ring.exterior.distance(body) for ring in here if ring.contains(body)]
    note = "round the body of the contacts"
    yield of.figure(
        "window_gap", free[0] if free else math.nan, LEAST_AROUND_MM, math.inf, note=note
    )
    behind = not of.board.parts[CONTACTS].front
    stand = flange.contacts_mm if behind else math.nan
    pressed = stand - (of.board_z_mm - flange.contacts_z_mm)
    low, high = LEAST_SHARE * flange.stroke_mm, MOST_SHARE * flange.stroke_mm
    note = f"of {flange.stroke_mm:g} mm of stroke"
    yield of.figure("contact_press", pressed, low - SIZE_MM, high + SIZE_MM, note=note)


def measure_headers(of: Stacked) -> Iterator[Measurement]:
    """The way out of each header's cable, and room over every part."""
    front = of.board_z_mm + of.design.stack.auxiliary_mm
    blocked = []
    for ref in of.headers:
        device = _device(of, ref)
        body = shapely.union_all([_footprint(of, device, box) for box in _boxes(device)])
        x_min, y_min, x_max, y_max = body.bounds
        outward = math.copysign(1.0, y_min + y_max)
        levels = np.linspace(front + 0.3, front + max(device.footprint.height_mm, WIRE_MM), 5)
        across = np.linspace(x_min, x_max, 9)
        at = _footprint(of, device).centroid.y
        start = np.array([(x, at, z) for x in across for z in levels])
        hit, _ = solids.cast(of.lower, start, np.array([0.0, outward, 0.0]), REACH_MM).first(
            len(start)
        )
        blocked += [ref] if np.isfinite(hit).any() else []
    yield of.figure("cables", len(blocked), 0, 0, "headers", "whose way out is blocked")
    highest = max(d.footprint.height_mm for d in of.board.components if _in_front(of, d))
    note = "over the highest part"
    yield of.figure(
        "headroom", of.split_mm - front - highest, LEAST_HEADROOM_MM, math.inf, note=note
    )


def measure_screws(of: Stacked) -> Iterator[Measurement]:
    """The screws' holes against those in the board's file, and their countersinks."""
    flange = of.flange
    places = of.places([hole.at for hole in of.board.screws])
    at = tuple((float(x), float(y)) for x, y in places)
    holes = holes_at(of.lower, flange.board_z_mm - 0.2)
    off, wide = circles(holes, at, _NEAR_MM)
    yield of.near("screws", off, 0.0, HOLE_MM, "from the board's holes")
    yield of.near("screw_width", wide, flange.screw_mm, HOLE_MM)
    screw = of.design.threads[flange.screw]
    through = round_thread(room(holes, at), screw, of.design.printing.fit_mm)
    yield of.clear("screw_clearance", through)
    sinks = holes_at(of.lower, flange.seat_z_mm + 0.1)
    _, head = circles(sinks, at, _NEAR_MM)
    worst = farthest(head, flange.screw_head_mm - 0.2)
    yield of.near("screw_heads", worst + 0.2, flange.screw_head_mm, HOLE_MM, "countersink")
    yield of.clear("head_clearance", round_head(room(sinks, at) + 0.2, screw))


def bodies(of: Stacked) -> dict[str, solids.Solid]:
    """The board and its parts as boxes, each on the side where the board's file has it."""
    thick = of.design.stack.auxiliary_mm
    seat = of.board_z_mm + SIZE_MM / 2
    ring = np.array(of.outline.exterior.coords)[:-1]
    flat = manifold3d.CrossSection([ring], manifold3d.FillRule.EvenOdd)
    found = {"the board": flat.extrude(thick).translate((0.0, 0.0, seat))}
    for device in of.board.components:
        height = device.footprint.height_mm
        if height:
            low = seat + thick if _in_front(of, device) else seat - height
            boxes = [
                np.array(_footprint(of, device, b).exterior.coords)[:-1] for b in _boxes(device)
            ]
            flats = [manifold3d.CrossSection([c], manifold3d.FillRule.EvenOdd) for c in boxes]
            blocks = [flat.extrude(height).translate((0.0, 0.0, low)) for flat in flats]
            found[device.ref] = solids.united(blocks)
    return found


def _boxes(device: Component) -> list[Box]:
    """A part's body; of a box header also the shroud."""
    shape = device.footprint
    return [shape.body, *([shape.shroud.box] if shape.shroud else [])]


def _in_front(of: Stacked, device: Component) -> bool:
    return of.board.parts[device.ref].front


def _device(of: Stacked, ref: str) -> Component:
    return next(d for d in of.board.components if d.ref == ref)


def _footprint(of: Stacked, device: Component, box: Box | None = None) -> shapely.Polygon:
    """A part's body, or another box of its footprint, where the board's file has the part."""
    part, body = of.board.parts[device.ref], box or device.footprint.body
    (at,) = of.places([part.at])
    turn, sign = math.radians(device.angle_deg), 1 if part.front else -1
    left, right = sorted((sign * body.x_min_mm, sign * body.x_max_mm))
    corners = [
        (left, body.y_min_mm),
        (right, body.y_min_mm),
        (right, body.y_max_mm),
        (left, body.y_max_mm),
    ]
    return shapely.Polygon(
        [
            (
                at[0] + x * math.cos(turn) - y * math.sin(turn),
                at[1] + x * math.sin(turn) + y * math.cos(turn),
            )
            for x, y in corners
        ]
    )


BOARD: tuple[Measure[Stacked], ...] = (
    measure_pocket,
    measure_contacts,
    measure_headers,
    measure_screws,
)
"""Measures of the board in its pocket."""
