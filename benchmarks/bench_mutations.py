"""How many damages of built artefacts `lumitip-fab check` sees.

python benchmarks/bench_mutations.py --count 200 --seed 2 --only "mask/*" --jobs 2 --out score.json
python benchmarks/bench_mutations.py --again mask/emitter_mask.svg mirror 1234

Each mutant is one file damaged at a random place (`mutations`), with its hash in the manifest made
right, as a faulty generator would write it. Without `--outputs` the default design is built first.
Run by `make bench`; exits 1 if the goal is missed.
"""

import argparse
import json
import logging
import multiprocessing
import shutil
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from pathlib import Path

from common import Goals
from lumitip_fab.cli.build import build
from mutations.sample import drawn, files_of, made
from mutations.trial import Trial, tried

LEAST_CAUGHT = 0.97
DESIGN = Path(__file__).parents[1] / "design" / "fingertip.toml"
_scratch = Path()
"""The copy that this process damages."""


def main() -> int:
    """Damage, check, and print the score; the exit code."""
    options = _options()
    with _outputs(options.outputs) as out:
        if options.again:
            path, kind, seed = options.again
            _print_one(_again(out, path, kind, int(seed)))
            return 0
        trials = run(out, options.count, options.seed, options.only, options.jobs)
    print_score(trials)
    if options.out:
        options.out.write_text(json.dumps([t.record() for t in trials], indent=1), "utf-8")
    return judged(trials)


def judged(trials: list[Trial]) -> int:
    """Print the goals; the exit code, 0 if all are met."""
    goals = Goals()
    goals.at_least("damages caught", share(trials), LEAST_CAUGHT)
    goals.at_most("checks that stopped with an exception", sum(bool(t.crash) for t in trials), 0)
    return goals.exit_code()


def share(trials: list[Trial]) -> float:
    """Of mutants that were caught."""
    return sum(t.caught for t in trials) / len(trials)


def run(out: Path, count: int, seed: int, only: str, jobs: int) -> list[Trial]:
    """Try so many mutants of a folder, each process in a copy of its own."""
    # New processes, so that none has the locks of another one's threads.
    context = multiprocessing.get_context("spawn")
    paths = files_of(out, only)
    if not paths:
        sys.exit(f"no file of the outputs matches {only!r}")
    tasks = [(paths, seed, number) for number in range(count)]
    with (
        tempfile.TemporaryDirectory(prefix="mutations-") as folder,
        ProcessPoolExecutor(jobs, context, _copy, (out, Path(folder))) as pool,
    ):
        return list(pool.map(_try, tasks))


def _copy(out: Path, folder: Path) -> None:
    global _scratch  # noqa: PLW0603 (a process of the pool has one)
    # Damaged files make readers of PDF, fonts and meshes complain.
    logging.disable(logging.CRITICAL)
    _scratch = folder / multiprocessing.current_process().name
    shutil.copytree(out, _scratch)


def _try(task: tuple[list[str], int, int]) -> Trial:
    trial = tried(_scratch, drawn(_scratch, *task))
    if not trial.caught:
        _print_one(trial)
    return trial


def _again(out: Path, path: str, kind: str, seed: int) -> Trial:
    with tempfile.TemporaryDirectory(prefix="mutations-") as folder:
        copy = Path(shutil.copytree(out, Path(folder) / "out"))
        return tried(copy, made(copy, path, kind, seed))


def _print_one(trial: Trial) -> None:
    found = trial.crash and f"CRASH {trial.crash}"
    found = found or (f"caught by {', '.join(trial.failed)}" if trial.failed else "MISSED")
    print(f"{trial.path} {trial.kind!r} {trial.seed}: {trial.description}\n  {found}", flush=True)


def print_score(trials: list[Trial]) -> None:
    """A line for each artefact, the worst first."""
    of: dict[str, list[Trial]] = defaultdict(list)
    for trial in trials:
        of[trial.artefact].append(trial)
    print(f"\n{'artefact':<24}{'caught':>8}{'tried':>8}{'share':>8}")
    for name, some in sorted(of.items(), key=lambda item: (share(item[1]), item[0])):
        print(f"{name:<24}{sum(t.caught for t in some):>8}{len(some):>8}{share(some):>8.0%}")
    caught = sum(t.caught for t in trials)
    print(f"{'all':<24}{caught:>8}{len(trials):>8}{share(trials):>8.1%}", flush=True)


@contextmanager
def _outputs(folder: Path | None) -> Iterator[Path]:
    """The output folder to damage copies of; the default design is built if none is named."""
    if folder:
        yield folder
        return
    with tempfile.TemporaryDirectory(prefix="mutations-") as new:
        build(DESIGN, Path(new))
        yield Path(new)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=2000, help="mutants")
    parser.add_argument("--seed", type=int, default=1, help="another seed draws other mutants")
    parser.add_argument("--only", default="*", help="pattern of the files to damage")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--outputs", type=Path, help="folder of outputs whose checks all pass")
    parser.add_argument("--out", type=Path, help="file for all results, as JSON")
    parser.add_argument(
        "--again", nargs=3, metavar=("PATH", "KIND", "SEED"), help="make one mutant again"
    )
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
