"""Routing of a placed board by negotiated congestion, to tracks and vias."""

import dataclasses
import sys
from collections import defaultdict
from dataclasses import dataclass

from lumitip_fab.boards.model import SIDES, Placement, Routing, Track, Via
from lumitip_fab.boards.placed import PlacedPad, bypass_pads, placed_pads
from lumitip_fab.boards.route import stamps
from lumitip_fab.boards.route.beside import beside
from lumitip_fab.boards.route.fewer_vias import lower_via_count, polish
from lumitip_fab.boards.route.kernels import Ints
from lumitip_fab.boards.route.obstacles import Obstacles, TightError, Wanted, wanted
from lumitip_fab.boards.route.pieces import supported
from lumitip_fab.boards.route.rules import Grid, Rules
from lumitip_fab.boards.route.trees import CostWeights, State, Unreachable, connect
from lumitip_fab.errors import BuildError


def copper(grid: Grid, rules: Rules, net: Wanted, paths: Ints) -> tuple[list[Track], list[Via]]:
    """Tracks and vias of a net, straight pieces as one."""
    tracks: list[Track] = []
    vias: dict[tuple[float, float], Via] = {}
    nodes = paths.tolist()
    i = 0
    while i + 1 < len(nodes):
        a, b = nodes[i], nodes[i + 1]
        if a < 0 or b < 0:
            i += 1
        elif abs(b - a) == grid.plane:
            kind = rules.classes[rules.narrow if _necked(net, grid, a) else net.wide]
            at = grid.at(a)
            vias[at] = Via(net.name, *at, kind.via_mm, kind.via_drill_mm)
            i += 1
        else:
            j, thin = i + 1, _necked(net, grid, a, b)
            while (
                j + 1 < len(nodes)
                and nodes[j + 1] >= 0
                and nodes[j + 1] - nodes[j] == b - a
                and _necked(net, grid, nodes[j], nodes[j + 1]) == thin
            ):
                j += 1
            width = rules.classes[rules.narrow if thin else net.wide].track_mm
            side = SIDES[a // grid.plane]
            tracks.append(Track(net.name, side, grid.at(a), grid.at(nodes[j]), width))
            i = j
    return tracks, list(vias.values())


def _necked(net: Wanted, grid: Grid, *nodes: int) -> bool:
    return any(net.neck[divmod(node % grid.plane, grid.width)] for node in nodes)


LEAST_VIA_MM = 0.7  # the cost of a via does not fall below it


@dataclass(frozen=True)
class Pressure:
    """How fast a place that several nets want becomes dear."""

    growth: float
    """Factor of the price with each round."""
    history: float
    """More for each round that a node is fought for."""
    via_mm: float = LEAST_VIA_MM
    """Cost of a via, as a length of track."""
    via_decay: float = 1.0
    """Factor of that cost for a net each time that it is routed anew,"""
    late_via_decay: float = 1.0
    """and from round `LATE` on, when few nets still fight."""
    late_history: float | None = None
    """`history` from round `LATE` on, if another."""
    rounds: int = sys.maxsize
    """After this many, the next try begins."""
    backwards: bool = False
    """Whether the last net comes first."""


TRIES = (
    Pressure(
        1.6, 0.2, via_mm=12.0, via_decay=0.98, late_via_decay=0.6, late_history=0.5, rounds=90
    ),
    Pressure(1.35, 0.5),
    Pressure(1.35, 0.5, backwards=True),
    Pressure(1.2, 0.5),
    Pressure(1.1, 0.5),
    Pressure(1.2, 1.0),
    Pressure(1.35, 1.0),
)
"""One after the other, until all nets have room. Whether a crowded board is routed at last hangs on
chance: two boards of 124 and 128 cells on the area of the published 32 failed with the first of
these at cheap vias, and were routed at other growths; one of 55 cells that bends, with no vias in
the bend, was routed only with its nets in the other order. Vias are dear at first, with a slow
history, so that nets have time to find a way without; the few that still fight late get them
cheaper with each round."""
ATTEMPTS = (*((pressure, True) for pressure in TRIES[:2]), *((p, False) for p in TRIES[1:]))
"""Pressures, and whether with the vias beside capacitors: a crowded board has no room for all of
them."""
LATE = 13
FIRST_PRICE = 0.6  # of a net in the way, in the first round
TOP_PRICE = 30.0
HISTORY_REACH = 1  # nodes round it
SWEEP = 20  # rounds after which all nets are routed anew,
SWEEP_SHARE = 0.12  # while more than this share of them is in conflict
WIDER_MM = 0.1  # wider searches with each round
STUCK = 20
"""Rounds without progress, after which few nets that still fight look for a way far round:
where a board bends, two nets cannot cross each other, and the way round may be as long as it."""
FEW = 3  # nets that still fight, on a small board
STUCK_PRICE = 1000.0
STUCK_WIDER_MM = 2.0
PATIENCE = 60  # rounds without progress, before the router gives up
HOPELESS, HOPELESS_SHARE, HOPELESS_NETS = 45, 1 / 3, 30
"""Round of a try in which no more than this share of the nets may fight, or so many of them. On
boards that were routed in the end it was 3 to 22 %, on two that were not after many minutes 43 and
58 %. The tries of small boards take seconds."""


def negotiate(state: State, nets: list[Wanted], pressure: Pressure) -> tuple[int, dict[str, Ints]]:
    """Route all nets; stops after many rounds without progress.

    Args:
        state: the maps, without any net; `state.routed` has the result.
        nets: what to connect, in the order of the first round.
        pressure: how fast a place that several nets want becomes dear.

    Returns:
        Number of rounds, and the nodes that are still fought for, by net: empty on success.
    """
    weights = CostWeights(FIRST_PRICE, margin_mm=2.5, via_mm=pressure.via_mm)
    via_mm = {net.name: pressure.via_mm for net in nets}
    for net in nets:
        state.routed[net.name] = connect(state, net, [], weights)
        state.count(net, 1)
    fewest = turn = best = 0
    while True:
        turn += 1
        fought = {n.name: f for n in nets if (f := state.contested(n)).size}
        count = sum(f.size for f in fought.values())
        if turn == 1 or count < fewest:
            fewest, best = count, turn
        if not fought or turn - best > PATIENCE or turn == pressure.rounds:
            return turn, fought
        if turn == HOPELESS and len(fought) > max(HOPELESS_NETS, HOPELESS_SHARE * len(nets)):
            return turn, fought
        state.turn += 1
        late = turn >= LATE
        more = pressure.history
        if late and pressure.late_history is not None:
            more = pressure.late_history
        for nodes in fought.values():
            stamps.remember(nodes, state.history, state.marked[0], state.turn, more, HISTORY_REACH)
        few = len(fought) <= max(FEW, SWEEP_SHARE * len(nets))
        stuck = few and turn - best > STUCK
        weights = dataclasses.replace(
            weights,
            price=min(weights.price * pressure.growth, STUCK_PRICE if stuck else TOP_PRICE),
            margin_mm=weights.margin_mm + (STUCK_WIDER_MM if stuck else WIDER_MM),
        )
        sweep = turn % SWEEP == 0 and len(fought) > SWEEP_SHARE * len(nets)
        for net in (n for n in nets if sweep or n.name in fought):
            if not (sweep or state.contested(net).size):
                continue  # another net has given way in this round
            paths = [] if sweep else state.routed[net.name]
            free = [path for path in paths if not state.contested(net, path).size]
            decay = pressure.late_via_decay if late else pressure.via_decay
            via_mm[net.name] = max(via_mm[net.name] * decay, LEAST_VIA_MM)
            own = dataclasses.replace(weights, via_mm=via_mm[net.name])
            state.count(net, -1)
            state.routed[net.name] = connect(state, net, supported(net, free), own)
            state.count(net, 1)


def negotiate_until_free(state: State, nets: list[Wanted]) -> tuple[int, dict[str, Ints]]:
    """`negotiate` under one pressure after the other, until no net is in the way of another.

    The later tries leave out the vias beside capacitors. Where too many nets fight in one with
    them, these come next; where too many do without them, and no try came nearer, there is no room
    under any pressure.

    Returns:
        As `negotiate`: the rounds of all tries, and the fight of the try that came nearest.
    """
    rounds, nearest, crowded = 0, None, False
    for pressure, with_vias in ATTEMPTS:
        if with_vias and crowded:
            continue
        state.clear()
        some = nets if with_vias else [net for net in nets if not net.places.size]
        ordered = some[::-1] if pressure.backwards else some
        turns, fought = negotiate(state, ordered, pressure)
        rounds += turns
        if not fought:
            return rounds, {}
        crowded = turns == HOPELESS
        if not with_vias:  # its nets are those that must have room
            nearest = min(nearest or fought, fought, key=len)
            if crowded and nearest is fought:
                break
    return rounds, nearest or {}


PLACES_NAMED = 5


def route(placement: Placement) -> Routing:
    """Connect all pads of each net.

    Args:
        placement: the board before it has copper.

    Returns:
        Tracks and vias, the same for the same placement. Ground is routed like any other net,
        with the thinnest tracks, so that no pad depends on the filled areas of `pour`; these carry
        the current, and join the vias beside capacitors, which no track leads to.

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
    nets = [*beside(bypass_pads(placement), fixed, state.owner), *nets]
    try:
        rounds, fought = negotiate_until_free(state, nets)
    except Unreachable as fault:
        a, b = (f"{e.pad.component.ref}.{e.pad.pad.number}" for e in fault.ends)
        raise TightError(
            f"the {placement.name} board cannot be routed: net {fault.net} finds no way from "
            f"{a} to {b} at ({fault.ends[1].pad.x_mm:.2f}, {fault.ends[1].pad.y_mm:.2f}) mm "
            "between pads, holes and edges; give the parts more room"
        ) from None
    if fought:
        raise BuildError(_unfinished(placement, grid, fought, rounds))
    nets = [net for net in nets if net.name in state.routed]
    lower_via_count(state, nets, placement.ground)
    polish(state, nets, placement.ground)
    tracks, vias = [], []
    for net in nets:
        some_tracks, some_vias = copper(grid, rules, net, state.paths(net))
        tracks += some_tracks
        name = placement.ground if net.places.size else net.name
        vias += [dataclasses.replace(via, net=name) for via in some_vias]
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
        f"the {placement.name} board is not routed after {rounds} rounds: nets still share room "
        f"(mm): {named}; give the tracks more room: a larger board.channel_mm or grid.pitch_mm, "
        "finer board.track_mm and board.copper_gap_mm, or smaller parts"
    )
