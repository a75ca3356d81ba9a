"""Damaged copies of good inputs, as lines, disks and people damage them."""

import random
from collections.abc import Callable, Sequence

Random = random.Random
Mutation = Callable[[Random, bytearray], None]

_NASTY_BYTES = (0x00, 0x01, 0x7F, 0x80, 0xFE, 0xFF)
_NASTY_WORDS = (
    b"null",
    b"true",
    b"-1",
    b"0",
    b"1e999",
    b"-0.0",
    b"NaN",
    b"Infinity",
    b'""',
    b"[]",
    b"{}",
    b"2147483648",
    b"1" * 400,
    b"[[[[",
    b"]]",
    b"\\ud800",
    b"\xff\xfe",
    b"1.5",
    b'"A0"',
    b",",
    b":",
)


def flip(rng: Random, data: bytearray) -> None:
    """One bit the other way round."""
    at = rng.randrange(len(data))
    data[at] ^= 1 << rng.randrange(8)


def put(rng: Random, data: bytearray) -> None:
    """One byte at an edge of its range, or any."""
    data[rng.randrange(len(data))] = rng.choice((*_NASTY_BYTES, rng.randrange(256)))


def cut(rng: Random, data: bytearray) -> None:
    """The end missing."""
    del data[rng.randrange(len(data)) :]


def drop(rng: Random, data: bytearray) -> None:
    """A piece missing."""
    at = rng.randrange(len(data))
    del data[at : at + rng.randint(1, 16)]


def double(rng: Random, data: bytearray) -> None:
    """A piece twice."""
    at = rng.randrange(len(data))
    data[at:at] = data[at : at + rng.randint(1, 32)]


def insert(rng: Random, data: bytearray) -> None:
    """Bytes from elsewhere."""
    at = rng.randrange(len(data) + 1)
    data[at:at] = rng.randbytes(rng.randint(1, 8))


def word(rng: Random, data: bytearray) -> None:
    """A word that readers of text stumble over, in the place of a number or between two."""
    at = rng.randrange(len(data) + 1)
    end = at
    if rng.random() < 0.7:
        while at > 0 and chr(data[at - 1]) in "0123456789.-":
            at -= 1
        while end < len(data) and chr(data[end]) in "0123456789.-":
            end += 1
    data[at:end] = rng.choice(_NASTY_WORDS)


BINARY: tuple[Mutation, ...] = (flip, put, cut, drop, double, insert)
TEXT: tuple[Mutation, ...] = (flip, put, cut, drop, double, insert, word, word, word, word)


def mutated(rng: Random, seeds: Sequence[bytes], mutations: Sequence[Mutation]) -> bytes:
    """A seed damaged in one to four ways; rarely two seeds spliced, or noise alone."""
    chance = rng.random()
    if chance < 0.02:
        return rng.randbytes(rng.randrange(64))
    data = bytearray(rng.choice(seeds))
    if chance < 0.07:
        other = rng.choice(seeds)
        data[rng.randrange(len(data) + 1) :] = other[rng.randrange(len(other) + 1) :]
    for _ in range(rng.choice((1, 1, 1, 2, 2, 3, 4))):
        if data:
            rng.choice(mutations)(rng, data)
    return bytes(data)
