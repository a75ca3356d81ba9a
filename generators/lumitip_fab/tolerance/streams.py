"""Independent streams of random numbers of a study, all from one seed."""

from enum import IntEnum

import numpy as np


class Stream(IntEnum):
    """Uses of random numbers; no two share a stream."""

    DEVIATIONS = 1
    POSES = 2
    NOISE = 3
    BOOTSTRAP = 4
    DIRECTIONS = 5


def generator(seed: int, stream: Stream, *numbers: int) -> np.random.Generator:
    """The generator of a stream.

    Args:
        seed: of the study.
        stream: use of the numbers.
        numbers: which part of it, such as the deviation.
    """
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(stream, *numbers)))
