"""Compiled inner loops of the router: the search, and the area that copper blocks.

All work on a grid of nodes `(layer, y, x)`, front and back. A node index is
`(layer * height + y) * width + x`. Directions 0 to 7 go counter-clockwise from +x in steps of
45°; `VIA` changes the layer. Plane 0 and 1 of a map are for tracks on a layer, plane 2 is for
vias.
"""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np
from numba import njit
from numpy.typing import NDArray

Ints = NDArray[np.int32]
Shorts = NDArray[np.int16]
Bytes = NDArray[np.uint8]
Reals = NDArray[np.float32]

VIA = 8
SOURCE = 9
BLOCKED = -1
INSIDE_PAD = 0x100  # a node of the net where tracks may leave in any direction
DX = np.array([1, 1, 0, -1, -1, -1, 0, 1], dtype=np.int32)
DY = np.array([0, 1, 1, 1, 0, -1, -1, -1], dtype=np.int32)
STEP = np.array([1.0, 2**0.5] * 4)

_F = TypeVar("_F", bound=Callable[..., Any])


def kernel(function: _F) -> _F:
    """Compile on first use, and keep the machine code beside the source for later runs."""
    return cast(_F, njit(cache=True)(function))


@kernel
def _sift_up(keys: NDArray[np.float64], nodes: Ints, at: int) -> None:
    key, node = keys[at], nodes[at]
    while at > 0:
        above = (at - 1) >> 1
        if keys[above] <= key:
            break
        keys[at], nodes[at] = keys[above], nodes[above]
        at = above
    keys[at], nodes[at] = key, node


@kernel
def _sift_down(keys: NDArray[np.float64], nodes: Ints, size: int) -> None:
    """Put what is on top of the heap in its place.

    It comes from the bottom, where it mostly ends again: the gap goes down to a leaf first, and
    then comes up again as far as needed. That spares a test at each level. Indices are unsigned
    in the loops that run most: numba looks at the sign of others.
    """
    key, node = keys[0], nodes[0]
    one, two = np.uint64(1), np.uint64(2)
    at, below, count = np.uint64(0), np.uint64(1), np.uint64(size)
    while below + one < count:
        below += np.uint64(keys[below + one] < keys[below])
        keys[at], nodes[at] = keys[below], nodes[below]
        at, below = below, two * below + one
    if below < count:
        keys[at], nodes[at] = keys[below], nodes[below]
        at = below
    while at > np.uint64(0):
        above = (at - one) >> one
        if keys[above] < key:
            break
        keys[at], nodes[at] = keys[above], nodes[above]
        at = above
    keys[at], nodes[at] = key, node


@kernel
def _left(y: int, x: int, box: Ints) -> float:
    """Octile distance to a box of nodes."""
    dx = max(box[2] - x, x - box[3], 0)
    dy = max(box[0] - y, y - box[1], 0)
    return float(max(dx, dy) + (2**0.5 - 1) * min(dx, dy))


@kernel
def search(  # noqa: PLR0912, PLR0915 - one loop; calls would hand on a score of arrays
    owner: Shorts,
    taken: Shorts,
    history: Reals,
    tree: Shorts,
    starts: Ints,
    target: Bytes,
    box: Ints,
    window: Ints,
    neck: Bytes,
    near_via: Bytes,
    via_reach: float,
    net: int,
    wide: int,
    narrow: int,
    crowded: float,
    grain: NDArray[np.float64],
    costs: NDArray[np.float64],
    to_layer: NDArray[np.float64],
    reached: NDArray[np.float64],
    came: Ints,
    turn: int,
    keys: NDArray[np.float64],
    queue: Ints,
    work: NDArray[np.int64],
) -> Ints:
    """The cheapest path between two parts of a net, or nothing (length 0).

    Args:
        owner: `(classes, 3, H, W)`: 0 where any net may be, `BLOCKED`, or the only net that may.
        taken: same shape: number of other nets too near for copper of the class.
        history: `(2, H, W)`: how often a node was fought for.
        tree: `(2 * H * W,)`: of the net's nodes a bit for each direction that has a track, and
            `INSIDE_PAD`; other tracks meet it at right angles or flatter.
        starts: nodes to start from, all of the net's.
        target: `(2 * H * W,)`: 1 at the nodes to reach, all of the net's.
        box: of the target: first and last y, first and last x.
        window: where to search, in the same form.
        neck: `(H, W)`: 1 where the narrow class applies.
        near_via: `(H, W)`: 1 where a new via would be too near to one of this net.
        via_reach: squared distance of two vias of a net that is enough, in steps of the grid.
        net: its number.
        wide: its class.
        narrow: its class beside pads narrower than its tracks.
        crowded: present cost of each net in the way.
        grain: `(2, 8)`: length of a step, more across the grain of a layer.
        costs: of a via, and of bends of 45°, 90° and 135°, in steps of the grid.
        to_layer: `(2,)`: the least that vias still cost from each layer, 0 on one with a target.
        reached, came: scratch of `2 * H * W`: cost; turn of last use, times 16, and direction.
        turn: number of this search, above all before it.
        keys, queue: scratch of the heap.
        work: `(1,)`: nodes visited so far by all searches, counted on.

    Returns:
        Nodes from start to target.
    """
    height, width = owner.shape[2], owner.shape[3]
    plane = height * width
    # Of each class in a row, so that the index of a node is that of its place on a layer.
    holders = owner.reshape(owner.shape[0], 3 * plane)
    others = taken.reshape(taken.shape[0], 3 * plane)
    fought, necks, near = history.ravel(), neck.ravel(), near_via.ravel()
    capacity = keys.shape[0] - 12
    mark = np.int32(turn << 4)
    size = 0
    for node in starts:
        rest = node % plane
        y, x = rest // width, rest % width
        if y < window[0] or y > window[1] or x < window[2] or x > window[3]:
            continue
        if size >= capacity:
            break
        reached[node], came[node] = 0.0, mark | SOURCE
        keys[size], queue[size] = _left(y, x, box) + to_layer[node // plane], node
        _sift_up(keys, queue, size)
        size += 1
    end = -1
    while size > 0 and size < capacity:
        node, key = queue[0], keys[0]
        size -= 1
        keys[0], queue[0] = keys[size], queue[size]
        if size > 0:
            _sift_down(keys, queue, size)
        layer, rest = node // plane, node % plane
        y, x = rest // width, rest % width
        so_far = reached[node]
        if key > so_far + _left(y, x, box) + to_layer[layer] + 1e-3:
            continue
        work[0] += 1
        if target[node]:
            end = node
            break
        before = came[node] & 15
        here = tree[node] if before == SOURCE else 0
        for way in range(8):
            bend = 0.0
            if before < VIA:
                apart = (way - before) & 7
                apart = min(apart, 8 - apart)
                if apart > 3:
                    continue
                bend = costs[apart] if apart else 0.0
            elif here and not here & INSIDE_PAD:
                sharp = (1 << ((way + 1) & 7)) | (1 << way) | (1 << ((way + 7) & 7))
                if here & sharp:
                    continue
            ny, nx = y + DY[way], x + DX[way]
            if ny < window[0] or ny > window[1] or nx < window[2] or nx > window[3]:
                continue
            flat = np.uint64(ny * width + nx)
            there = np.uint64(node + DY[way] * width + DX[way])
            known = reached[there] - 1e-4 if came[there] >> 4 == turn else np.inf
            length = grain[layer, way]
            if so_far + bend + length >= known:
                continue  # not even over free nodes; most neighbours end here, and cheaply
            c = narrow if necks[flat] else wide
            holder = holders[c, there]
            if holder not in (0, net):
                continue
            at_goal = tree[there]
            if at_goal:
                if not target[there]:
                    continue
                back = way + 4
                sharp = (1 << ((back + 1) & 7)) | (1 << (back & 7)) | (1 << ((back + 7) & 7))
                if not at_goal & INSIDE_PAD and at_goal & sharp:
                    continue
            cost = so_far + bend + length * (1 + fought[there]) * (1 + crowded * others[c, there])
            if cost < known:
                reached[there], came[there] = cost, mark | way
                keys[size] = cost + _left(ny, nx, box) + to_layer[layer]
                queue[size] = there
                _sift_up(keys, queue, size)
                size += 1
        if before == VIA or near[rest]:
            continue
        there = np.uint64(node + plane if layer == 0 else node - plane)
        known = reached[there] - 1e-4 if came[there] >> 4 == turn else np.inf
        if so_far + costs[0] >= known:
            continue
        c = narrow if necks[rest] else wide
        holder = holders[c, 2 * plane + rest]
        if holder not in (0, net) or (tree[there] and not target[there]):
            continue
        cost = so_far + costs[0] * (1 + fought[rest] + fought[plane + rest]) * (
            1 + crowded * others[c, 2 * plane + rest]
        )
        if cost < known and not _via_behind(node, came, plane, width, via_reach):
            reached[there], came[there] = cost, mark | VIA
            keys[size], queue[size] = cost + _left(y, x, box) + to_layer[1 - layer], there
            _sift_up(keys, queue, size)
            size += 1
    if end < 0:
        return np.empty(0, dtype=np.int32)
    return _walked(end, came, plane, width)


@kernel
def _via_behind(node: int, came: Ints, plane: int, width: int, reach: float) -> bool:
    """Whether the path to a node has a via nearer to it than the square root of `reach`."""
    y, x = node % plane // width, node % width
    while came[node] & 15 not in (SOURCE, VIA):
        node = _before(node, came[node] & 15, plane, width)
        dy, dx = node % plane // width - y, node % width - x
        if dy * dy + dx * dx >= reach:
            return False
    return bool(came[node] & 15 == VIA)


@kernel
def _walked(end: int, came: Ints, plane: int, width: int) -> Ints:
    count, node = 1, end
    while came[node] & 15 != SOURCE:
        node = _before(node, came[node] & 15, plane, width)
        count += 1
    path = np.empty(count, dtype=np.int32)
    node = end
    for i in range(count - 1, -1, -1):
        path[i] = node
        if i:
            node = _before(node, came[node] & 15, plane, width)
    return path


@kernel
def _before(node: int, way: int, plane: int, width: int) -> int:
    if way == VIA:
        return node - plane if node >= plane else node + plane
    return int(node - DY[way] * width - DX[way])
