"""Share of random designs within `docs/ranges.md` that are accepted at first try.

python benchmarks/bench_acceptance.py --count 500 --seed 2 --build 60 --jobs 2

Every refusal is confirmed by a calculation that shares no code with the rule that refused; every
crash is a failure. Some of the accepted designs are built, and all their checks run. Designs that
fail are kept in `--keep` as user files; in `tests/acceptance/cases` they become tests.
"""

import argparse
import multiprocessing
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from random import Random

from acceptance.confirm import Verdict, confirm
from acceptance.generator import Design, design
from acceptance.parts import BASE, DEFAULT
from acceptance.trial import Trial, build_file, derive_file, design_folder
from common import Goals

LEAST_ACCEPTED = 0.97
Result = tuple[Design, Trial]


def main() -> int:
    """Derive all designs, build some; the exit code."""
    options = _options()
    # New processes, so that none has the locks of another one's threads.
    context = multiprocessing.get_context("spawn")
    with design_folder() as folder, ProcessPoolExecutor(options.jobs, mp_context=context) as pool:
        designs = [design(options.seed, i, options.base) for i in range(options.count)]
        files = [_write(folder, drawn) for drawn in designs]
        derived = list(zip(designs, pool.map(derive_file, files, chunksize=8), strict=True))
        _print_kinds(derived)
        refused = [(d, t) for d, t in derived if t.refusals]
        searched = (i < options.search for i in range(len(refused)))
        verdicts = list(pool.map(confirm, *zip(*refused, strict=True), searched)) if refused else []
        _print_refused(refused, verdicts)
        chosen = choose(derived, options.build, options.seed)
        built = []
        for drawn, trial in zip(
            chosen, pool.map(build_file, [folder / f"{d.name}.toml" for d in chosen]), strict=True
        ):
            print(f"built {drawn.name} ({', '.join(drawn.kinds)}): {_told(trial)}", flush=True)
            built.append((drawn, trial))
    _print_crashed([*derived, *built])
    keep(options.keep, derived, built)
    return judged([t for _, t in derived], verdicts, [t for _, t in built])


def judged(derived: list[Trial], verdicts: list[Verdict], built: list[Trial]) -> int:
    """Print the goals; the exit code, 0 if all are met."""
    goals = Goals()
    share = sum(t.accepted for t in derived) / len(derived)
    goals.at_least("designs accepted", share, LEAST_ACCEPTED)
    goals.at_most("refusals not confirmed", sum(not v.confirmed for v in verdicts), 0)
    goals.at_most("crashes", sum(bool(t.crash) for t in (*derived, *built)), 0)
    goals.at_most("built designs with a failed check", sum(bool(t.failed) for t in built), 0)
    return goals.exit_code()


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=500, help="designs to derive")
    parser.add_argument("--seed", type=int, default=1, help="another seed draws other designs")
    parser.add_argument(
        "--base", choices=(BASE, DEFAULT), default=BASE, help="preset that most of them extend"
    )
    parser.add_argument("--build", type=int, default=60, help="accepted designs to build")
    parser.add_argument(
        "--search",
        type=int,
        default=4,
        help="refusals without a physical reason to look for a way out of",
    )
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--keep", type=Path, help="folder for the files of designs that fail")
    return parser.parse_args()


def _write(folder: Path, drawn: Design) -> Path:
    file = folder / f"{drawn.name}.toml"
    file.write_text(drawn.text, encoding="utf-8")
    return file


def choose(derived: list[Result], count: int, seed: int) -> list[Design]:
    """Some of the accepted designs to build, of as many kinds of edit as there are."""
    left = [d for d, t in derived if t.accepted]
    Random(seed).shuffle(left)
    seen: Counter[str] = Counter()
    chosen: list[Design] = []
    while left and len(chosen) < count:
        rarest = min(left, key=lambda d: min(seen[kind] for kind in d.kinds))
        left.remove(rarest)
        seen.update(rarest.kinds)
        chosen.append(rarest)
    return chosen


def _print_kinds(derived: list[Result]) -> None:
    drawn = Counter(kind for d, _ in derived for kind in d.kinds)
    accepted = Counter(kind for d, t in derived if t.accepted for kind in d.kinds)
    print(f"{'kind of edit':<14}{'designs':>9}{'accepted':>10}{'share':>8}")
    for kind, count in sorted(drawn.items(), key=lambda item: accepted[item[0]] / item[1]):
        print(f"{kind:<14}{count:>9}{accepted[kind]:>10}{accepted[kind] / count:>8.0%}")
    total = sum(t.accepted for _, t in derived)
    print(f"{'all':<14}{len(derived):>9}{total:>10}{total / len(derived):>8.1%}", flush=True)


def _print_refused(refused: list[Result], verdicts: list[Verdict]) -> None:
    for (drawn, trial), verdict in zip(refused, verdicts, strict=True):
        print(f"\nrefused {drawn.name} ({', '.join(drawn.kinds)}): {verdict.text}")
        for refusal in trial.refusals:
            print(f"  {refusal.field}: {refusal.message}", flush=True)


def _told(trial: Trial) -> str:
    if trial.crash:
        return "crashed"
    return "\n  ".join(["failed", *trial.failed]) if trial.failed else "passes every check"


def _print_crashed(results: list[Result]) -> None:
    for drawn, trial in results:
        if trial.crash:
            print(f"\ncrashed {drawn.name} ({', '.join(drawn.kinds)})\n{trial.crash}")


def keep(folder: Path | None, derived: list[Result], built: list[Result]) -> None:
    """Write the files of the designs that fail into a folder, if one is named."""
    failed = [d for d, t in derived if not t.accepted]
    failed += [d for d, t in built if t.failed or t.crash]
    if folder and failed:
        folder.mkdir(parents=True, exist_ok=True)
        for drawn in failed:
            _write(folder, drawn)
        print(f"\n{len(failed)} designs that fail are in {folder}")


if __name__ == "__main__":
    sys.exit(main())
