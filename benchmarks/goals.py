"""Measured figures beside their goals, and the exit code: 0 if all goals were met.

goals = Goals()
goals.at_most("slowest shape", 76.0, 100.0, "µs a frame")
sys.exit(goals.exit_code())
"""

from dataclasses import dataclass, field

MISSED = 1


@dataclass
class Goals:
    """Figures held against their goals."""

    _rows: list[tuple[str, str, bool]] = field(default_factory=list)

    def at_most(self, name: str, figure: float, most: float, unit: str = "") -> None:
        """Hold a figure against a goal that it must not exceed; NaN misses it."""
        self._hold(name, figure, most, unit, "at most", figure <= most)

    def at_least(self, name: str, figure: float, least: float, unit: str = "") -> None:
        """Hold a figure against a goal that it must reach; NaN misses it."""
        self._hold(name, figure, least, unit, "at least", figure >= least)

    def not_measured(self, name: str, why: str) -> None:
        """Say that a goal could not be tried, which does not meet it."""
        self._rows.append((name, why, False))

    def exit_code(self) -> int:
        """Print every goal; the exit code: 0 if all were met."""
        print()
        for name, against, met in self._rows:
            print(f"{'met' if met else 'MISSED':<8}{name}: {against}", flush=True)
        return 0 if all(met for *_, met in self._rows) else MISSED

    def _hold(self, name: str, figure: float, limit: float, unit: str, how: str, met: bool) -> None:
        against = f"{figure:,.4g} {unit}".strip() if figure < 1e4 else f"{figure:,.0f} {unit}"
        self._rows.append((name, f"{against} (goal: {how} {limit:,g})", met))
