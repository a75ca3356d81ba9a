"""What every record of the catalogue has in common, and the kinds of values in them."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

NAME = r"^[A-Za-z0-9][\w .+/\-]*$"
Length = Annotated[float, Field(ge=0.01, le=500)]
Share = Annotated[float, Field(ge=0.01, le=1000)]
TITLE = r"^(\w[\w .,+/()µ\-]*)?$"
PIN = r"^[A-Za-z][A-Za-z0-9_]{0,15}$"
Pin = Annotated[str, Field(pattern=PIN)]
Offset = Annotated[float, Field(ge=-500, le=500)]
Name = Annotated[str, Field(min_length=1, max_length=64, pattern=NAME)]
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
