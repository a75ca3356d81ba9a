"""Sobol indices of groups of numbers: which deviation makes fingers differ."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.stats import sobol_indices

from lumitip.grid import Floats, Integers
from lumitip_fab.tolerance.streams import Stream, generator

_RESAMPLED = 200


@dataclass(frozen=True, eq=False)
class Indices:
    """Indices of each factor for each figure, shape `(figures, factors)`."""

    first: Floats
    """Share of the variance that a factor causes alone."""
    total: Floats
    """The same with others: what remains of it when all others are known."""
    first_sd: Floats
    """Standard deviation of `first`, by bootstrap."""
    total_sd: Floats


def mixed(a: Mapping[str, Floats], b: Mapping[str, Floats], factor: str) -> dict[str, Floats]:
    """The draws `a` with one factor, all of its numbers, from `b`."""
    return {**a, factor: b[factor]}


def indices(of_a: Floats, of_b: Floats, of_mixed: Floats, seed: int = 0) -> Indices:
    """First and total indices by Saltelli's method, with their errors.

    Args:
        of_a, of_b: figures of two independent sets of draws, shape `(figures, n)`; n is a power
            of 2.
        of_mixed: figures of `mixed(a, b, factor)`, shape `(factors, figures, n)`.
        seed: of the bootstrap.
    """
    chance, count = generator(seed, Stream.BOOTSTRAP), of_a.shape[1]

    def found(at: Integers | slice) -> Floats:
        values = {"f_A": of_a[:, at], "f_B": of_b[:, at], "f_AB": of_mixed[:, :, at]}
        result = sobol_indices(func=values, n=count)
        return np.reshape([result.first_order, result.total_order], (2, len(of_a), -1))

    first, total = found(slice(None))
    spread = np.std(
        [found(draws) for draws in chance.integers(count, size=(_RESAMPLED, count))], axis=0
    )
    return Indices(first, total, *spread)
