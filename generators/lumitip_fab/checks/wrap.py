"""The skin round the tip: slots of the backings, and the level of the silicone in the moulds as
they stand on their props, by the written parts."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from lumitip_fab.checks.mould import along, distances
from lumitip_fab.checks.printed import RAY_MM, apart_mm, as_moulds, measure_span
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.result import Measure, Measurement, Subject, measured, unreadable
from lumitip_fab.design import Design, Finger, Prop
from lumitip_fab.design.frames import applied, backing_bed_to_sensor, prop_bed_to_sensor
from lumitip_fab.errors import OutputError

READS = ("mould/*_mould.stl", "mould/prop.*", "backing/*_backing.stl")
PROP_FILES = READS[1]
STRAY = "this design has no prop: delete the file, which another design left"
SLOT_MM = 0.05
HEIGHT_MM = 0.02
LEVEL_MM = 0.05
OVER_MM = 0.25  # of the walls over the level, at least
MOST_OVER_MM = 0.35  # of a lip over the least
_OVER_LEVEL_MM = (-0.2, -0.1, 0.0, 0.1, OVER_MM)
_EDGE_MM = 0.05  # from the edge of a slot, where the plate is probed
_ON_BED_MM = 1e-3
_STEP_MM = 0.2
_GAP_MM = 0.1  # off the design's gap
_DOWN = np.array([0.0, 0.0, -1.0])


@dataclass(frozen=True, eq=False)
class Tilted(Subject):
    """A mould on its prop, and the backing that lies in it."""

    mould: Any
    """In its own frame, on its bed."""
    tilt: float
    """Radians about the edge of its foot at the tip, as mould and prop are written."""
    pivot_y_mm: float
    backing: Any
    """In the sensor frame."""
    prop: Prop
    design: Design
    finger: Finger

    def height_mm(self, y_mm: Any, z_mm: Any) -> solids.Vectors:
        """Height over the table at places of the mould's own frame."""
        turned = (np.asarray(y_mm) - self.pivot_y_mm) * math.sin(self.tilt)
        return np.asarray(turned + np.asarray(z_mm) * math.cos(self.tilt))

    @cached_property
    def level_mm(self) -> float:
        """Height of the silicone over the table: that of the lowest way over the weir, of all
        straight ones from the plate's end to the trough."""
        half = self.finger.notch.x_max_mm
        x = np.arange(-half, half, _STEP_MM)
        y = np.arange(-self.design.outline.end_y_mm, -self.prop.weir_y_mm, _STEP_MM)
        at = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        above = np.column_stack([at, np.full(len(at), _top(self.mould))])
        fall, _ = solids.cast(self.mould, above, _DOWN, 2 * _top(self.mould)).first(len(at))
        heights = self.height_mm(at[:, 1], above[:, 2] - fall).reshape(len(y), len(x))
        return float(heights.max(axis=0).min())

    def over_rim_mm(self, y_mm: float) -> float:
        """How far the silicone stands over the rim plane, at a y of the sensor frame."""
        rim = self.design.mould.stops_mm(self.design.stack.cover_mm)
        return (self.level_mm - float(self.height_mm(-y_mm, rim))) / math.cos(self.tilt)


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """The prop, then both fingers; a prop that the design does not have fails."""
    if not design.props:
        for file in sorted(outputs.glob(PROP_FILES)):
            yield unreadable("wrap.prop", f"mould/{file.name}", STRAY)
    for prop in design.props:
        try:
            printed = solids.read_mesh(outputs / prop.file)
        except OutputError as error:
            yield unreadable("wrap.prop", prop.file, str(error))
            continue
        yield from _prop(printed, prop, design)
        for finger in design.fingers:
            subject = f"mould/{finger.name}_mould.stl"
            try:
                mould = solids.read_mesh(outputs / subject)
                backing = solids.read_mesh(outputs / f"backing/{finger.name}_backing.stl")
                tilt, pivot = _tilt(mould, printed)
            except OutputError as error:
                yield unreadable("wrap.readable", subject, str(error))
                continue
            to_sensor = backing_bed_to_sensor(design.mount, design.stack)
            lying = solids.moved(backing, to_sensor)
            whole = Tilted("wrap", subject, mould, tilt, pivot, lying, prop, design, finger)
            yield from measured(MEASURES, whole)


def _prop(printed: Any, prop: Prop, design: Design) -> Iterator[Measurement]:
    """One closed body with the design's corners."""
    of = Subject("wrap", prop.file)
    edges = solids.open_edges(printed) + abs(solids.bodies(printed) - 1)
    yield of.figure("prop", edges, 0, 0, "edges", "open, or bodies too many")
    yield measure_span(of, printed, as_moulds(design))
    off = np.array([_plate_mm(printed) - prop.height_mm, _top(printed) - 1.0])
    off[1] -= prop.height_mm + prop.stop_mm
    note = "of plate and stop from their heights"
    yield of.near("prop", off, 0.0, HEIGHT_MM, note, at="heights")
    corners = _corners(prop, design)
    to_sensor = prop_bed_to_sensor(design.stack, design.mould, prop)
    standing = applied(np.asarray(np.linalg.inv(to_sensor), dtype=np.float64), corners)
    apart = apart_mm(np.asarray(printed.vertices), standing)
    yield of.figure("prop", apart, 0, HEIGHT_MM, note="of a corner from its place", at="corners")


def _corners(prop: Prop, design: Design) -> solids.Vectors:
    """Corners of plate and stop in the sensor frame, shape `(12, 3)`."""
    plate, stop = prop.plate, prop.stop
    bed = design.stack.silicone_z_mm + design.mould.floor_mm
    foot, top = bed + prop.height_mm, bed - prop.stop_mm
    side = (
        *((plate.y_max_mm, z) for z in (foot, bed)),
        *((stop.y_max_mm, z) for z in (bed, top)),
        *((stop.y_min_mm, z) for z in (top, foot)),
    )
    return np.array([(x, y, z) for x in (plate.x_min_mm, plate.x_max_mm) for y, z in side])


def _top(mesh: Any) -> float:
    """A height above everything."""
    return float(mesh.bounds[1, 2]) + 1.0


def _plate_mm(printed: Any) -> float:
    """Height of the prop's plate at its inner edge."""
    x, y = float(printed.bounds[:, 0].mean()), float(printed.bounds[0, 1]) + _EDGE_MM
    above = np.array([[x, y, _top(printed)]])
    fall, _ = solids.cast(printed, above, _DOWN, 2 * _top(printed)).first(1)
    return float(_top(printed) - fall[0])


def _tilt(mould: Any, printed: Any) -> tuple[float, float]:
    """Angle of a mould that lies on its foot at the tip and on the prop's inner edge, and the y of
    that foot. Both files have the same x and y.

    Raises:
        OutputError: if no corner of the mould lies on its bed.
    """
    foot = mould.vertices[mould.vertices[:, 2] < _ON_BED_MM]
    if not len(foot):
        raise OutputError("the mould does not stand on its bed")
    pivot = float(foot[:, 1].min())
    return math.atan2(_plate_mm(printed), float(printed.bounds[0, 1]) - pivot), pivot


def measure_slots(tilted: Tilted) -> Iterator[Measurement]:
    """The sides of the slots, just behind the rim."""
    stack, slots = tilted.design.stack, tilted.design.tip.slots
    cut = solids.section(tilted.backing, stack.face_z_mm - tilted.design.tip.edge_mm / 2)
    skins = shapely.union_all([part.exterior for part in shapely.get_parts(cut)])
    low, high = slots[0].y_min_mm, slots[0].y_max_mm
    along_y = np.linspace(low + SLOT_MM, high - SLOT_MM, 5)
    sides = [(x, y) for slot in slots for x in (slot.x_min_mm, slot.x_max_mm) for y in along_y]
    xs = [np.linspace(s.x_min_mm + SLOT_MM, s.x_max_mm - SLOT_MM, 9) for s in slots]
    ends = [(x, low) for x in np.concatenate(xs)]
    off = shapely.distance(shapely.points(np.array([*sides, *ends])), skins)
    note = "of the slots' sides from their places"
    yield tilted.near("slots", np.asarray(off), 0.0, SLOT_MM, note)


def measure_level(tilted: Tilted) -> Iterator[Measurement]:
    """The silicone's level over the rim plane at the tip edge."""
    tip_y = tilted.design.outline.tip_y_mm
    wanted = tilted.design.mould.level_mm(tip_y)
    note = f"over the rim plane at the tip, tilted by {math.degrees(tilted.tilt):.2f}°"
    yield tilted.near("level", tilted.over_rim_mm(tip_y), wanted, LEVEL_MM, note)


def measure_lip(tilted: Tilted) -> Iterator[Measurement]:
    """The silicone on the back of the plate, at the edge of the slots."""
    slots, rim = tilted.design.tip.slots, tilted.design.stack.rim_z_mm
    places = np.array([(slot.centre_mm[0], slot.y_min_mm - _EDGE_MM) for slot in slots])
    below = np.column_stack([places, np.full(len(slots), rim - 40.0)])
    up, _ = solids.cast(tilted.backing, below, -_DOWN, 40.0 + RAY_MM).first(len(slots))
    deep = 40.0 - up + tilted.design.stack.face_z_mm - rim
    lips = [tilted.over_rim_mm(y) - d for (_, y), d in zip(places, deep, strict=True)]
    least = tilted.prop.lip_mm
    note = "silicone on the back of the plate, at the slots"
    low, high = least - LEVEL_MM, least + MOST_OVER_MM
    yield tilted.figure("lip", min(lips), low, high, note=note)


def measure_held(tilted: Tilted) -> Iterator[Measurement]:
    """The mould's wall, all round the plate but for the weir, at heights about the silicone's
    level."""
    design, mould = tilted.design, tilted.design.mould
    turned = tilted.mould.copy()
    corners = turned.vertices - (0.0, tilted.pivot_y_mm, 0.0)
    sine, cosine = math.sin(tilted.tilt), math.cos(tilted.tilt)
    turned.vertices = corners @ np.array([[1, 0, 0], [0, cosine, sine], [0, -sine, cosine]])
    edge, gaps = shapely.Polygon(design.outline.polygon() * (1, -1)), []
    for over_mm in _OVER_LEVEL_MM:
        height = tilted.level_mm + over_mm

        def seen(points: solids.Vectors, height: float = height) -> solids.Vectors:
            """Places of the plate's edge at a height over the table, seen from above."""
            along_mm = (points[:, 1] - tilted.pivot_y_mm - height * sine) / cosine
            return np.column_stack([points[:, 0], along_mm])

        end_y = float(seen(np.array([[0.0, -design.outline.end_y_mm]]))[0, 1])
        places = along(shapely.transform(edge, seen), end_y, tilted.finger.notch)
        gaps.append(float(distances(turned, height, places).max()))
    high = tilted.over_rim_mm(design.outline.tip_y_mm) + OVER_MM
    leans = high * math.tan(math.radians(mould.draft_deg))
    note = f"from the plate to the wall, up to {OVER_MM:g} mm over the level"
    yield tilted.figure("held", max(gaps), 0.0, mould.wall_gap_mm + leans + _GAP_MM, note=note)


MEASURES: tuple[Measure[Tilted], ...] = (
    measure_slots,
    measure_level,
    measure_lip,
    measure_held,
)
