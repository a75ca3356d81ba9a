"""Speed of the Gymnasium environments, with resets: one at a time, and many at once on one core.

Run by `make bench`. Actions are drawn at random around going forward, so that episodes end.
"""

import sys
import time
from collections.abc import Callable
from typing import Any

import gymnasium
import numpy as np

from common import Goals, on_one_core

GOAL_STEPS = 50_000.0
NUMBER = 512
KINDS = ("Cable", "Cloth", "Corner")


def rate(step: Callable[[Any], Any], shape: tuple[int, ...], seconds: float = 4.0) -> float:
    """Steps of single environments in a second of processor time."""
    chance = np.random.default_rng(1)
    actions = [
        chance.normal((0.4, 0.0, 0.0), (0.1, 0.1, 0.1), shape).astype(np.float32) for _ in range(64)
    ]
    step(actions[0])
    begun, calls = time.process_time(), 0
    while time.process_time() < begun + seconds:
        step(actions[calls % 64])
        calls += 1
    return calls * (shape[0] if len(shape) == 2 else 1) / (time.process_time() - begun)


def single(kind: str) -> float:
    """Steps a second of one environment."""
    env = gymnasium.make(f"lumitip.tasks.environment:Lumitip/Trace{kind}-v0").unwrapped
    env.reset(seed=1)

    def step(action: Any) -> None:
        _, _, terminated, truncated, _ = env.step(action)
        if terminated or truncated:
            env.reset()

    return rate(step, (3,))


def many(kind: str) -> float:
    """Steps a second of all of `NUMBER` environments together."""
    envs = gymnasium.make_vec(
        f"lumitip.tasks.environment:Lumitip/Trace{kind}-v0",
        NUMBER,
        vectorization_mode="vector_entry_point",
    )
    envs.reset(seed=1)
    return rate(envs.step, (NUMBER, 3))


def main() -> int:
    """Print everything; the exit code."""
    rates = {}
    print(f"{'steps/s on one core':<24}{'one':>12}{f'{NUMBER} at once':>16}")
    for kind in KINDS:
        rates[kind] = many(kind)
        print(f"{kind:<24}{single(kind):>12,.0f}{rates[kind]:>16,.0f}")
    goals = Goals()
    goals.at_least(f"slowest of {NUMBER} at once", min(rates.values()), GOAL_STEPS, "steps/s")
    return goals.exit_code()


if __name__ == "__main__":
    on_one_core()
    sys.exit(main())
