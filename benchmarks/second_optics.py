"""Compiled optics of flat layers: random directions, Fresnel's equations, Snell's law.

Parts of a second optical model (`second_light`), which shares nothing with `lumitip.twin`.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar, cast

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Words = NDArray[np.uint64]
_F = TypeVar("_F", bound=Callable[..., Any])


def kernel(function: _F) -> _F:
    """Compile on first use, and keep the machine code for later runs."""
    return cast(_F, njit(cache=True)(function))


class Stack(NamedTuple):
    """Layers between both boards, from the emitter's silicone to the receiver's; lengths in mm.

    z is 0 at the outer face of the receiver's film and points to the emitter.
    """

    gap: float
    film: float
    board: float  # depth of a board behind the inner face of its film
    led_depth: float  # of the die behind the inner face of the film
    detector_depth: float
    led_half: float  # half the side of the square die
    detector_half: float
    apothem: float  # half of the hole's width across flats
    silicone_index: float
    film_index: float
    silicone_scatter: float  # events per mm
    silicone_forward: float  # mean cosine of an event
    film_scatter: float
    film_forward: float
    board_albedo: float
    film_albedo: float  # of the film's black inner face
    wall_albedo: float  # of the walls of the holes
    face_albedo: float  # of the film's black outer face
    emitter_x: float  # place of the emitter, relative to the receiver
    emitter_y: float
    specimen: float  # height of the specimen's middle above the receiver
    least: float  # weight of a ray below which few are stored, with this weight


@kernel
def uniform(state: Words) -> float:
    """A random number from 0 (included) to 1; `state` of one entry advances (SplitMix64)."""
    state[0] += np.uint64(0x9E3779B97F4A7C15)
    z = state[0]
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    z ^= z >> np.uint64(31)
    return float(z >> np.uint64(11)) * (1.0 / 9007199254740992.0)


@kernel
def transmitted(cos_in: float, index_in: float, index_out: float) -> float:
    """Share of unpolarised light that passes a smooth face."""
    sin_out = index_in / index_out * math.sqrt(max(1.0 - cos_in * cos_in, 0.0))
    if sin_out >= 1.0:
        return 0.0
    cos_out = math.sqrt(1.0 - sin_out * sin_out)
    across = (index_in * cos_in - index_out * cos_out) / (index_in * cos_in + index_out * cos_out)
    along = (index_out * cos_in - index_in * cos_out) / (index_out * cos_in + index_in * cos_out)
    return 1.0 - 0.5 * (across * across + along * along)


@kernel
def refracted(
    u: float, v: float, w: float, index_in: float, index_out: float
) -> tuple[float, float, float]:
    """Direction behind a face of constant z; the light must not be reflected totally."""
    ratio = index_in / index_out
    u, v = u * ratio, v * ratio
    return u, v, math.copysign(math.sqrt(max(1.0 - u * u - v * v, 0.0)), w)


@kernel
def about(x: float, y: float, z: float, cosine: float, turn: float) -> tuple[float, float, float]:
    """Unit vector at an angle of this cosine to a unit vector, `turn` (rad) around it."""
    sine = math.sqrt(max(1.0 - cosine * cosine, 0.0))
    if abs(z) < 0.9:
        length = math.sqrt(x * x + y * y)
        ax, ay, az = -y / length, x / length, 0.0
    else:
        length = math.sqrt(y * y + z * z)
        ax, ay, az = 0.0, -z / length, y / length
    bx, by, bz = y * az - z * ay, z * ax - x * az, x * ay - y * ax
    p, q = sine * math.cos(turn), sine * math.sin(turn)
    return x * cosine + ax * p + bx * q, y * cosine + ay * p + by * q, z * cosine + az * p + bz * q


@kernel
def henyey(cosine: float, forward: float) -> float:
    """Henyey–Greenstein phase function, per steradian."""
    bottom = 1.0 + forward * forward - 2.0 * forward * cosine
    return (1.0 - forward * forward) / (4.0 * math.pi * bottom * math.sqrt(bottom))


@kernel
def henyey_cosine(chance: float, forward: float) -> float:
    """Cosine of a scattering angle for a random number."""
    if abs(forward) < 1e-3:
        return 2.0 * chance - 1.0
    part = (1.0 - forward * forward) / (1.0 - forward + 2.0 * forward * chance)
    return (1.0 + forward * forward - part * part) / (2.0 * forward)


@kernel
def in_hexagon(x: float, y: float, apothem: float) -> bool:
    """Whether a point lies in a hexagon around the origin with two flats of constant y."""
    half = 0.5 * abs(y)
    return abs(y) <= apothem and 0.8660254037844386 * abs(x) + half <= apothem


@kernel
def wall_ahead(x: float, y: float, u: float, v: float, apothem: float) -> tuple[float, int]:
    """Distance along a direction to the wall of the hexagon, and the number of that wall."""
    nearest, number = 1e9, 0
    for wall in range(6):
        turn = math.pi / 6.0 + wall * math.pi / 3.0
        nx, ny = math.cos(turn), math.sin(turn)
        speed = u * nx + v * ny
        if speed > 1e-12:
            way = max((apothem - x * nx - y * ny) / speed, 0.0)
            if way < nearest:
                nearest, number = way, wall
    return nearest, number


@kernel
def connected(thick: Floats, index: Floats, low: float, away: float) -> tuple[float, float, float]:
    """The ray through flat layers that ends at a lateral distance.

    Args:
        thick: of each layer (mm); 0 for layers that it does not pass.
        index: refractive index of each.
        low: the lowest of the indices that it passes.
        away: lateral distance (mm).

    Returns:
        index times sine (equal in all layers); distance over it; derivative of distance by it.
    """
    # The distance is concave in the tangent in the layer of the lowest index, so Newton's steps
    # approach from below and never overshoot.
    tangent = away / thick.sum()
    sine = ratio = slope = 0.0
    for _ in range(30):
        long = 1.0 + tangent * tangent
        sine = low * tangent / math.sqrt(long)
        ratio = slope = 0.0
        for layer in range(thick.size):
            if thick[layer] > 0.0:
                square = index[layer] * index[layer] - sine * sine
                straight = thick[layer] / math.sqrt(square)
                ratio += straight
                slope += straight * index[layer] * index[layer] / square
        missing = away - sine * ratio
        if abs(missing) < 1e-7:
            break
        tangent += missing * long * math.sqrt(long) / (slope * low)
    return sine, ratio, slope
