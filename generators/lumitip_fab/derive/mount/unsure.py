"""Figures of a gripper or a coupling that are to be measured before parts are printed for it."""

from collections.abc import Iterator

from lumitip_fab.catalogue.record import Confidence, Strict, Traced
from lumitip_fab.design import Unsure

_UNITS = {"mm": " mm", "deg": "°", "n": " N"}


def unsure_figures(entry: Traced) -> tuple[Unsure, ...]:
    """Lengths, angles, forces and threads without a sure source, those of inner tables too."""
    return tuple(
        figure
        for name, confidence in entry.unsure.items()
        for figure in _figures(name, getattr(entry, name), confidence)
    )


def _figures(name: str, value: object, confidence: Confidence) -> Iterator[Unsure]:
    if isinstance(value, Strict):
        for part in type(value).model_fields:
            yield from _figures(f"{name}.{part}", getattr(value, part), confidence)
    elif isinstance(value, str):
        yield Unsure(name, value, confidence)
    elif isinstance(value, float):
        unit = _UNITS.get(name.rpartition("_")[2], "")
        yield Unsure(name, f"{value:g}{unit}", confidence)
