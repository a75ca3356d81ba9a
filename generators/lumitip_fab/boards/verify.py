"""The board's copper held against its own rules, before anything is written.

Round copper is a point or a line with a radius, so distances are exact.
"""

from dataclasses import dataclass

import networkx as nx
import numpy as np
import shapely
from numpy.typing import NDArray

from lumitip_fab.boards.model import SIDES, BoardModel, Placement
from lumitip_fab.boards.placed import PlacedPad, placed_pads
from lumitip_fab.design import Point, Side
from lumitip_fab.errors import BuildError

DRILL_WALL_MM = 0.25
"""Board left between two drilled holes."""
_NOISE_MM = 1e-6


@dataclass(frozen=True)
class Fault:
    """Something that breaks a rule, and where."""

    rule: str
    """`"clearance"`, `"short"`, `"open"`, `"edge"`, `"keep-out"` or `"drill"`."""
    nets: tuple[str, str]
    """The nets that are too close; twice the same for a net in pieces."""
    x_mm: float
    y_mm: float
    distance_mm: float
    needed_mm: float

    def __str__(self) -> str:
        where = f"at ({self.x_mm:.2f}, {self.y_mm:.2f}) mm"
        if self.rule == "open":
            return f"net {self.nets[0]} is in pieces: nothing reaches the part {where}"
        return (
            f"{self.rule}: {' and '.join(n or 'no net' for n in self.nets)} {where} are "
            f"{self.distance_mm:.4f} mm apart, {self.needed_mm:.4f} needed"
        )


@dataclass(frozen=True)
class Copper:
    """One piece of copper: all within a radius of a point, a line or a polygon."""

    net: str
    core: shapely.Geometry
    radius_mm: float
    sides: tuple[Side, ...]
    at: Point
    is_pad: bool = False


def verify(model: BoardModel) -> tuple[Fault, ...]:
    """All faults of a board: none if it may be made.

    Clearances are those of the net classes, the greater of the two; every net is in one piece.
    """
    copper = copper_of(model)
    cores = np.array([c.core for c in copper], dtype=object)
    radii = np.array([c.radius_mm for c in copper])
    shapely.prepare(cores)
    classes = {c.name: c.clearance_mm for c in model.placement.classes}
    of_net = {n.name: classes[n.net_class] for n in model.placement.nets}
    gaps = np.array([of_net.get(c.net, min(classes.values())) for c in copper])
    # By their boxes alone. `dwithin` uses the prepared geometry of its first argument: below, the
    # later piece goes first, for the pour is last and has the most corners.
    around = (radii + radii.max() + gaps.max())[:, None] * (-1, -1, 1, 1)
    first, second = shapely.STRtree(cores).query(shapely.box(*(shapely.bounds(cores) + around).T))
    layers = np.array([sum(1 << SIDES.index(s) for s in c.sides) for c in copper])
    ordered = (first < second) & (layers[first] & layers[second] > 0)
    first, second = first[ordered], second[ordered]
    names = np.array([c.net for c in copper])
    same = (names[first] == names[second]) & (names[first] != "")
    return (
        *_too_near(copper, cores, radii, gaps, first[~same], second[~same]),
        *_in_pieces(copper, cores, radii, first[same], second[same]),
        *_over_edge(model.placement, copper, cores, radii),
        *_kept_out(model.placement, copper, cores, radii),
        *_drills(model),
    )


def copper_of(model: BoardModel) -> list[Copper]:
    """Every piece of a board's copper: pads, tracks, vias, then the pour."""
    copper = []
    for component in model.placement.components:
        for pad in placed_pads(component):
            round_ = pad.pad.round
            core = shapely.Point(pad.x_mm, pad.y_mm) if round_ else pad.area
            radius = pad.pad.width_mm / 2 if round_ else 0.0
            net = pad.net
            copper.append(Copper(net, core, radius, pad.sides, (pad.x_mm, pad.y_mm), True))
    for track in model.routing.tracks:
        line = shapely.LineString([track.start, track.end])
        copper.append(Copper(track.net, line, track.width_mm / 2, (track.side,), track.start))
    for via in model.routing.vias:
        at = via.x_mm, via.y_mm
        copper.append(Copper(via.net, shapely.Point(at), via.diameter_mm / 2, SIDES, at))
    for fill in model.fills:
        inside = fill.area.representative_point()
        copper.append(Copper(fill.net, fill.area, 0.0, (fill.side,), (inside.x, inside.y)))
    return copper


def _too_near(
    copper: list[Copper],
    cores: NDArray[np.object_],
    radii: NDArray[np.float64],
    gaps: NDArray[np.float64],
    first: NDArray[np.int64],
    second: NDArray[np.int64],
) -> list[Fault]:
    needed = np.maximum(gaps[first], gaps[second])
    reach = radii[first] + radii[second]
    bad = shapely.dwithin(cores[second], cores[first], reach + needed - _NOISE_MM)
    faults = []
    for i, j, r, need in zip(first[bad], second[bad], reach[bad], needed[bad], strict=True):
        line = shapely.shortest_line(cores[i], cores[j])
        at = shapely.line_interpolate_point(line, 0.5, normalized=True)
        apart = float(line.length - r)
        rule = "short" if apart <= 0 else "clearance"
        nets = copper[i].net, copper[j].net
        faults.append(Fault(rule, nets, at.x, at.y, apart, float(need)))
    return faults


def _in_pieces(
    copper: list[Copper],
    cores: NDArray[np.object_],
    radii: NDArray[np.float64],
    first: NDArray[np.int64],
    second: NDArray[np.int64],
) -> list[Fault]:
    """Every piece of a net but its largest: with a pad it is open, without one it floats."""
    touch = shapely.dwithin(cores[second], cores[first], radii[first] + radii[second])
    graph = nx.Graph()
    graph.add_nodes_from(i for i, c in enumerate(copper) if c.net)
    graph.add_edges_from(zip(first[touch].tolist(), second[touch].tolist(), strict=True))
    pieces: dict[str, list[list[int]]] = {}
    for found in nx.connected_components(graph):
        pieces.setdefault(copper[min(found)].net, []).append(sorted(found))
    faults = []
    for net, parts in pieces.items():
        parts.sort(key=lambda part: (-len(part), part))
        for part in parts[1:]:
            x, y = next((copper[i].at for i in part if copper[i].is_pad), copper[part[0]].at)
            faults.append(Fault("open", (net, net), x, y, 0.0, 0.0))
    return faults


def _over_edge(
    placement: Placement,
    copper: list[Copper],
    cores: NDArray[np.object_],
    radii: NDArray[np.float64],
) -> list[Fault]:
    box, corner = placement.outline, placement.corner_mm
    inner = shapely.box(
        box.x_min_mm + corner, box.y_min_mm + corner, box.x_max_mm - corner, box.y_max_mm - corner
    )
    from_edge, from_hole = placement.edge_clearance_mm, placement.hole_clearance_mm
    edges = [(inner.buffer(corner, quad_segs=64).exterior, 0.0, "edge", from_edge)]
    edges += [
        (shapely.Point(at), diameter_mm / 2, "hole", from_hole)
        for at, diameter_mm in placement.unplated
    ]
    faults = []
    for edge, radius, what, gap in edges:
        reach = radii + radius
        near = shapely.dwithin(cores, edge, reach + gap - _NOISE_MM)
        for i in np.flatnonzero(near):
            line = shapely.shortest_line(cores[i], edge)
            x, y = line.coords[0]
            apart = float(line.length - reach[i])
            nets = copper[i].net, what
            faults.append(Fault("edge", nets, x, y, apart, gap))
    return faults


def _kept_out(
    placement: Placement,
    copper: list[Copper],
    cores: NDArray[np.object_],
    radii: NDArray[np.float64],
) -> list[Fault]:
    """Copper where none may be."""
    faults = []
    for box in placement.keep_outs:
        area = shapely.box(*box.bounds_mm)
        for i in np.flatnonzero(shapely.dwithin(cores, area, radii - _NOISE_MM)):
            apart = float(area.distance(cores[i]) - radii[i])
            faults.append(Fault("keep-out", (copper[i].net, "keep-out"), *copper[i].at, apart, 0.0))
    return faults


def _drills(model: BoardModel) -> list[Fault]:
    """Neighbouring holes that leave too little board between them."""
    placement = model.placement
    holes = [(at, diameter_mm / 2, "hole") for at, diameter_mm in placement.unplated]
    holes += [((v.x_mm, v.y_mm), v.drill_mm / 2, v.net) for v in model.routing.vias]
    holes += [((p.x_mm, p.y_mm), p.pad.drill_mm / 2, p.net) for p in _plated(placement)]
    places = np.array([shapely.Point(at) for at, _, _ in holes], dtype=object)
    radii = np.array([radius for _, radius, _ in holes])
    if not holes:
        return []
    reach = 2 * radii.max() + DRILL_WALL_MM
    first, second = shapely.STRtree(places).query(places, predicate="dwithin", distance=reach)
    faults = []
    for i, j in zip(first.tolist(), second.tolist(), strict=True):
        wall = places[i].distance(places[j]) - radii[i] - radii[j]
        if i < j and wall < DRILL_WALL_MM - _NOISE_MM:
            (x, y), nets = holes[i][0], (holes[i][2], holes[j][2])
            faults.append(Fault("drill", nets, x, y, float(wall), DRILL_WALL_MM))
    return faults


def _plated(placement: Placement) -> list[PlacedPad]:
    return [p for c in placement.components for p in placed_pads(c) if p.pad.drill_mm]


def summary(faults: tuple[Fault, ...], most: int = 5) -> str:
    """The first faults, a line each."""
    lines = [str(fault) for fault in faults[:most]]
    more = len(faults) - most
    return "\n".join([*lines, f"and {more} more"] if more > 0 else lines)


def require_clean_drc(model: BoardModel) -> BoardModel:
    """The same board, if it has no fault.

    Raises:
        BuildError: it has; names the nets and the places.
    """
    faults = verify(model)
    if faults:
        raise BuildError(f"the {model.placement.name} board breaks its rules:\n{summary(faults)}")
    return model
