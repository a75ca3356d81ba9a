"""Negotiated congestion: nets share what they want at a rising price until none must.

After L. McMurchie and C. Ebeling, "PathFinder: a negotiation-based performance-driven router for
FPGAs", FPGA 1995: each net takes its cheapest tree, room wanted by several becomes dearer with
every round and stays dear where it was fought for before, and only nets in conflict are routed
anew.
"""

import dataclasses

from lumitip_fab.boards.routing import stamps
from lumitip_fab.boards.routing.kernels import Ints
from lumitip_fab.boards.routing.state import State
from lumitip_fab.boards.routing.terminals import Wanted
from lumitip_fab.boards.routing.trees import Taste, connect, supported

FIRST_PRICE = 0.6  # of a net in the way, in the first round
PRICE_GROWTH = 1.35
TOP_PRICE = 30.0
HISTORY = 0.5  # more for each round that a node is fought for
HISTORY_REACH = 1  # nodes round it
SWEEP = 20  # rounds after which all nets are routed anew,
SWEEP_SHARE = 0.12  # while more than this share of them is in conflict
WIDER_MM = 0.1  # wider searches with each round
DEAR = 1e5  # price that no net pays when another way is left
PATIENCE = 60  # rounds without progress, before a board is given up
POLISHES = 2

NEGOTIATION = Taste(FIRST_PRICE, margin_mm=2.5, via_mm=0.7)
BEAUTY = Taste(DEAR, via_mm=2.0, bend_mm=0.5, across=1.2)


def negotiate(state: State, nets: list[Wanted]) -> tuple[int, dict[str, Ints]]:
    """Route all nets; given up when many rounds have brought nothing.

    Args:
        state: the maps; `state.routed` has the result.
        nets: what to connect, in the order of the first round.

    Returns:
        Number of rounds, and the nodes that are still fought for, by net: empty on success.
    """
    taste = NEGOTIATION
    for net in nets:
        state.routed[net.name] = connect(state, net, [], NEGOTIATION)
        state.count(net, 1)
    fewest = turn = best = 0
    while True:
        turn += 1
        fought = {n.name: f for n in nets if (f := state.fought_for(n)).size}
        count = sum(f.size for f in fought.values())
        if turn == 1 or count < fewest:
            fewest, best = count, turn
        if not fought or turn - best > PATIENCE:
            return turn, fought
        state.turn += 1
        for nodes in fought.values():
            stamps.remember(
                nodes, state.history, state.marked[0], state.turn, HISTORY, HISTORY_REACH
            )
        taste = dataclasses.replace(
            taste,
            price=min(taste.price * PRICE_GROWTH, TOP_PRICE),
            margin_mm=taste.margin_mm + WIDER_MM,
        )
        sweep = turn % SWEEP == 0 and len(fought) > SWEEP_SHARE * len(nets)
        for net in (n for n in nets if sweep or n.name in fought):
            if not (sweep or state.fought_for(net).size):
                continue  # another net has given way in this round
            paths = [] if sweep else state.routed[net.name]
            free = [path for path in paths if not state.fought_for(net, path).size]
            state.count(net, -1)
            state.routed[net.name] = connect(state, net, supported(net, free), taste)
            state.count(net, 1)


def polish(state: State, nets: list[Wanted]) -> None:
    """Route every net anew through the room that the others leave, for looks alone."""
    state.history[:] = 0
    for _ in range(POLISHES):
        for net in nets:
            before = state.routed[net.name]
            state.count(net, -1)
            state.routed[net.name] = connect(state, net, [], BEAUTY)
            state.count(net, 1)
            if state.fought_for(net).size:
                state.count(net, -1)
                state.routed[net.name] = before
                state.count(net, 1)
