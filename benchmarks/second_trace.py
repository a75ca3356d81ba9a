"""Compiled path tracer of the second optical model: walks of light from the LEDs.

A walk starts at an LED and is refracted, reflected, scattered and absorbed (`second_events`). From
each vertex where it is scattered all detectors are connected (`second_connect`).
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
    SILICONE_E,
    SILICONE_R,
    SPECULAR,
    Store,
    Tip,
    Walk,
    connect,
)
from second_events import in_film, in_gap, in_silicone, turn
from second_optics import Floats, Words, kernel, uniform

_NEAR_MM, _SKIP = 7.5, 8  # pairs further apart have one of so many direct rays
_LEAST = 0.02  # share of its first weight below which a walk survives by chance
_PARTS = 12  # of a walk that reaches the receiver's film
_RETURNS = 4  # one of so many walks is followed from the specimen back to the emitter
_EVENTS = 200  # after which a walk ends
_STEPS = (0.8566748838545029, 0.733891856627126, 0.6287067210378087, 0.5385972572236101)


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
