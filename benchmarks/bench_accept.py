"""Acceptance of built fingers: faults that are caught and named, and false alarms.

Half of the fingers have one injected fault; all have the spread of `tolerances.toml`, and the gauge
lies 0.1 mm beside its place. A calliper measures the silicone within 0.05 mm. A finger is out of
tolerance if a true deviation is beyond the limits of `lumitip.acceptance.findings`, injected or
not. It is named rightly if all of its faults are found, at their cells, and the first finding is
one of them. A fault that the finger's own spread brings back within the limit lies next to it: such
fingers stand in a line of their own. The scattered share is compared with the mean of eight good
fingers: the measured share with their measured one, the true share with their true one. `--alone`
judges without such references, as of the first pair that anyone builds.

These fingers are drawn with the rays that the verdict is built on. `--second N` tries good fingers
of the second optical model instead (`second_light`), which shares nothing with them; three of them
that were accepted are the references of the others.

Run by `make bench`; exits 1 if a goal is missed.
"""

import argparse
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import count, islice
from pathlib import Path

import numpy as np

from accept_faults import NAMED, NAMES, drawn, out_of_tolerance, true_deviations
from accept_fingers import Fault, Workshop
from accept_second import second_frames
from common import Goals
from lumitip.acceptance.findings import Finding
from lumitip.acceptance.gauge import Gauge
from lumitip.acceptance.response import CALLIPER_MM
from lumitip.acceptance.verdict import Judge, Verdict
from lumitip.tasks.bench import workers
from lumitip_fab.config.load import load
from lumitip_fab.derive import resolve
from lumitip_fab.derive.making.tolerances import spreads
from lumitip_fab.parts.gauge_card import gauge_text

CAUGHT, FALSE = 95.0, 2.0
GOOD = 8
"""Good fingers, whose mean scattered share is the reference."""
PUBLISHED = Path(__file__).parents[1] / "design" / "presets" / "published.toml"
GOOD_SECOND = 3
"""The same of the second optical model: these are those that were accepted without a reference."""
_REFERENCE_SEED = 10_000


class Trials:
    """Fingers of the published sensor, and their judge.

    Args:
        alone: whether they are judged without a reference.
        second: whether the fingers are those of the second optical model.
    """

    def __init__(self, alone: bool, second: bool) -> None:
        resolved = resolve(load(PUBLISHED))
        config, self.layout = resolved.config, resolved.design.layout
        [card] = resolved.design.gauge_cards
        self.gauge = Gauge.from_json(gauge_text(card, self.layout.design_hash))
        self._workshop = Workshop(
            self.layout, self.gauge, config.catalogue.tolerances, spreads(config)
        )
        self.judge = Judge(self.layout, self.gauge)
        self._good_scatter = 0.0
        self._reference: dict[str, float] | None = None
        if not alone:
            each = list(islice(self._accepted_second(), GOOD_SECOND)) if second else self._good()
            self._reference = {name: float(np.mean([of[name] for of in each])) for name in each[0]}

    def _good(self) -> list[dict[str, float]]:
        """Measured deviations of good fingers."""
        good = self._workshop.draws(GOOD, _REFERENCE_SEED)
        self._good_scatter = float(good["scatter"].mean())
        return [
            self.judge(self._workshop.frames(good, number, Fault(), 0)).deviations
            for number in range(GOOD)
        ]

    def _accepted_second(self) -> Iterator[dict[str, float]]:
        for seed in count(_REFERENCE_SEED):
            verdict = self.judge(second_frames(self.layout, self.gauge, seed))
            if verdict.accepted:
                yield verdict.deviations

    def __call__(self, seed: int, number: int) -> "Tried":
        """A finger with or without a fault."""
        chance = np.random.default_rng((seed, number))
        fault, own = drawn(self.layout, chance), int(chance.integers(2**32))
        draws = self._workshop.draws(1, own)
        frames = self._workshop.frames(draws, 0, fault, own)
        true = true_deviations(draws, 0, fault)
        measured = true["silicone"][::-1] + CALLIPER_MM * chance.standard_normal(2)
        verdict = self.judge(frames, self._reference, (float(measured[0]), float(measured[1])))
        return Tried.of(out_of_tolerance(true, fault, self._good_scatter), fault, verdict)

    def second(self, seed: int, number: int) -> "Tried":
        """A good finger of the second optical model."""
        verdict = self.judge(second_frames(self.layout, self.gauge, seed + number), self._reference)
        return Tried.of(set(), Fault(), verdict)


@dataclass(frozen=True)
class Tried:
    """A finger and its verdict."""

    out: tuple[str, ...]
    """Names of the faults that it has."""
    alarms: tuple[str, ...]
    """Findings, the first one first."""
    fault: str
    """Kind of the injected fault; `"none"` without one."""
    right: bool
    """Whether every fault is named, at its cells, and the first finding is one of them."""

    @classmethod
    def of(cls, out: set[str], fault: Fault, verdict: Verdict) -> "Tried":
        """Compare the findings with the faults."""

        def names(finding: Finding, kind: str) -> bool:
            fits = finding.kind in NAMED.get(kind, {kind})
            return fits and set(finding.cells) <= set(fault.cells)

        found = verdict.findings
        every = all(any(names(finding, kind) for finding in found) for kind in out)
        first = bool(found) and any(names(found[0], kind) for kind in out)
        alarms = [f.kind for f in found] + (["unseen"] if verdict.unseen else [])
        return cls(tuple(sorted(out)), tuple(alarms), fault.kind, every and first)


trials = lru_cache(maxsize=1)(Trials)
"""Those of a process."""


def tried(alone: bool, seed: int, number: int) -> Tried:
    """A finger with or without a fault."""
    return trials(alone, False)(seed, number)


def tried_second(alone: bool, seed: int, number: int) -> Tried:
    """A good finger of the second optical model."""
    return trials(alone, True).second(seed, number)


def table(found: list[Tried], goals: Goals) -> None:
    """Print the rates, by what is out of tolerance."""
    fingers, caught, right = Counter[str](), Counter[str](), Counter[str]()
    for one in found:
        if one.out:
            name = one.out[0] if len(one.out) == 1 else "several"
            fingers[name] += 1
            caught[name] += bool(one.alarms)
            right[name] += one.right
    print(f"  {'out of tolerance':<18}{'fingers':>9}{'caught':>9}{'named rightly':>15}")
    for name in (*NAMES, "several"):
        if fingers[name]:
            print(f"  {name:<18}{fingers[name]:>9}{caught[name]:>9}{right[name]:>15}")
    good = [one for one in found if not one.out and one.fault == "none"]
    near = [one for one in found if not one.out and one.fault != "none"]
    alarms = Counter(one.alarms[0] for one in good if one.alarms)
    print(f"  {'none':<18}{len(good):>9}; false alarms: {dict(alarms) or 'none'}")
    kinds = Counter(f"{one.fault}: {one.alarms[0]}" for one in near if one.alarms)
    print(f"  {'within the limit':<18}{len(near):>9}; fault and alarm: {dict(kinds) or 'none'}")
    within = 100.0 * sum((alarms + kinds).values()) / max(len(good) + len(near), 1)
    print(f"  alarms of all fingers within their limits: {within:.1f} %")
    if fingers:
        share = 100.0 * sum(right.values()) / sum(fingers.values())
        goals.at_least("out of tolerance, caught and named rightly", share, CAUGHT, "%")
    goals.at_most("false alarms", 100.0 * sum(alarms.values()) / max(len(good), 1), FALSE, "%")


def main() -> int:
    """Print the tables; the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=1000, help="fingers")
    parser.add_argument("--second", type=int, default=0, help="fingers of the second model instead")
    parser.add_argument("--alone", action="store_true", help="without good fingers to compare with")
    parser.add_argument("--seed", type=int, default=17)
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    options = parser.parse_args()
    goals = Goals()
    with workers(options.jobs) as pool:
        found = _all(pool, options)
    table(found, goals)
    return goals.exit_code()


def _all(pool: Executor, options: argparse.Namespace) -> list[Tried]:
    number, one = (options.second, tried_second) if options.second else (options.count, tried)
    chunk = max(1, min(20, number // (2 * options.jobs)))
    return list(pool.map(partial(one, options.alone, options.seed), range(number), chunksize=chunk))


if __name__ == "__main__":
    sys.exit(main())
