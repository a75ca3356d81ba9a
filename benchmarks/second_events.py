"""Compiled events of the second optical model: light in silicone, in a film, across the gap."""

import math

from second_connect import (
    CROSSINGS,
    DIFFUSE,
    ENDED,
    FAR_MM,
    FILM_E,
    FILM_R,
    GAP,
    LED,
    SCATTERED,
    SILICONE_E,
    SILICONE_R,
    SPECULAR,
    Tip,
    Walk,
    hole_at,
    table_at,
)
from second_optics import (
    Words,
    about,
    henyey_cosine,
    kernel,
    refracted,
    transmitted,
    uniform,
    wall_ahead,
)


@kernel
def turn(tip: Tip, walk: Walk, state: Words) -> None:
    """Choose the direction after a vertex."""
    kind, way, normal = walk.kind[0], walk.way, walk.normal
    if kind == SCATTERED:
        film = walk.zone[0] in (FILM_E, FILM_R)
        forward = tip.stack.film_forward if film else tip.stack.silicone_forward
        cosine = henyey_cosine(uniform(state), forward)
        axis_x, axis_y, axis_z = way[0], way[1], way[2]
    else:
        cosine = math.sqrt(uniform(state))
        axis_x, axis_y, axis_z = normal[0], normal[1], normal[2]
    around = 2.0 * math.pi * uniform(state)
    way[0], way[1], way[2] = about(axis_x, axis_y, axis_z, cosine, around)
    if kind == LED:  # sampled as a Lambertian source
        walk.weight[0] *= table_at(tip.lobe, cosine) * math.pi / max(cosine, 1e-9)


@kernel
def advance(walk: Walk, by: float) -> None:
    """Move along the direction."""
    for axis in range(3):
        walk.at[axis] += by * walk.way[axis]


@kernel
def absorb(walk: Walk, albedo: float, x: float, y: float, z: float) -> None:
    """Meet a face of this albedo and normal."""
    walk.absorbed[0] += (1.0 - albedo) * walk.weight[0]
    walk.weight[0] *= albedo
    walk.normal[0], walk.normal[1], walk.normal[2] = x, y, z
    walk.kind[0] = DIFFUSE


@kernel
def cross_face(tip: Tip, walk: Walk, to: int, state: Words) -> None:
    """Meet a smooth face to another zone: pass or be reflected."""
    way = walk.way
    here, there = tip.indices[walk.zone[0]], tip.indices[to]
    walk.kind[0] = SPECULAR
    if uniform(state) < transmitted(abs(way[2]), here, there):
        way[0], way[1], way[2] = refracted(way[0], way[1], way[2], here, there)
        walk.zone[0] = to
    else:
        way[2] = -way[2]


@kernel
def in_silicone(tip: Tip, walk: Walk, state: Words) -> None:
    """To the next event in the silicone between a board and its film."""
    stack, emitter = tip.stack, walk.zone[0] == SILICONE_E
    side = 1.0 if emitter else -1.0
    inner = stack.gap + stack.film if emitter else -stack.film
    towards_film = side * walk.way[2] < 0.0
    plane = inner if towards_film else inner + side * stack.board
    far = (plane - walk.at[2]) / walk.way[2] if walk.way[2] != 0.0 else 1e9
    free = -math.log(1.0 - uniform(state)) / max(stack.silicone_scatter, 1e-12)
    advance(walk, min(free, far))
    if free < far:
        walk.kind[0] = SCATTERED
        return
    walk.at[2] = plane
    if not towards_film:
        absorb(walk, stack.board_albedo, 0.0, 0.0, -side)
        return
    hole = hole_at(tip, walk.at[0], walk.at[1], emitter)
    if hole < 0:
        absorb(walk, stack.film_albedo, 0.0, 0.0, side)
        return
    walk.hole[0] = hole
    cross_face(tip, walk, FILM_E if emitter else FILM_R, state)


@kernel
def in_film(tip: Tip, walk: Walk, state: Words) -> None:
    """To the next event in the clear film of a hole, whose walls are opaque."""
    stack, emitter = tip.stack, walk.zone[0] == FILM_E
    low = stack.gap if emitter else -stack.film
    plane = low + stack.film if walk.way[2] > 0.0 else low
    far = (plane - walk.at[2]) / walk.way[2] if walk.way[2] != 0.0 else 1e9
    hole = walk.hole[0]
    x = walk.at[0] - tip.x[hole] - (stack.emitter_x if emitter else 0.0)
    y = walk.at[1] - tip.y[hole] - (stack.emitter_y if emitter else 0.0)
    wall, number = wall_ahead(x, y, walk.way[0], walk.way[1], stack.apothem)
    free = -math.log(1.0 - uniform(state)) / max(stack.film_scatter, 1e-12)
    advance(walk, min(free, far, wall))
    if free < min(far, wall):
        walk.kind[0] = SCATTERED
    elif wall < far:
        towards = math.pi / 6.0 + number * math.pi / 3.0
        absorb(walk, stack.wall_albedo, -math.cos(towards), -math.sin(towards), 0.0)
    else:
        walk.at[2] = plane
        to_gap = emitter == (walk.way[2] < 0.0)
        inside = SILICONE_E if emitter else SILICONE_R
        cross_face(tip, walk, GAP if to_gap else inside, state)


@kernel
def in_gap(tip: Tip, walk: Walk, state: Words) -> None:
    """Across the gap to the other finger."""
    stack, down = tip.stack, walk.way[2] < 0.0
    plane = 0.0 if down else stack.gap
    at, way, number = walk.at, walk.way, walk.passed[0]
    slant_x, slant_y = way[0] / way[2], way[1] / way[2]
    if number >= CROSSINGS or abs(slant_x) + abs(slant_y) > FAR_MM:
        walk.kind[0] = ENDED
        return
    if down and number == 0 and walk.spawn[2] == 0.0 and at[2] > stack.specimen:
        rise = stack.specimen - at[2]
        walk.spawn[0], walk.spawn[1] = at[0] + slant_x * rise, at[1] + slant_y * rise
        walk.spawn[2] = walk.weight[0]
    row = walk.crossings[number]
    row[0], row[1] = at[0] - slant_x * at[2], at[1] - slant_y * at[2]
    row[2], row[3] = slant_x, slant_y
    walk.passed[0] += 1
    at[0], at[1], at[2] = row[0] + slant_x * plane, row[1] + slant_y * plane, plane
    hole = hole_at(tip, at[0], at[1], not down)
    if hole < 0:
        absorb(walk, stack.face_albedo, 0.0, 0.0, 1.0 if down else -1.0)
        return
    walk.hole[0] = hole
    cross_face(tip, walk, FILM_R if down else FILM_E, state)
