"""Which terms does the twin lack? Misfit on the three published frames, each left out in turn.

Each term is a number (or several) of the sensor, so it is fitted on two frames and judged on the
third, where only pose, transmittance, gap and light are fitted. A term is kept if it lowers the
misfit of every frame left out, with plain objects and with hem and bend. A random assignment of the
same gains to other cells shows whether their success is by chance.

Run by `make bench`; exits 1 if the kept term, the gains of the cells, does not lower all three.
"""

import sys
from dataclasses import dataclass

import numpy as np

from common import Goals, on_one_core
from lumitip.links.twin import published_layout
from real_fit import NAMES, RealFit, Shared
from real_light import RealLight
from real_terms import MADE, PLAIN, TERMS, Numbers, RealTwin

GAIN_SDS = (0.02, 0.04, 0.06, 0.10)
"""Deviations of the prior of the gains that are tried."""
KEPT_SD = 0.04
"""Deviation of the prior of the gains that the twin has as `PUBLISHED_GAINS`."""
CLEAR_COUNTS = 0.1
"""Smaller changes of the misfit are within the fits' own scatter."""
SHUFFLES = 100


@dataclass(frozen=True)
class Row:
    """A candidate on all frames."""

    name: str
    shared: int
    """Number of shared numbers; gains of the cells are limited by their prior."""
    within: dict[str, float]
    """Misfit of the fit of all three frames (counts)."""
    held_out: dict[str, float]
    """Misfit of each frame left out (counts)."""

    def lowers_all(self, before: "Row") -> bool:
        """Whether the misfit of every frame left out is clearly lower."""
        return all(self.held_out[n] <= before.held_out[n] - CLEAR_COUNTS for n in NAMES)

    def line(self, before: "Row") -> str:
        """The row as text, compared with the row before the term was added."""
        both = "  ".join(
            " ".join(f"{of[name]:6.1f}" for name in NAMES) for of in (self.within, self.held_out)
        )
        verdict = "" if self is before else "all three" if self.lowers_all(before) else "-"
        return f"  {self.name:<50}{self.shared:>4}  {both}   {verdict}"


class Table:
    """Rows of one kind of objects."""

    def __init__(self, fit: RealFit, starts: dict[str, Numbers]) -> None:
        self._fit = fit
        alone = {name: fit.alone(name, starts[name], fit.nothing) for name in NAMES}
        self.own = {name: alone[name].own[name] for name in NAMES}
        misfits = {name: alone[name].rms[name] for name in NAMES}
        self.base = Row("twin as it is", 0, misfits, misfits)

    def row(self, name: str, term: Numbers, gain_sd: float = 0.0) -> Row:
        """A term, with gains of the cells if `gain_sd` is above 0."""
        cells = len(self._fit.nothing.gains) if gain_sd else 0
        within = self._fit.together(self.own, Shared(term, self._fit.nothing.gains), gain_sd).rms
        held_out = self._fit.held_out(self.own, term, gain_sd)
        return Row(name, len(term) + cells, within, {n: held_out[n][0] for n in NAMES})

    def by_chance(self) -> tuple[int, dict[str, float], dict[str, float]]:
        """Shuffles that lower all three frames; misfits with the gains, and with shuffled ones."""
        found = self._fit.held_out(self.own, {}, KEPT_SD)
        chance, lower = np.random.default_rng(1), np.ones(SHUFFLES, bool)
        right, wrong = {}, {}
        for name in NAMES:
            gains = found[name][1].gains
            misfits = np.array(
                [self._with(name, chance.permutation(gains)) for _ in range(SHUFFLES)]
            )
            right[name], wrong[name] = self._with(name, gains), float(misfits.mean())
            lower &= misfits <= self.base.held_out[name] - CLEAR_COUNTS
        return int(lower.sum()), right, wrong

    def _with(self, name: str, gains: np.ndarray) -> float:
        return self._fit.started(name, self.own[name], Shared({}, gains))


def printed(fit: RealFit, title: str, starts: dict[str, Numbers], goals: Goals) -> Table:
    """Print the table of one kind of objects."""
    table = Table(fit, starts)
    base, kept = table.base, table.row(f"gains of the cells, 1 ± {KEPT_SD:g}", {}, KEPT_SD)
    print(f"{title}: shared numbers; misfit of edge, corner, cable within the fit, and left out")
    print(base.line(base))
    for name, term in TERMS.items():
        print(table.row(name, term).line(base), flush=True)
    for sd in GAIN_SDS:
        row = kept if sd == KEPT_SD else table.row(f"gains of the cells, 1 ± {sd:g}", {}, sd)
        print(row.line(base), flush=True)
    print("  with gains, compared with gains alone:")
    for name, term in TERMS.items():
        print(table.row(f"gains, {name}", term, KEPT_SD).line(kept), flush=True)
    for name in NAMES:
        least = base.held_out[name] - kept.held_out[name]
        goals.at_least(f"{title}, gains on {name} left out", least, CLEAR_COUNTS, "counts lower")
    many, right, wrong = table.by_chance()
    for name in NAMES:
        print(f"  {name}: {right[name]:.1f} with its gains, {wrong[name]:.1f} shuffled (mean)")
    print(f"  {many} of {SHUFFLES} shuffles of the gains lower all three")
    return table


def main() -> int:
    """Both tables; the exit code."""
    fit, goals = RealFit(RealTwin(published_layout(), RealLight(published_layout()))), Goals()
    printed(fit, "plain objects", PLAIN, goals)
    made = {name: PLAIN[name] | MADE.get(name, {}) for name in NAMES}
    table = printed(fit, "hem and bend", made, goals)
    gains = fit.together(table.own, fit.nothing, KEPT_SD).shared.gains
    print("gains of all three frames:", ", ".join(f"{gain:.2f}" for gain in gains))
    return goals.exit_code()


if __name__ == "__main__":
    on_one_core()
    sys.exit(main())
