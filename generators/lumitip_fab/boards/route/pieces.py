"""The connected parts of a net while it is routed, and which of its paths may stay."""

from collections import Counter
from dataclasses import dataclass

import numpy as np

from lumitip_fab.boards.route.kernels import Ints
from lumitip_fab.boards.route.obstacles import Wanted


@dataclass
class Piece:
    """A connected part of a net."""

    terminals: list[int]
    """Numbers of its pads."""
    nodes: list[Ints]


Near = tuple[float, int, int]
"""Distance of two parts of a net (mm), and the numbers of their nearest pads."""


def supported(net: Wanted, paths: list[Ints]) -> list[Ints]:
    """Those paths of a net whose both ends are in a pad or at another such path."""
    pads = {n for t in net.terminals for n in t.nodes.tolist()}
    nodes = [set(path.tolist()) for path in paths]
    ends = [(int(path[0]), int(path[-1])) for path in paths]
    loose = {end for both in ends for end in both} - pads
    on_paths = Counter(n for some in nodes for n in some & loose)
    left = list(range(len(paths)))
    while True:
        # An end counts its own path, too.
        firm = [i for i in left if all(e not in loose or on_paths[e] > 1 for e in ends[i])]
        if len(firm) == len(left):
            return [paths[i] for i in firm]
        for i in set(left) - set(firm):
            on_paths.subtract(nodes[i] & loose)
        left = firm


def pieces(net: Wanted, kept: list[Ints]) -> list[Piece]:
    """Connected parts of a net, the largest first."""
    found = {i: Piece([i], [t.nodes]) for i, t in enumerate(net.terminals)}
    within = list(found)  # of each part that there ever was, the one that it has become part of

    def whole(part: int) -> int:
        while within[part] != part:
            within[part] = within[within[part]]
            part = within[part]
        return part

    part_of = {n: i for i, t in enumerate(net.terminals) for n in t.nodes.tolist()}
    for path in kept:
        on_path = path.tolist()
        one, number = Piece([], [path]), len(within)
        for part in dict.fromkeys(whole(part_of[n]) for n in on_path if n in part_of):
            within[part] = number
            met = found.pop(part)
            one.terminals += met.terminals
            one.nodes += met.nodes
        within.append(number)
        found[number] = one
        part_of.update(dict.fromkeys(on_path, number))
    return sorted(found.values(), key=lambda p: -len(p.terminals))


def nearest(net: Wanted, terminals: list[int], piece: Piece) -> Near:
    """Of some pads the one that is nearest to a part of the net, and that part's nearest to it."""
    apart_mm = net.apart_mm
    return min(
        ((apart_mm[a][b], a, b) for a in terminals for b in piece.terminals), key=lambda f: f[0]
    )


def with_nodes(nodes: Ints, more: list[Ints]) -> Ints:
    """Nodes in rising order, each once, and more of them."""
    added = np.unique(np.concatenate(more))
    at = np.searchsorted(nodes, added)
    new = nodes[np.minimum(at, nodes.size - 1)] != added
    return np.insert(nodes, at[new], added[new])
