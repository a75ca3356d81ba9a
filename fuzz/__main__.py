"""`python -m fuzz`: a million mutated inputs, and no exception but the typed ones."""

import argparse
import sys
from pathlib import Path

from fuzz.engine import FoundError, run
from fuzz.targets import TARGETS


def main() -> int:
    """Feed every target its share; 1 if one was answered wrongly."""
    parser = argparse.ArgumentParser(prog="python -m fuzz", description=__doc__)
    parser.add_argument("--inputs", type=int, default=1_000_000, help="of all targets together")
    parser.add_argument("--seed", type=int, default=1, help="the same seed gives the same inputs")
    parser.add_argument("--crashes", type=Path, default=Path("fuzz/crashes"))
    options = parser.parse_args()
    whole = sum(target.share for target in TARGETS)
    total = 0
    for target in TARGETS:
        inputs = round(options.inputs * target.share / whole)
        try:
            outcome = run(target, inputs, options.seed, options.crashes)
        except FoundError as found:
            print(found, file=sys.stderr)
            return 1
        total += outcome.inputs
        print(
            f"{target.name:10} {outcome.inputs:8} inputs  {outcome.refused:8} refused  "
            f"{outcome.seconds:6.1f} s  memory {outcome.growth_mib:+.1f} MiB",
            flush=True,
        )
    print(f"{total} inputs, no exception but the typed ones")
    return 0


if __name__ == "__main__":
    sys.exit(main())
