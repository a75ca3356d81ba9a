"""The gauge card: its edge and strip are where `gauge.json` says, and it has room for both fingers.

The written solid is moved to each of its placements in the receiver's sensor frame, and its borders
are found again by sections and rays.
"""

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from lumitip.errors import LayoutError
from lumitip.layout import Layout
from lumitip_fab.checks.printed import measure_bed, measure_closed
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.scene import Scene, read_scene
from lumitip_fab.checks.result import Measure, Measurement, Subject, measured, unreadable
from lumitip_fab.checks.walls import Exempt, walls
from lumitip_fab.design import Box, Design, GaugeCard, Target
from lumitip_fab.design.frames import (
    backing_bed_to_sensor,
    gauge_bed_to_sensor,
    gauge_ends,
    gauge_to_receiver,
)
from lumitip_fab.errors import OutputError

READS = ("gauge/*", "gauge.json", "layout.json", "assembly/assembly.glb", "backing/*.stl")
GAUGE, _SCENE = "gauge.json", "assembly/assembly.glb"
LINE_MM, LINE_DEG = 0.02, 0.05
HEIGHT_MM = 0.02
HUG_MM = 0.03
SHARED_MM3 = 0.05
LEAST_BED_MM2 = 500.0
_NEAR_MM = 0.05
_INSET_MM = 0.5  # from edges, where rays are sent
_SKIN_MM = 0.2  # behind the plate's front, where rails and plate are cut
_STEP_MM = 1.0
_FAR_MM = 200.0
_UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Placed(Subject):
    """The card in one of its placements, in the receiver's sensor frame."""

    card: GaugeCard
    design: Design
    target: Target
    """As `gauge.json` has it."""
    gap_mm: float
    mesh: Any
    hugged: Any
    """The card in the sensor frame of the finger between its rails."""
    layout: Layout
    scene: Scene
    plate: Any
    """The backing of that finger, in the same frame."""

    @cached_property
    def apertures(self) -> Any:
        """The holes of all cells as circles round them, shape `(cells,)`."""
        centres = shapely.points(self.layout.x_mm, self.layout.y_mm)
        return shapely.buffer(centres, self.layout.hole_mm / math.sqrt(3))

    @cached_property
    def around(self) -> Any:
        """The window without its rim."""
        return shapely.box(*self.card.window.grown(-_INSET_MM).bounds_mm)

    @cached_property
    def cut(self) -> Any:
        """The material in it, half-way up the blade."""
        return self.around & solids.section(
            self.mesh, (self.target.low_mm + self.target.high_mm) / 2
        )

    def left_mm(self, points: solids.Vectors) -> solids.Vectors:
        """Signed distance of points from the target's line along its left normal."""
        turn = math.radians(self.target.angle_deg)
        normal = np.array([-math.sin(turn), math.cos(turn)])
        return np.asarray(points @ normal - self.target.offset_mm)

    def heights_mm(self, points: solids.Vectors) -> list[solids.Vectors]:
        """Heights at which a ray along z crosses the card, of each point (x, y)."""
        start = np.column_stack([points, np.full(len(points), -_FAR_MM)])
        hits = solids.cast(self.mesh, start, _UP, 2 * _FAR_MM)
        return [hits.distance_mm[hits.ray == k] - _FAR_MM for k in range(len(points))]


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """The card as a print, then each end on each finger."""
    lying = backing_bed_to_sensor(design.mount, design.stack)
    for card in design.gauge_cards:
        try:
            standing = solids.read_mesh(outputs / card.file)
            yield from _prints(standing, card, design)
            layout, scene = Layout.load(outputs / "layout.json"), read_scene(outputs / _SCENE)
            plates = [outputs / f"backing/{f.name}_backing.stl" for f in design.fingers]
            backings = [solids.moved(solids.read_mesh(plate), lying) for plate in plates]
            record, targets = _targets(outputs / GAUGE)
        except (LayoutError, OutputError) as error:
            yield unreadable("gauge_card.readable", f"{card.file} and {GAUGE}", str(error))
            continue
        of = Subject("gauge_card", GAUGE)
        same = record.get("design_hash") == layout.design_hash
        yield of.figure("hash", same, 1, 1, "", "equals layout.json's")
        wanted, named = ([(t.name, t.on, t.kind) for t in c] for c in (card.placements, targets))
        wrong = [name for name, *_ in sorted({*wanted} ^ {*named})]
        wrong += ["twice"] * (len(named) - len({*named}))
        yield of.count("placements", wrong, "wrong placements")
        yield of.near("gap", record["gap_mm"], card.gap_mm, 0.0, "equals the design's")
        for target in (t for t, name in zip(targets, named, strict=True) if name in wanted):
            to_finger = gauge_ends(card)[target.kind] @ gauge_bed_to_sensor(card)
            hugged = solids.moved(standing, to_finger)
            placed = Placed(
                prefix="gauge_card",
                subject=f"{card.file}: {target.name}",
                card=card,
                design=design,
                target=target,
                gap_mm=float(record["gap_mm"]),
                mesh=solids.moved(hugged, gauge_to_receiver(card, target.on)),
                hugged=hugged,
                layout=layout,
                scene=scene,
                plate=backings[target.on == design.receiver.name],
            )
            yield from measured(MEASURES, placed)


def _prints(standing: Any, card: GaugeCard, design: Design) -> Iterator[Measurement]:
    """One closed body that lies on the bed with its blade's face, and its walls."""
    of = Subject("gauge_card", card.file)
    yield from measure_closed(of, standing)
    yield from measure_bed(of, standing, design.printing, 0.1, LEAST_BED_MM2)
    left = np.array(design.printing.bed_mm) - standing.extents
    yield of.figure("fits_bed", left.min(), 0, math.inf, note="room left")
    blade = Exempt("blade", card.blade_mm, lambda at: at[:, 2] < card.blade_mm + _NEAR_MM)
    least = design.printing.min_wall_mm
    yield from walls("gauge_card.min_wall", card.file, standing, least, (blade,))


def _targets(path: Path) -> tuple[dict[str, Any], list[Target]]:
    """What `gauge.json` holds.

    Raises:
        OutputError: if it cannot be read.
    """
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
        if record["schema_version"] != 1:
            raise ValueError(f"schema_version {record['schema_version']!r}, 1 is needed")
        entries = [
            {f.name: entry[f.name] for f in fields(Target)} for entry in record["placements"]
        ]
        figures = [v for e in entries for k, v in e.items() if k.endswith(("_mm", "_deg"))]
        if not all(type(figure) in (int, float) for figure in [*figures, record["gap_mm"]]):
            raise ValueError("a length or an angle is no number")
        if not all(type(e[k]) is str for e in entries for k in ("name", "on", "kind")):
            raise ValueError("a name is no text")
        return record, [Target(**entry) for entry in entries]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise OutputError(f"cannot be read: {error!r:.200}") from error


def measure_line(placed: Placed) -> Iterator[Measurement]:
    """Each straight border of the material in the window: its direction, its distance from the
    origin, and how far it strays from straight."""
    target, edge = placed.target, placed.target.kind == "edge"
    borders = _borders(placed)
    yield placed.figure("borders", len(borders), 2 - edge, 2 - edge, "borders")
    offsets = []
    for points in borders:
        middle = points.mean(axis=0)
        along = np.linalg.svd(points - middle)[2][0]
        heading = math.radians(target.angle_deg)
        ahead = along @ (math.cos(heading), math.sin(heading)) > 0
        normal = np.array([-along[1], along[0]]) * (1 if ahead else -1)
        if edge and placed.cut.contains(shapely.Point(*(middle + _INSET_MM * normal))):
            normal = -normal  # the material is right of it
        found = math.degrees(math.atan2(-normal[0], normal[1]))
        off = (found - target.angle_deg + 180.0) % 360.0 - 180.0
        yield placed.near("angle", off, 0.0, LINE_DEG, "off gauge.json", "deg")
        yield placed.near("straight", (points - middle) @ normal, 0.0, LINE_MM, "off a line")
        offsets.append(float(middle @ normal))
    width = max(offsets) - min(offsets)
    offset = (max(offsets) + min(offsets)) / 2
    yield placed.near("line", offset, target.offset_mm, LINE_MM, "from the origin")
    yield placed.near("width", width, target.width_mm, LINE_MM)


def _borders(placed: Placed) -> list[solids.Vectors]:
    """Points on each border of the material inside the window."""
    inner = placed.cut.boundary - placed.around.boundary.buffer(_NEAR_MM)
    inner = shapely.line_merge(inner) if inner.geom_type == "MultiLineString" else inner
    lines = [line for line in shapely.get_parts(inner) if line.length > _STEP_MM]
    return [
        shapely.get_coordinates(line.interpolate(np.arange(0.0, line.length, _STEP_MM)))
        for line in lines
    ]


def measure_heights(placed: Placed) -> Iterator[Measurement]:
    """Both faces of blade or strip."""
    points = _inside(placed.cut.buffer(-_INSET_MM))
    target, crossed = placed.target, placed.heights_mm(points)
    once = [z for z in crossed if len(z) == 2]
    yield placed.figure("layers", len(crossed) - len(once), 0, 0, "places", "not crossed twice")
    off = np.array(once) - (target.low_mm, target.high_mm)
    yield placed.near("heights", off.ravel(), 0.0, HEIGHT_MM, "off gauge.json")


def measure_window(placed: Placed) -> Iterator[Measurement]:
    """Rays through each aperture and its rim: the card takes those that `gauge.json` says."""
    rims = [shapely.get_coordinates(hole.exterior) for hole in placed.apertures]
    middles = np.column_stack([placed.layout.x_mm, placed.layout.y_mm])
    points = np.concatenate([middles, *rims])
    left = placed.left_mm(points)
    if placed.target.kind == "strip":
        left = np.abs(left) - placed.target.width_mm / 2
    clear = np.abs(left) > 2 * LINE_MM
    taken = np.array([len(z) > 0 for z in placed.heights_mm(points)])
    wrong = np.flatnonzero(clear & (taken != (left < 0)))
    note = f"of {clear.sum()} taken or passed against gauge.json"
    yield placed.figure("window", len(wrong), 0, 0, "rays", note)


def measure_frame(placed: Placed) -> Iterator[Measurement]:
    """Both faces of the frame, all over the fingers: on the receiver's skin and the emitter's."""
    card = placed.card
    letter = Box(-card.letter_mm, card.letter_mm, card.low_y_mm, card.window.y_min_mm)
    face = shapely.Polygon(placed.design.outline.polygon())
    face = shapely.clip_by_rect(face, -_FAR_MM, card.low_y_mm, _FAR_MM, _FAR_MM)
    for box in (card.window, letter):
        face = face - shapely.box(*box.bounds_mm)
    points = _inside(face.buffer(-_INSET_MM)) * (1 if placed.target.on == "receiver" else (-1, 1))
    ends = np.array([(z[0], z[-1]) for z in placed.heights_mm(points)]).reshape(-1, 2)
    off = ends - (0.0, placed.gap_mm)
    yield placed.near("frame", off.ravel(), 0.0, HEIGHT_MM, "off the skins")


def measure_rails(placed: Placed) -> Iterator[Measurement]:
    """Both rails and the stop beside the finger's plate."""
    card, stack = placed.card, placed.design.stack
    z = stack.face_z_mm - _SKIN_MM
    plate = solids.section(placed.plate, z)
    own = shapely.box(-_FAR_MM, -_FAR_MM, _FAR_MM, card.stop.y_max_mm)
    parts = shapely.get_parts(solids.section(placed.hugged, z) & own)
    beside: dict[str, list[float]] = {"left": [], "right": [], "tip": []}
    for part in parts:
        x, y = part.centroid.coords[0]
        side = "tip" if y > card.rail_y_max_mm else "left" if x < 0 else "right"
        beside[side].append(float(part.distance(plate)))
    for side, found in beside.items():
        gap = card.stop.y_min_mm - placed.design.outline.tip_y_mm
        wanted = gap if side == "tip" else card.rail_gap_mm
        nearest = min(found) if found else math.nan
        note = f"from the plate, {side}"
        yield placed.near("rails", nearest, wanted, HUG_MM, note)


def measure_clear(placed: Placed) -> Iterator[Measurement]:
    """Volume that the card shares with both fingers at its gap."""
    body, shared = solids.solid(placed.mesh, "the gauge card"), {}
    for finger in placed.design.fingers:
        to_receiver = gauge_to_receiver(placed.card, finger.name)
        for layer in placed.design.layers:
            mesh = placed.scene.nodes[f"{finger.name}.{layer}"].mesh
            part = solids.placed(solids.solid(mesh, layer), to_receiver)
            shared[f"the {finger.name}'s {layer}"] = solids.shared_mm3(body, part)
    worst = max(shared, key=lambda name: shared[name])
    yield placed.figure("clear", shared[worst], 0, SHARED_MM3, "mm³", f"shared with {worst}")


def _inside(area: Any) -> solids.Vectors:
    """Points of a grid in an area, shape `(n, 2)`."""
    low_x, low_y, high_x, high_y = area.bounds
    x, y = np.arange(low_x, high_x, _STEP_MM), np.arange(low_y, high_y, _STEP_MM)
    at = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    return np.asarray(at[shapely.contains_xy(area, at[:, 0], at[:, 1])])


MEASURES: tuple[Measure[Placed], ...] = (
    measure_line,
    measure_heights,
    measure_window,
    measure_frame,
    measure_rails,
    measure_clear,
)
