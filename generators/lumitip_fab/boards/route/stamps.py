"""The room that a net's copper takes from other nets, compiled.

A net is a list of nodes, path after path, each path ended by -1. Radii are squared, in steps of
the grid: `(own class, other class, 2 planes kinds, 2)`, where the plane kind is 0 for tracks and
1 for vias of the other net, and the last axis holds the radius beside a track and round its ends.
"""

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.boards.route.kernels import (
    DX,
    DY,
    INSIDE_PAD,
    VIA,
    Bytes,
    Ints,
    Reals,
    Shorts,
    kernel,
)

Radii = NDArray[np.float64]


@kernel
def way_of(dy: int, dx: int) -> int:
    """Direction of a step between neighbouring nodes."""
    for way in range(8):
        if DY[way] == dy and DX[way] == dx:
            return way
    return VIA


@kernel
def _disc(taken: Shorts, marked: Ints, turn: int, add: int, y: int, x: int, radius: float) -> None:
    reach = int(np.ceil(np.sqrt(radius)))
    for v in range(max(y - reach, 0), min(y + reach + 1, taken.shape[0])):
        for u in range(max(x - reach, 0), min(x + reach + 1, taken.shape[1])):
            near = (v - y) ** 2 + (u - x) ** 2 < radius - 1e-6
            if near and marked[v, u] != turn:
                marked[v, u] = turn
                taken[v, u] += add


@kernel
def _capsule(
    taken: Shorts,
    marked: Ints,
    turn: int,
    add: int,
    y0: int,
    x0: int,
    y1: int,
    x1: int,
    radius: Radii,
) -> None:
    reach = int(np.ceil(np.sqrt(radius.max())))
    dy, dx = y1 - y0, x1 - x0
    square = dy * dy + dx * dx
    slant = dx / dy if dy else 0.0
    for v in range(max(min(y0, y1) - reach, 0), min(max(y0, y1) + reach + 1, taken.shape[0])):
        low, high = min(x0, x1) - reach, max(x0, x1) + reach
        if dy and dx:  # of a slanting track only what is near it in this row
            middle = x0 + (v - y0) * slant
            low, high = (
                max(low, int(middle - 1.5 * reach)),
                min(high, int(middle + 1.5 * reach) + 1),
            )
        for u in range(max(low, 0), min(high + 1, taken.shape[1])):
            if marked[v, u] == turn:
                continue
            along = (v - y0) * dy + (u - x0) * dx
            if along <= 0:
                near = (v - y0) ** 2 + (u - x0) ** 2 < radius[1] - 1e-6
            elif along >= square:
                near = (v - y1) ** 2 + (u - x1) ** 2 < radius[1] - 1e-6
            else:
                off = (u - x0) * dy - (v - y0) * dx
                near = off * off < (radius[0] - 1e-6) * square
            if near:
                marked[v, u] = turn
                taken[v, u] += add


@kernel
def stamp(
    net: Ints,
    taken: Shorts,
    marked: Ints,
    turn: int,
    add: int,
    neck: Bytes,
    wide: int,
    narrow: int,
    tracks: Radii,
    vias: Radii,
) -> None:
    """Count a net in all nodes where it is too near for other nets, or (add = -1) no longer.

    Args:
        net: its nodes.
        taken: `(classes, 3, H, W)`: the count.
        marked: same shape: scratch, turn of the last count.
        turn: number of this call, above all before it.
        add: 1 or -1.
        neck: `(H, W)`: 1 where the narrow class applies.
        wide: its class.
        narrow: its class beside narrow pads.
        tracks: radii of its tracks.
        vias: radii of its vias.
    """
    height, width = taken.shape[2], taken.shape[3]
    plane = height * width
    i = 0
    while i + 1 < net.size:
        a, b = net[i], net[i + 1]
        if a < 0 or b < 0:
            i += 1
            continue
        layer, rest = a // plane, a % plane
        y0, x0 = rest // width, rest % width
        own = narrow if neck[y0, x0] or neck[b % plane // width, b % plane % width] else wide
        if b // plane != layer:
            own = narrow if neck[y0, x0] else wide
            for c in range(taken.shape[0]):
                for p in range(3):
                    _disc(taken[c, p], marked[c, p], turn, add, y0, x0, vias[own, c, p // 2, 1])
            i += 1
            continue
        step, j = b - a, i + 1
        while j + 1 < net.size and net[j + 1] - net[j] == step:
            ny, nx = net[j + 1] % plane // width, net[j + 1] % plane % width
            here = neck[net[j] % plane // width, net[j] % plane % width]
            if (narrow if here or neck[ny, nx] else wide) != own:
                break
            j += 1
        rest = net[j] % plane
        for c in range(taken.shape[0]):
            for p, kind in ((layer, 0), (2, 1)):
                _capsule(
                    taken[c, p],
                    marked[c, p],
                    turn,
                    add,
                    y0,
                    x0,
                    rest // width,
                    rest % width,
                    tracks[own, c, kind],
                )
        i = j


@kernel
def mark(path: Ints, tree: Shorts, near_via: Bytes, via_reach: float) -> None:
    """Note at a path's nodes which ways its tracks go, and where it has vias.

    Args:
        path: of the net at hand.
        tree, near_via, via_reach: see `search`.
    """
    height, width = near_via.shape
    plane, reach = height * width, int(np.sqrt(via_reach)) + 1
    for i in range(path.size - 1):
        a, b = path[i], path[i + 1]
        y, x = a % plane // width, a % width
        way = way_of(b % plane // width - y, b % width - x)
        if way != VIA:
            tree[a] |= 1 << way
            tree[b] |= 1 << ((way + 4) & 7)
            continue
        tree[a] |= INSIDE_PAD
        tree[b] |= INSIDE_PAD
        for v in range(max(y - reach, 0), min(y + reach + 1, height)):
            for u in range(max(x - reach, 0), min(x + reach + 1, width)):
                if (v - y) ** 2 + (u - x) ** 2 < via_reach:
                    near_via[v, u] = 1


@kernel
def conflicts(net: Ints, taken: Shorts, neck: Bytes, wide: int, narrow: int) -> Ints:
    """Nodes of a counted net that are in the room of another one."""
    height, width = taken.shape[2], taken.shape[3]
    plane = height * width
    found = np.empty(net.size, dtype=np.int32)
    count = 0
    for i in range(net.size):
        node = net[i]
        if node < 0:
            continue
        rest = node % plane
        y, x = rest // width, rest % width
        c = narrow if neck[y, x] else wide
        through = i + 1 < net.size and net[i + 1] >= 0 and net[i + 1] // plane != node // plane
        if taken[c, node // plane, y, x] > 1 or (through and taken[c, 2, y, x] > 1):
            found[count] = node
            count += 1
    return found[:count]


@kernel
def remember(nodes: Ints, history: Reals, marked: Ints, turn: int, more: float, reach: int) -> None:
    """Raise the history round nodes that were fought for, once a turn."""
    height, width = history.shape[1], history.shape[2]
    plane = height * width
    for node in nodes:
        layer, rest = node // plane, node % plane
        y, x = rest // width, rest % width
        for v in range(max(y - reach, 0), min(y + reach + 1, height)):
            for u in range(max(x - reach, 0), min(x + reach + 1, width)):
                near = (v - y) ** 2 + (u - x) ** 2 <= reach * reach
                if near and marked[layer, v, u] != turn:
                    marked[layer, v, u] = turn
                    history[layer, v, u] += more
