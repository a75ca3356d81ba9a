"""From nodes to tracks and vias."""

from lumitip_fab.boards.model import SIDES, Track, Via
from lumitip_fab.boards.routing.grid import Grid
from lumitip_fab.boards.routing.kernels import Ints
from lumitip_fab.boards.routing.rules import Rules
from lumitip_fab.boards.routing.terminals import Wanted


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
