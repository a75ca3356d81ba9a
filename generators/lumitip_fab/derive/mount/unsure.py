"""Figures of a gripper or a coupling that are to be measured before parts are printed for it."""

from collections.abc import Iterator

from lumitip_fab.catalogue.record import Confidence, Strict, Traced
from lumitip_fab.design import Unsure
from lumitip_fab.text import table_of

_UNITS = {"mm": " mm", "deg": "°", "n": " N", "a": " A"}
_NOT_PRINTED = {"force_n", "supply_a", "stroke_mm", "height_mm", "robot_mm", "iso"}
"""Figures of gripper and coupling that no printed part rests on."""
_TEXTS = "grippers/texts.toml"


def unsure_figures(entry: Traced) -> tuple[Unsure, ...]:
    """Lengths, angles, forces and threads without a sure source, those of inner tables too."""
    return tuple(
        Unsure(figure, value, confidence, _measured(figure), _others(entry, figure))
        for name, confidence in entry.unsure.items()
        for figure, value, confidence in _figures(name, getattr(entry, name), confidence)
    )


def _measured(figure: str) -> bool:
    return figure not in {*table_of(_TEXTS)["chosen"], *_NOT_PRINTED}


def _others(entry: Traced, figure: str) -> tuple[tuple[str, str], ...]:
    """Figures with which the text on how this one is measured begins."""
    first, *rest = table_of(_TEXTS)["figures"].get(figure, "").split(", ")
    known = rest and first in type(entry).model_fields
    return ((first, _shown(first, getattr(entry, first))),) if known else ()


def _figures(
    name: str, value: object, confidence: Confidence
) -> Iterator[tuple[str, str, Confidence]]:
    if isinstance(value, Strict):
        for part in type(value).model_fields:
            yield from _figures(f"{name}.{part}", getattr(value, part), confidence)
    elif isinstance(value, str | float):
        yield name, _shown(name, value), confidence


def _shown(name: str, value: str | float) -> str:
    """A value with its unit."""
    if isinstance(value, str):
        return value
    return f"{value:g}{_UNITS.get(name.rpartition('_')[2], '')}"
