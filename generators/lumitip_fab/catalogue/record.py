"""What every record of the catalogue has in common, and the kinds of values in them."""

from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

_LETTERS = "A-Za-zµÀ-ÖØ-öø-ÿ"
"""Those of Latin-1: all are in the PDFs' typeface."""
NAME = rf"^[A-Za-z0-9]([{_LETTERS}0-9 .+/\-]|_[A-Za-z0-9])*$"
"""Stands in texts where there is no title: a `_` opens no emphasis that another one closes."""
Length = Annotated[float, Field(ge=0.01, le=500)]
Share = Annotated[float, Field(ge=0.01, le=1000)]
TITLE = rf"^([{_LETTERS}0-9][{_LETTERS}0-9 .,+/()\-]*)?$"
PIN = r"^[A-Za-z][A-Za-z0-9_]{0,15}$"
Pin = Annotated[str, Field(pattern=PIN)]
Offset = Annotated[float, Field(ge=-500, le=500)]
Name = Annotated[str, Field(min_length=1, max_length=64, pattern=NAME)]


def _ascending(least_and_most: tuple[float, float]) -> tuple[float, float]:
    least, most = least_and_most
    if least > most:
        raise ValueError(f"is [{least:g}, {most:g}]; the smaller value comes first")
    return least_and_most


_Capacitance = Annotated[float, Field(gt=0, le=1e7)]
_Voltage = Annotated[float, Field(gt=0, le=100)]
Capacitances = Annotated[tuple[_Capacitance, _Capacitance], AfterValidator(_ascending)]
Voltages = Annotated[tuple[_Voltage, _Voltage], AfterValidator(_ascending)]
Confidence = Literal["datasheet", "measured", "inferred", "assumed"]


class Strict(BaseModel):
    """What every record read from a user's file has in common."""

    model_config = ConfigDict(
        strict=True,
        frozen=True,
        extra="forbid",
        allow_inf_nan=False,
        use_attribute_docstrings=True,
    )


class Sourced(Strict):
    """Figures that come from somewhere."""

    source: str = Field(min_length=1)
    """Where the figures come from."""
    confidence: Confidence
    """How far to trust them."""


class Entry(Sourced):
    """What every catalogue entry carries."""

    title: str = Field(default="", max_length=64, pattern=TITLE)
    """What people call it, in manual, bill and drawings; left out, the entry's own name."""
