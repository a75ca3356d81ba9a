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
    unit: Literal["mm", "deg", "share"]
    """Unit of the spread; each deviation has a fixed one."""
    of: Literal["", "line", "layer", "pin"] = ""
    """Length of the design that the spread is a share of: line width or layer height of the
    printer, or the play of the board on its pins. Empty: the spread is in its unit."""
    measure: str = Field(min_length=1, max_length=200)
    """How to measure or reduce it on one's own build."""


class LengthTolerance(Tolerance):
    """A deviation in mm."""

    unit: Literal["mm"] = "mm"
    of: Literal[""] = ""


class LineTolerance(Tolerance):
    """A deviation in mm, or a share of the printer's line width."""

    unit: Literal["mm"] = "mm"
    of: Literal["", "line"] = ""


class LayerTolerance(Tolerance):
    """A deviation in mm, or a share of the printer's layer height."""

    unit: Literal["mm"] = "mm"
    of: Literal["", "layer"] = ""


class PinTolerance(Tolerance):
    """A deviation in mm, or a share of the play of the board on its pins."""

    unit: Literal["mm"] = "mm"
    of: Literal["", "pin"] = ""


class AngleTolerance(Tolerance):
    """A deviation in degrees."""

    unit: Literal["deg"] = "deg"
    of: Literal[""] = ""


class ShareTolerance(Tolerance):
    """A deviation as a share of the nominal value."""

    unit: Literal["share"] = "share"
    of: Literal[""] = ""


class Tolerances(Strict):
    """One for each deviation."""

    mask_shift: LengthTolerance
    mask_turn: AngleTolerance
    mask_scale: ShareTolerance
    hole: LengthTolerance
    board: PinTolerance
    print: LineTolerance
    placement: LengthTolerance
    silicone: LayerTolerance
    lean: LayerTolerance
    gap: LengthTolerance
    finger_shift: LengthTolerance
    finger_tilt: AngleTolerance
    led: ShareTolerance
    detector: ShareTolerance
    drift: ShareTolerance
    exposure: ShareTolerance
    scatter: ShareTolerance


class MaskConditions(Strict):
    """Conditions that the largest shift of the masks is computed for."""

    good_percent: float = Field(gt=0, le=100)
    """Share of the fingers that are good (%)."""
    position_mm: float = Field(gt=0, le=10)
    """Goal of the position of edges and cables, rms over the poses of a finger (mm)."""
    angle_deg: float = Field(gt=0, le=45)
    """Goal of their angle (degrees)."""
    gap_mm: float = Field(gt=0, le=100)
    """Gap that the estimator expects (mm)."""
    fingers: int = Field(ge=1)
    """Built pairs of fingers."""
    poses: int = Field(ge=1)
    """Edges, and as many cables, with each pair."""
    seed: int = Field(ge=0)
    """Seed of the study."""


class MaskShifts(Sourced):
    """How far both masks may be off, of designs that it was computed for."""

    conditions: MaskConditions
    """The same for all designs."""
    each: Mapping[
        Annotated[str, Field(pattern=r"^[0-9a-f]{12}$")], Annotated[float, Field(ge=0, le=10)]
    ]
    """In mm, by the fingerprint of cells, optics, tolerances, conditions and model version."""
