"""Judged designs of a search, and the front of them."""

from collections.abc import Iterable
from dataclasses import dataclass

from lumitip_fab.explore.front import undominated
from lumitip_fab.explore.run import Found
from lumitip_fab.solve.judge import OBJECTIVES

Point = tuple[int, ...]
"""Number of the value on each axis."""


@dataclass(frozen=True)
class Judged(Found):
    """One design of a search."""

    excess: float
    """Sum of the shares by which it is beyond limits."""

    @property
    def allowed(self) -> bool:
        """Whether it keeps all limits."""
        return bool(self.figures) and self.excess <= 0.0

    @property
    def objectives(self) -> tuple[float, ...]:
        """Figures to minimise."""
        return tuple(self.figures[name] for name in OBJECTIVES)


def front(designs: Iterable[Judged]) -> tuple[Judged, ...]:
    """Allowed designs of which no other is as good in all objectives and better in one, the least
    error first; of equal designs the first."""
    allowed = {one.objectives: one for one in reversed(list(designs)) if one.allowed}
    return tuple(allowed[own] for own in sorted(undominated(allowed)))
