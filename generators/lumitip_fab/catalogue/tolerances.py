"""Catalogue entries of tolerances: how far a built fingertip is from its drawing."""

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field

from lumitip_fab.catalogue.record import Entry, Sourced, Strict


class Tolerance(Entry):
    """The distribution of a deviation; its mean is 0."""

    distribution: Literal["normal", "uniform"] = "normal"
    """Its form."""
    spread: float = Field(ge=0, le=100)
    """Standard deviation, or half the width of a uniform distribution."""
    unit: Literal["mm", "deg", "share"] = "mm"
    """Unit of the spread."""
    of: Literal["", "line", "layer", "pin"] = ""
    """Length of the design that the spread is a share of: line width or layer height of the
    printer, or the play of the board on its pins."""
    measure: str = Field(min_length=1, max_length=200)
    """How to measure or reduce it on one's own build."""


class Tolerances(Strict):
    """One for each deviation."""

    mask_shift: Tolerance
    mask_turn: Tolerance
    mask_scale: Tolerance
    hole: Tolerance
    board: Tolerance
    print: Tolerance
    placement: Tolerance
    silicone: Tolerance
    lean: Tolerance
    gap: Tolerance
    finger_shift: Tolerance
    finger_tilt: Tolerance
    led: Tolerance
    detector: Tolerance
    drift: Tolerance
    exposure: Tolerance
    scatter: Tolerance


class MaskShifts(Sourced):
    """How far each mask may be off, of designs that it was computed for."""

    each: Mapping[
        Annotated[str, Field(pattern=r"^[0-9a-f]{12}$")], Annotated[float, Field(ge=0, le=10)]
    ]
    """In mm, by the fingerprint of cells, optics and tolerances."""
