"""Compiled connections of the second optical model: light from a vertex to each detector.

A vertex (an LED, or where light is scattered) and a detector are connected through the flat layers
by Snell's law. Every connection is stored with the places where it crossed the gap, so that a
specimen is a mask.
"""

import math
from typing import NamedTuple

from second_optics import (
    Floats,
    Integers,
    Stack,
    Words,
    connected,
    henyey,
    in_hexagon,
    kernel,
    transmitted,
    uniform,
)

CROSSINGS = 3
"""Passes of the gap after which a walk ends."""
WIDTH = 5 + 4 * CROSSINGS
"""Columns of a stored ray: cell, weight, origin × 10 + passes of the gap, place on the specimen
(x, y), and x, y at the receiver with dx/dz, dy/dz of each pass. Origins: 0 an LED, 1 light that the
specimen passes, 2 light that it reflects."""
SILICONE_E, FILM_E, GAP, FILM_R, SILICONE_R = range(5)
SPECULAR, SCATTERED, DIFFUSE, LED, ENDED = range(5)
FAR_MM = 30.0
REACH_MM = 13.0
_MOST_SR = 0.3  # solid angle to which the die of a connection is limited
TABLE_DEG = 2.0


class Tip(NamedTuple):
    """A pair of fingertips, for the kernels."""

    stack: Stack
    indices: Floats  # of the five layers
    x: Floats  # of the holes, those of the detectors first
    y: Floats
    detectors: int
    nearest: Integers  # cell nearest to each square millimetre
    lobe: Floats  # of the LED, per steradian, every `TABLE_DEG`
    response: Floats  # of the detector to light from these angles


class Walk(NamedTuple):
    """State of a walk, changed in place."""

    at: Floats  # x, y, z
    way: Floats  # direction
    normal: Floats  # of the face that it met
    weight: Floats  # one entry
    zone: Integers  # one entry, as `kind`, `hole` and `passed`
    kind: Integers
    hole: Integers
    passed: Integers
    crossings: Floats  # (CROSSINGS, 4)
    spawn: Floats  # x, y and weight where it first met the specimen
    absorbed: Floats  # light that ended: one entry
    thick: Floats  # of the layers of a connection


class Store(NamedTuple):
    """Stored rays."""

    rows: Floats
    used: Integers


@kernel
def hole_at(tip: Tip, x: float, y: float, emitter: bool) -> int:
    """The hole at a place of a film, −1 for none."""
    if emitter:
        x, y = x - tip.stack.emitter_x, y - tip.stack.emitter_y
    column, row = int(x + FAR_MM), int(y + FAR_MM)
    if not (0 <= column < tip.nearest.shape[0] and 0 <= row < tip.nearest.shape[1]):
        return -1
    cell = tip.nearest[column, row]
    within = in_hexagon(x - tip.x[cell], y - tip.y[cell], tip.stack.apothem)
    return cell if within else -1


@kernel
def table_at(table: Floats, cosine: float) -> float:
    """Value of a table over the angle."""
    place = math.degrees(math.acos(min(max(cosine, 0.0), 1.0))) / TABLE_DEG
    entry = min(int(place), table.size - 2)
    return float(table[entry] + (place - entry) * (table[entry + 1] - table[entry]))


@kernel
def layers_ahead(stack: Stack, zone: int, z: float, thick: Floats) -> float:
    """Fill in the thickness of each layer from a height to the detectors; the lowest index."""
    thick[:] = 0.0
    top = stack.gap + stack.film
    thick[4] = stack.detector_depth if zone < SILICONE_R else z + stack.film + stack.detector_depth
    if zone <= FILM_R:
        thick[3] = stack.film if zone < FILM_R else z + stack.film
    if zone <= GAP:
        thick[2] = stack.gap if zone < GAP else z
    if zone <= FILM_E:
        thick[1] = stack.film if zone < FILM_E else z - stack.gap
    if zone == SILICONE_E:
        thick[0] = z - top
    return 1.0 if zone <= GAP else stack.silicone_index


@kernel
def emitted(tip: Tip, walk: Walk, cosine_x: float, cosine_y: float, cosine_z: float) -> float:
    """Light per steradian that a vertex sends in a direction."""
    kind, way, normal = walk.kind[0], walk.way, walk.normal
    if kind == SCATTERED:
        film = walk.zone[0] in (FILM_E, FILM_R)
        forward = tip.stack.film_forward if film else tip.stack.silicone_forward
        return henyey(way[0] * cosine_x + way[1] * cosine_y + way[2] * cosine_z, forward)
    if kind == LED:
        return table_at(tip.lobe, -cosine_z)
    facing = normal[0] * cosine_x + normal[1] * cosine_y + normal[2] * cosine_z
    return max(float(facing), 0.0) / math.pi


@kernel
def passes(tip: Tip, walk: Walk, way_x: float, way_y: float, sine: float) -> bool:
    """Whether a connection passes the holes on its way; walks along it layer by layer."""
    x, y, hole = walk.at[0], walk.at[1], walk.hole[0]
    for layer in range(walk.zone[0], SILICONE_R):
        index = tip.indices[layer]
        far = walk.thick[layer] * sine / math.sqrt(index * index - sine * sine)
        x, y = x + way_x * far, y + way_y * far
        found = hole_at(tip, x, y, layer < GAP)
        if found < 0 or (layer in (FILM_E, FILM_R) and found != hole):
            return False
        hole = found
    return True


@kernel
def lost(tip: Tip, walk: Walk, sine: float) -> float:
    """Share of the light of a connection that faces and scattering leave."""
    left, depth = 1.0, 0.0
    for layer in range(walk.zone[0], 5):
        index = tip.indices[layer]
        cosine = math.sqrt(1.0 - sine * sine / (index * index))
        if layer != GAP:
            film = layer in (FILM_E, FILM_R)
            scatter = tip.stack.film_scatter if film else tip.stack.silicone_scatter
            depth += scatter * walk.thick[layer] / cosine
        if layer < SILICONE_R:
            left *= transmitted(cosine, index, tip.indices[layer + 1])
    return left * math.exp(-depth)


@kernel
def connect(
    tip: Tip,
    walk: Walk,
    store: Store,
    cell: int,
    across: float,
    along: float,
    share: float,
    state: Words,
) -> None:
    """Store the connection of a vertex with a point of a detector, if there is one.

    Args:
        tip: the fingertips.
        walk: at the vertex.
        store: takes the ray.
        cell: of the detector.
        across, along: place on the die, −1 to 1.
        share: by which the weight is multiplied.
        state: of the random numbers.
    """
    stack, zone = tip.stack, walk.zone[0]
    dx = tip.x[cell] + across * stack.detector_half - walk.at[0]
    dy = tip.y[cell] + along * stack.detector_half - walk.at[1]
    away = math.hypot(dx, dy)
    low = layers_ahead(stack, zone, walk.at[2], walk.thick)
    if away > REACH_MM or walk.thick[4] <= 1e-6:
        return
    sine, ratio, slope = connected(walk.thick, tip.indices, low, away)
    way_x, way_y = (dx / away, dy / away) if away > 1e-9 else (1.0, 0.0)
    if not passes(tip, walk, way_x, way_y, sine):
        return
    here, there = tip.indices[zone], tip.indices[4]
    lateral = sine / here
    down = math.sqrt(1.0 - lateral * lateral)
    steradians = 4.0 * stack.detector_half**2 / (ratio * slope * here * here * down)
    weight = share * walk.weight[0] * min(steradians, _MOST_SR)
    weight *= emitted(tip, walk, way_x * lateral, way_y * lateral, -down) * lost(tip, walk, sine)
    weight *= table_at(tip.response, math.sqrt(1.0 - sine * sine / (there * there)))
    if weight < stack.least:  # fewer rays of equal weight
        weight = stack.least if uniform(state) * stack.least < weight else 0.0
    keep(walk, store, cell, weight)
    if zone <= GAP and store.used[1] == 1:
        slant = sine / math.sqrt(1.0 - sine * sine)
        entry = 5 + 4 * walk.passed[0]
        row = store.rows[store.used[0] - 1]
        behind = 0.0  # lateral distance of the detector from where the ray leaves the gap
        for layer in (FILM_R, SILICONE_R):
            index = tip.indices[layer]
            behind += walk.thick[layer] * sine / math.sqrt(index * index - sine * sine)
        row[2] += 1.0
        row[entry] = walk.at[0] + way_x * (away - behind)
        row[entry + 1] = walk.at[1] + way_y * (away - behind)
        row[entry + 2], row[entry + 3] = -way_x * slant, -way_y * slant


@kernel
def keep(walk: Walk, store: Store, cell: int, weight: float) -> None:
    """Store a ray with what its walk has passed; `used[1]` says whether there was light."""
    store.used[1] = 1 if weight > 0.0 and store.used[0] < len(store.rows) else 0
    if weight > 0.0 and store.used[0] >= len(store.rows):
        store.used[2] += 1
    if store.used[1] == 0:
        return
    row = store.rows[store.used[0]]
    store.used[0] += 1
    row[:] = 0.0
    row[0], row[1] = cell, weight
    row[2] = walk.passed[0] + 10.0 * (1.5 + 0.5 * walk.spawn[3] if walk.spawn[3] != 0.0 else 0.0)
    row[3], row[4] = walk.spawn[0], walk.spawn[1]
    for number in range(walk.passed[0]):
        row[5 + 4 * number : 9 + 4 * number] = walk.crossings[number]
