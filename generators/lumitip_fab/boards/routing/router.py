"""Routing of a placed board."""

from collections import defaultdict

from lumitip_fab.boards.geometry import PlacedPad, placed_pads
from lumitip_fab.boards.model import Placement, Routing
from lumitip_fab.boards.routing.grid import Grid
from lumitip_fab.boards.routing.kernels import Ints
from lumitip_fab.boards.routing.negotiate import negotiate, polish
from lumitip_fab.boards.routing.obstacles import Obstacles
from lumitip_fab.boards.routing.paths import copper
from lumitip_fab.boards.routing.rules import Rules
from lumitip_fab.boards.routing.state import State
from lumitip_fab.boards.routing.terminals import TightError, Wanted, wanted
from lumitip_fab.boards.routing.trees import Unreachable
from lumitip_fab.errors import BuildError

PLACES_NAMED = 5


def route(placement: Placement) -> Routing:
    """Connect all pads of each net.

    Args:
        placement: the board before it has copper.

    Returns:
        Tracks and vias, the same for the same placement. Ground is routed like any other net,
        with the thinnest tracks; `pour` then takes away what its filled areas, which carry the
        current, make needless.

    Raises:
        BuildError: there is not enough room; names the nets and the places.
    """
    rules = Rules.of(placement)
    try:
        return _routed(placement, rules, rules.pitch_mm)
    except TightError:
        return _routed(placement, rules, rules.fine_mm)


def _routed(placement: Placement, rules: Rules, pitch_mm: float) -> Routing:
    """Tracks and vias on one grid; `TightError` where that grid has no way for a net."""
    grid = Grid.over(placement.outline, pitch_mm)
    pads = tuple(p for component in placement.components for p in placed_pads(component))
    by_net: dict[str, list[PlacedPad]] = defaultdict(list)
    for pad in pads:
        by_net[pad.net].append(pad)
    names = [n.name for n in placement.nets if len(by_net[n.name]) > 1]
    number = {n.name: i for i, n in enumerate(placement.nets, start=1)}
    fixed = Obstacles(grid, rules, number)
    state = State(grid, rules, fixed.owners(placement, pads))
    nets = [
        wanted(name, by_net[name], pads, fixed, state.owner, thin=name == placement.ground)
        for name in names
    ]
    nets.sort(
        key=lambda net: (net.wide == rules.narrow, net.name == placement.ground, _extent_mm(net))
    )
    try:
        rounds, fought = negotiate(state, nets)
    except Unreachable as fault:
        a, b = (f"{e.pad.component.ref}.{e.pad.pad.number}" for e in fault.ends)
        raise TightError(
            f"the {placement.finger} board cannot be routed: net {fault.net} finds no way from "
            f"{a} to {b} at ({fault.ends[1].pad.x_mm:.2f}, {fault.ends[1].pad.y_mm:.2f}) mm "
            "between pads, holes and edges; give the parts more room"
        ) from None
    if fought:
        raise BuildError(_unfinished(placement, grid, fought, rounds))
    polish(state, nets)
    tracks, vias = [], []
    for net in nets:
        some_tracks, some_vias = copper(grid, rules, net, state.paths(net))
        tracks += some_tracks
        vias += some_vias
    return Routing(tuple(tracks), tuple(vias), rounds)


def _extent_mm(net: Wanted) -> float:
    x = [t.pad.x_mm for t in net.terminals]
    y = [t.pad.y_mm for t in net.terminals]
    return round(max(x) - min(x) + max(y) - min(y), 6)


def _unfinished(placement: Placement, grid: Grid, fought: dict[str, Ints], rounds: int) -> str:
    places = [
        f"{name} at ({x:.1f}, {y:.1f})"
        for name, nodes in fought.items()
        for x, y in [grid.at(int(nodes[len(nodes) // 2]))]
    ]
    more = len(places) - PLACES_NAMED
    named = ", ".join(places[:PLACES_NAMED]) + (f" and {more} more" if more > 0 else "")
    return (
        f"the {placement.finger} board is not routed after {rounds} rounds: nets still share room "
        f"(mm): {named}; give the tracks more room: a larger board.channel_mm or grid.pitch_mm, "
        "finer board.track_mm and board.copper_gap_mm, or smaller parts"
    )
