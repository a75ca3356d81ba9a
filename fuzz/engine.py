"""Feeds a target with mutated inputs; counts what it refuses, and watches its memory."""

import hashlib
import random
import resource
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from fuzz.mutate import Mutation, mutated

MOST_GROWTH_MIB = 8.0
WARM_UP = 0.2  # of the inputs, in which caches may fill
_PAGE_MIB = resource.getpagesize() / 2**20


@dataclass(frozen=True)
class Target:
    """Something that reads bytes from outside."""

    name: str
    share: float
    """Of all inputs."""
    seeds: Callable[[], Sequence[bytes]]
    """Good inputs, which it must accept."""
    feed: Callable[[bytes], None]
    refuses_with: tuple[type[Exception], ...]
    """The only exceptions that a bad input may raise."""
    mutations: tuple[Mutation, ...]
    seal: Callable[[bytes], bytes] | None = None
    """Repairs a checksum, so that damage is seen behind it; done to every other input."""


@dataclass(frozen=True)
class Outcome:
    """Result of a target."""

    inputs: int
    refused: int
    seconds: float
    growth_mib: float


class FoundError(Exception):
    """An input that a target must not answer as it did."""


def run(target: Target, inputs: int, seed: int, crashes: Path) -> Outcome:
    """Feed a target.

    Args:
        target: what to feed.
        inputs: how many mutated inputs.
        seed: the same seed gives the same inputs.
        crashes: folder for an input that was answered wrongly.

    Raises:
        FoundError: if an input raised another exception, or memory grew.
    """
    rng = random.Random(f"{seed} {target.name}")
    seeds = target.seeds()
    for good in seeds:
        target.feed(good)
    began, refused, start_mib = time.perf_counter(), 0, 0.0
    warm = int(inputs * WARM_UP)
    for number in range(inputs):
        if number == warm:
            start_mib = _memory_mib()
        data = mutated(rng, seeds, target.mutations)
        if target.seal is not None and number % 2:
            data = target.seal(data)
        try:
            target.feed(data)
        except target.refuses_with:
            refused += 1
        except Exception as error:
            raise FoundError(
                f"{target.name}: {error!r} of {_kept(data, target, crashes)}"
            ) from error
    growth_mib = _memory_mib() - start_mib
    if growth_mib > MOST_GROWTH_MIB:
        raise FoundError(
            f"{target.name}: memory grew by {growth_mib:.1f} MiB over {inputs - warm} inputs, at "
            f"most {MOST_GROWTH_MIB:g} are allowed"
        )
    return Outcome(inputs, refused, time.perf_counter() - began, growth_mib)


def _kept(data: bytes, target: Target, crashes: Path) -> Path:
    crashes.mkdir(parents=True, exist_ok=True)
    file = crashes / f"{target.name}-{hashlib.sha256(data).hexdigest()[:12]}"
    file.write_bytes(data)
    return file


def _memory_mib() -> float:
    """Memory that this process holds now."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * _PAGE_MIB
