"""Compiled path tracer of the second optical model: walks of light from the LEDs.

A walk starts at an LED and is refracted, reflected, scattered and absorbed. From each vertex where
it is scattered all detectors are connected (`second_connect`).
"""

import math

import numpy as np

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
    Store,
    Tip,
    Walk,
    connect,
    hole_at,
    table_at,
)
from second_optics import (
    Floats,
    Words,
    about,
    henyey_cosine,
    kernel,
    refracted,
    transmitted,
    uniform,
    wall_ahead,
)

_NEAR_MM, _SKIP = 7.5, 8  # pairs further apart have one of so many direct rays
_LEAST = 0.02  # share of its first weight below which a walk survives by chance
_PARTS = 12  # of a walk that reaches the receiver's film
_RETURNS = 4  # one of so many walks is followed from the specimen back to the emitter
_EVENTS = 200  # after which a walk ends
_STEPS = (0.8566748838545029, 0.733891856627126, 0.6287067210378087, 0.5385972572236101)


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


@kernel
def new_walk() -> Walk:
    """Arrays for the state of a walk."""
    return Walk(
        np.zeros(3),
        np.zeros(3),
        np.zeros(3),
        np.zeros(1),
        np.zeros(1, np.int64),
        np.zeros(1, np.int64),
        np.zeros(1, np.int64),
        np.zeros(1, np.int64),
        np.zeros((CROSSINGS, 4)),
        np.zeros(4),
        np.zeros(2),
        np.zeros(5),
    )


@kernel
def start(tip: Tip, walk: Walk, led: int, across: float, along: float, weight: float) -> None:
    """Put a walk on the die of an LED; the place is -1 to 1."""
    stack = tip.stack
    walk.at[0] = tip.x[led] + stack.emitter_x + across * stack.led_half
    walk.at[1] = tip.y[led] + stack.emitter_y + along * stack.led_half
    walk.at[2] = stack.gap + stack.film + stack.led_depth
    walk.normal[0], walk.normal[1], walk.normal[2] = 0.0, 0.0, -1.0
    walk.zone[0], walk.kind[0], walk.passed[0], walk.weight[0] = SILICONE_E, LED, 0, weight
    walk.spawn[:] = 0.0


@kernel
def direct(tip: Tip, walk: Walk, store: Store, led: int, count: int, state: Words) -> None:
    """Straight rays from an LED to all detectors, on a sequence that fills both dies evenly."""
    for cell in range(tip.detectors):
        near = math.hypot(tip.x[cell] - tip.x[led], tip.y[cell] - tip.y[led]) < _NEAR_MM
        step = 1 if near else _SKIP
        p, q, r, s = uniform(state), uniform(state), uniform(state), uniform(state)
        for number in range(0, count, step):
            a = 2.0 * ((p + number // step * _STEPS[0]) % 1.0) - 1.0
            b = 2.0 * ((q + number // step * _STEPS[1]) % 1.0) - 1.0
            c = 2.0 * ((r + number // step * _STEPS[2]) % 1.0) - 1.0
            d = 2.0 * ((s + number // step * _STEPS[3]) % 1.0) - 1.0
            start(tip, walk, led, a, b, step / count)
            connect(tip, walk, store, cell, c, d, 1.0, state)


@kernel
def connect_all(tip: Tip, walk: Walk, store: Store, state: Words) -> None:
    """Connect a vertex with the detectors near it, and by chance with others."""
    zone = walk.zone[0]
    if zone <= GAP and walk.passed[0] >= CROSSINGS:
        return
    if zone == GAP and walk.normal[2] > 0.0:
        return
    for cell in range(tip.detectors):
        near = math.hypot(tip.x[cell] - walk.at[0], tip.y[cell] - walk.at[1]) < _NEAR_MM
        if near or uniform(state) < 1.0 / _SKIP:
            across, along = 2.0 * uniform(state) - 1.0, 2.0 * uniform(state) - 1.0
            connect(tip, walk, store, cell, across, along, 1.0 if near else _SKIP, state)


@kernel
def step(tip: Tip, walk: Walk, store: Store, first: float, state: Words) -> bool:
    """To the next event of a walk, and connect it; whether the walk goes on.

    A walk goes on by chance alone once its weight is a small part of the first one.
    """
    if walk.kind[0] != SPECULAR:
        turn(tip, walk, state)
    zone = walk.zone[0]
    if zone in (SILICONE_E, SILICONE_R):
        in_silicone(tip, walk, state)
    elif zone in (FILM_E, FILM_R):
        in_film(tip, walk, state)
    else:
        in_gap(tip, walk, state)
    if walk.kind[0] == ENDED or max(abs(walk.at[0]), abs(walk.at[1])) > FAR_MM:
        return False
    if walk.kind[0] == SPECULAR:
        return True
    connect_all(tip, walk, store, state)
    return survives(walk, 0.1, state) if walk.weight[0] < _LEAST * first else True


@kernel
def survives(walk: Walk, chance: float, state: Words) -> bool:
    """Whether a walk goes on, with more weight, so that its mean stays."""
    if uniform(state) > chance:
        return False
    more = walk.weight[0] * (1.0 / chance - 1.0)
    walk.absorbed[1] -= more
    walk.weight[0] += more
    return True


@kernel
def follow(tip: Tip, walk: Walk, store: Store, state: Words) -> None:
    """Follow a walk from a vertex to its end, or to the receiver's film."""
    first = walk.weight[0]
    for _ in range(_EVENTS):
        if not step(tip, walk, store, first, state):
            break
        if walk.zone[0] == FILM_R:
            split(tip, walk, store, state)
            return
    walk.absorbed[1] += walk.weight[0]


@kernel
def split(tip: Tip, walk: Walk, store: Store, state: Words) -> None:
    """Follow many walks into the receiver's film, each with a part of the weight.

    Dies are small and near there, so few walks would give a few bright spots.
    """
    at, way, crossings = walk.at.copy(), walk.way.copy(), walk.crossings.copy()
    hole, passed, weight = walk.hole[0], walk.passed[0], walk.weight[0] / _PARTS
    for _ in range(_PARTS):
        walk.at[:], walk.way[:], walk.crossings[:] = at, way, crossings
        walk.hole[0], walk.passed[0], walk.weight[0] = hole, passed, weight
        walk.zone[0], walk.kind[0] = FILM_R, SPECULAR
        back = False
        for _ in range(_EVENTS):
            if not step(tip, walk, store, walk.weight[0] if back else weight, state):
                break
            if walk.zone[0] == GAP and not back:
                back = True
                if not survives(walk, 1.0 / _PARTS, state):
                    break
        walk.absorbed[1] += walk.weight[0]


@kernel
def from_specimen(tip: Tip, walk: Walk, store: Store, state: Words) -> None:
    """Light that a white specimen would scatter: down to the detectors, and back to the emitter."""
    stack = tip.stack
    weight = walk.spawn[2]
    for side in (-1.0, 1.0):
        walk.at[0], walk.at[1], walk.at[2] = walk.spawn[0], walk.spawn[1], stack.specimen
        walk.normal[0], walk.normal[1], walk.normal[2] = 0.0, 0.0, side
        walk.zone[0], walk.kind[0], walk.passed[0] = GAP, DIFFUSE, 0
        walk.weight[0], walk.spawn[3] = weight, side
        if side < 0.0:
            connect_all(tip, walk, store, state)
        elif uniform(state) < 1.0 / _RETURNS:
            walk.weight[0] *= _RETURNS
            turn(tip, walk, state)
            in_gap(tip, walk, state)
            if walk.kind[0] == ENDED:
                continue
            walk.passed[0] = 0  # its way up starts on the specimen, which does not shade it
            if walk.kind[0] != SPECULAR:
                connect_all(tip, walk, store, state)
            follow(tip, walk, store, state)


@kernel
def trace(tip: Tip, store: Store, led: int, straight: int, walks: int, seed: int) -> Floats:
    """Trace light of power 1 from one LED.

    Args:
        tip: the fingertips.
        store: takes the rays.
        led: its cell.
        straight: straight rays to each detector near it.
        walks: scattered walks.
        seed: of all random numbers; each walk has its own.

    Returns:
        light that faces absorbed, and that left or ended otherwise, without specimen.
    """
    walk, state = new_walk(), np.zeros(1, np.uint64)
    ended = np.zeros(2)
    state[0] = np.uint64(seed * 1000003 + 7919)
    direct(tip, walk, store, led, straight, state)
    for number in range(walks):
        state[0] = np.uint64((seed + 1) * 1073741827 + number)
        state[0] = np.uint64(uniform(state) * 9007199254740992.0)
        across, along = 2.0 * uniform(state) - 1.0, 2.0 * uniform(state) - 1.0
        start(tip, walk, led, across, along, 1.0 / walks)
        walk.absorbed[:] = 0.0
        follow(tip, walk, store, state)
        ended += walk.absorbed
        if walk.spawn[2] > 0.0:
            from_specimen(tip, walk, store, state)
    return ended
