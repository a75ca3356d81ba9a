"""The Pareto front of any objectives."""

from collections.abc import Collection

Objectives = tuple[float, ...]
"""Figures of a design to minimise, in one order for all designs."""


def undominated(rated: Collection[Objectives]) -> set[Objectives]:
    """Those of which no other is as good in all and better in one."""
    return {own for own in rated if not any(_better(other, own) for other in rated)}


def _better(other: Objectives, own: Objectives) -> bool:
    return other != own and all(o <= m for o, m in zip(other, own, strict=True))
