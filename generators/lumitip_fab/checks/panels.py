"""Panels against the boards that they copy, and their frames against figures of PCB fabs."""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray

from lumitip_fab.checks.board_read import path_of
from lumitip_fab.checks.panel_copies import measure_copper, measure_holes, measure_parts
from lumitip_fab.checks.panel_read import PanelBoard, read_panel
from lumitip_fab.checks.panel_tabs import measure_bites, measure_room, measure_tabs
from lumitip_fab.checks.readers.gerber import gerber_area
from lumitip_fab.checks.readers.kicad_board import Part
from lumitip_fab.checks.readers.tables import unpacked
from lumitip_fab.checks.result import Measure, Measurement, measured, unreadable
from lumitip_fab.checks.title_blocks import measure_title_block
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError

NOISE_MM = 0.005
MARKS = 3
"""Fiducials on each side with parts."""
TOOLING = 4
LEAST_WALL_MM = 1.0
"""Board round a tooling hole."""
LEAST_TURN_MM = 2.0
"""How far a fiducial is from all others, at least, when the panel is turned."""
UNCUT_MM2 = 0.05
PROFILE_MM2 = 0.1  # chords of all arcs
_PEN_MM = 0.1


def measure_gaps(read: PanelBoard) -> Iterator[Measurement]:
    """Whether the cutter reaches all of each opening: its width, and the radius in its corners."""
    radius = read.rules.gap_mm / 2 - NOISE_MM
    uncut = [
        face - face.buffer(-radius, quad_segs=32).buffer(radius, quad_segs=32)
        for face in read.faces[1:]
    ]
    worst = max((area.area for area in uncut), default=math.nan)
    yield read.figure("gaps", worst, 0, UNCUT_MM2, "mm²", "of an opening is too narrow")


def measure_rails(read: PanelBoard) -> Iterator[Measurement]:
    """The rails' width."""
    left, low, right, high = read.body.bounds
    inner = read.inside.bounds
    width = min(inner[0] - left, right - inner[2])
    yield read.figure("rails", width, read.rules.rail_mm, math.inf)
    bars = min(inner[1] - low, high - inner[3])
    yield read.figure("bars", bars, read.rules.rail_mm, math.inf)


def measure_marks(read: PanelBoard) -> Iterator[Measurement]:
    """Fiducials on the rails of each side with parts: how many, how wide, how far from the edge,
    and that the panel looks different when it is turned."""
    rules, edge = read.rules, read.body.exterior
    mounted = [p for p in read.board.parts if "exclude_from_bom" not in p.attributes]
    for front in sorted({part.front for part in mounted}, reverse=True):
        side = "front" if front else "back"
        marks = [
            p for p in read.on_frame if p.front == front and p.footprint.startswith("Fiducial")
        ]
        yield read.figure("fiducials", len(marks), MARKS, math.inf, "marks", at=side)
        sizes = np.array([_width_mm(mark) for mark in marks])
        yield read.near("fiducial_size", sizes, rules.fiducial_mm, NOISE_MM, at=side)
        places = np.array([read.at(mark.at) for mark in marks]).reshape(-1, 2)
        from_edge = min((edge.distance(shapely.Point(at)) for at in places), default=math.nan)
        ring = rules.fiducial_opening_mm / 2
        yield read.figure(
            "fiducial_edge", from_edge - ring, rules.fiducial_edge_mm, math.inf, at=side
        )
        least = min((_turned_mm(places, turn) for turn in (90, 180, 270)), default=math.nan)
        yield read.figure("fiducial_turn", least, LEAST_TURN_MM, math.inf, at=side)


def _width_mm(mark: Part) -> float:
    left, _, right, _ = (
        mark.terminals[0].copper.area.bounds if mark.terminals[0].copper else (0, 0, 0, 0)
    )
    return float(right - left)


def _turned_mm(places: NDArray[np.float64], turn_deg: float) -> float:
    """The farthest that a place is from all others when these are turned about the middle."""
    if not len(places):
        return math.nan
    angle = math.radians(turn_deg)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    turned = places @ turn.T
    apart = np.hypot(*(places[:, None] - turned[None]).transpose(2, 0, 1))
    return float(apart.min(axis=1).max())


def measure_tooling(read: PanelBoard) -> Iterator[Measurement]:
    """Tooling holes: how many, how wide, and with how much board round them."""
    holes = [t for p in read.on_frame for t in p.terminals if t.copper is None and t.drill_mm]
    yield read.figure("tooling", len(holes), TOOLING, TOOLING, "holes")
    sizes = np.array([hole.drill_mm for hole in holes])
    yield read.near("tooling_size", sizes, read.rules.tooling_mm, NOISE_MM)
    walls = [
        shapely.Point(read.at(hole.at)).distance(read.body.boundary) - hole.drill_mm / 2
        for hole in holes
    ]
    yield read.figure("tooling_wall", min(walls, default=math.nan), LEAST_WALL_MM, math.inf)


def measure_profile(read: PanelBoard, folder: Path) -> Iterator[Measurement]:
    """The profile in each zip against the edges in the panel's file, and the opening of the mask
    round each fiducial of the rails."""
    edges = shapely.union_all([read.flat(edge) for edge in read.board.edges]).buffer(
        _PEN_MM / 2, quad_segs=32
    )
    for fab in read.design.fabs:
        package, layers = f"{fab.name}_{read.name}.zip", dict(fab.layers)
        path = f"boards/{read.name}/order/{package}"
        try:
            files = unpacked(folder / package)
            drawn = gerber_area(files[read.name + layers["outline"]].decode())
            off = drawn.symmetric_difference(edges).area
            yield Measurement("panels.profile", path, off, 0, PROFILE_MM2, "mm²", "from the edges")
            opening_mm, least = (
                _least_opening_mm(read, files, layers),
                read.rules.fiducial_opening_mm,
            )
            yield Measurement(
                "panels.fiducial_opening", path, opening_mm, least - NOISE_MM, unit="mm"
            )
        except (OSError, KeyError, ValueError, SyntaxError) as error:
            yield unreadable("panels.profile", path, f"cannot be read: {error!r:.200}")


def _least_opening_mm(read: PanelBoard, files: dict[str, bytes], layers: dict[str, str]) -> float:
    """Narrowest opening of the mask round a fiducial of the rails: twice the distance from its
    middle to the mask."""
    widths = []
    for part in read.on_frame:
        if part.footprint.startswith("Fiducial"):
            key = "front mask" if part.front else "back mask"
            open_ = gerber_area(files[read.name + layers[key]].decode())
            at = shapely.Point(read.at(part.at))
            widths.append(2 * at.distance(open_.boundary) if open_.contains(at) else 0.0)
    return min(widths, default=math.nan)


READS = ("boards/*.kicad_pcb", "boards/*_panel/order/*.zip")
OUTLINE_MM = 0.002


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every figure of every panel."""
    for panel in design.panels:
        yield from measure_board(outputs, design, panel.name)


def measure_board(outputs: Path, design: Design, name: str) -> Iterator[Measurement]:
    """Every figure of one panel."""
    panel = next(panel for panel in design.panels if panel.name == name)
    try:
        read = read_panel(outputs, design, panel)
    except OutputError as error:
        yield unreadable("panels.readable", path_of(name), str(error))
        return
    yield from measured(MEASURES, read)
    yield from measure_profile(read, (outputs / path_of(name)).parent / "order")


def measure_size(read: PanelBoard) -> Iterator[Measurement]:
    """Its sides, within what PCB fabs assemble and as the design has them."""
    left, low, right, high = read.body.bounds
    rules, box = read.rules, read.panel.box
    for side, size, least, most in zip(
        ("width", "length"), (right - left, high - low), rules.least_mm, rules.most_mm, strict=True
    ):
        yield read.figure(side, size, least, most)
    off = np.abs(np.subtract((left, low, right, high), box.bounds_mm)).max()
    yield read.figure("outline", off, 0, OUTLINE_MM, note="from the design's")


MEASURES: tuple[Measure[PanelBoard], ...] = (
    measure_size,
    measure_copper,
    measure_parts,
    measure_holes,
    measure_tabs,
    measure_room,
    measure_bites,
    measure_gaps,
    measure_rails,
    measure_marks,
    measure_tooling,
    measure_title_block,
)
