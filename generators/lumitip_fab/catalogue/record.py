"""Base classes of catalogue records, and the types of their values."""

from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, field_validator, model_validator

_LETTERS = "A-Za-zµÀ-ÖØ-öø-ÿ"
"""Those of Latin-1: all are in the PDFs' typeface."""
NAME = rf"^[A-Za-z0-9]([{_LETTERS}0-9 .+/\-]|_[A-Za-z0-9])*$"
"""Used in texts where there is no title; two `_` must not form Markdown emphasis."""
Length = Annotated[float, Field(ge=0.01, le=500)]
Share = Annotated[float, Field(ge=0.01, le=1000)]
TITLE = rf"^([{_LETTERS}0-9][{_LETTERS}0-9 .,+/()\-]*)?$"
PIN = r"^[A-Za-z][A-Za-z0-9_]{0,15}$"
Pin = Annotated[str, Field(pattern=PIN)]
Offset = Annotated[float, Field(ge=-500, le=500)]
Name = Annotated[str, Field(min_length=1, max_length=64, pattern=NAME)]
CodeNumber = Annotated[str, Field(pattern=r"^\d+[RKM]\d* C[1-9]\d*$")]


def _ascending(least_and_most: tuple[float, float]) -> tuple[float, float]:
    least, most = least_and_most
    if least > most:
        raise ValueError(f"is [{least:g}, {most:g}]; the smaller value comes first")
    return least_and_most


_Capacitance = Annotated[float, Field(gt=0, le=1e7)]
_Gain = Annotated[float, Field(ge=1, le=1e5)]
_Voltage = Annotated[float, Field(gt=0, le=100)]
_Current = Annotated[float, Field(gt=0, le=1e5)]
Capacitances = Annotated[tuple[_Capacitance, _Capacitance], AfterValidator(_ascending)]
Gains = Annotated[tuple[_Gain, _Gain], AfterValidator(_ascending)]
Voltages = Annotated[tuple[_Voltage, _Voltage], AfterValidator(_ascending)]
Currents = Annotated[tuple[_Current, _Current], AfterValidator(_ascending)]
Confidence = Literal["datasheet", "measured", "inferred", "assumed"]
TRUSTED = ("datasheet", "measured")
"""Levels of confidence by which a part is made without a try."""


class Strict(BaseModel):
    """Base of every record that is read from a user's file."""

    model_config = ConfigDict(
        strict=True,
        frozen=True,
        extra="forbid",
        allow_inf_nan=False,
        use_attribute_docstrings=True,
    )


class Sourced(Strict):
    """Figures with a source."""

    source: str = Field(min_length=1)
    """Source of the figures."""
    confidence: Confidence
    """Confidence in the figures."""


class Entry(Sourced):
    """Base of every catalogue entry."""

    title: str = Field(default="", max_length=64, pattern=TITLE)
    """Title in manual, bill and drawings; by default the entry's own name."""


class Origin(Sourced):
    """Source of a figure that the entry's `source` does not cover."""


class Traced(Entry):
    """Base of an entry of which single figures have a source of their own."""

    KIND: ClassVar = "an entry"
    """Of what its figures are, for messages."""

    origin: Mapping[str, Origin] = Field(default_factory=dict)
    """Sources of single figures, where these differ from `source`."""

    @classmethod
    def figures(cls) -> tuple[str, ...]:
        """Names of its figures that may have an origin."""
        without = {*Traced.model_fields, "base", "envelope"}
        return tuple(name for name in cls.model_fields if name not in without)

    @property
    def unsure(self) -> Mapping[str, Confidence]:
        """Figures that neither a datasheet nor a measurement gives, and the confidence in each."""
        known = [name for name in self.figures() if getattr(self, name) is not None]
        levels = {name: self.origin.get(name, self).confidence for name in known}
        return {name: level for name, level in levels.items() if level not in TRUSTED}

    @model_validator(mode="after")
    def _origins_of_figures(self) -> Self:
        unknown = sorted(set(self.origin) - set(self.figures()))
        if unknown:
            raise ValueError(
                f"origin has {', '.join(unknown)}, which is not a figure of {self.KIND}; the "
                f"figures are {', '.join(self.figures())}"
            )
        return self


class Ordered(Strict):
    """Ordering data of a part that is soldered to a board."""

    manufacturer: str = Field(min_length=1, max_length=64)
    """Manufacturer, for the bill of materials."""
    order_number: str = Field(min_length=1, max_length=64)
    """Order number; for resistors, `{code}` stands for the value, such as 75K or 4K99."""
    lcsc: str = Field(default="", pattern=r"^(C[1-9]\d*)?$")
    """Number at the distributor LCSC, which JLCPCB uses; empty where it is not known."""
    datasheet: str = Field(default="", max_length=200, pattern=r"^(https?://[!-~]+)?$")
    """Address of the maker's data sheet, for the field that KiCad opens; empty where it is not
    known."""


class OrderedByValue(Ordered):
    """Ordering data of parts of a series, of which the value is chosen."""

    lcsc_by_code: tuple[CodeNumber, ...] = ()
    """Value and number at LCSC, such as "75K C114636", of the values whose number is known."""

    @field_validator("lcsc_by_code")
    @classmethod
    def _once(cls, numbers: tuple[str, ...]) -> tuple[str, ...]:
        codes = [number.partition(" ")[0] for number in numbers]
        twice = sorted({code for code in codes if codes.count(code) > 1})
        if twice:
            raise ValueError(f"has {', '.join(twice)} twice; each value has one number")
        return numbers

    @model_validator(mode="after")
    def _number_by_value(self) -> Self:
        if self.lcsc and "{code}" in self.order_number:
            raise ValueError(
                f"lcsc is {self.lcsc}; each value has its own number. Use lcsc_by_code = "
                f'["75K {self.lcsc}"]'
            )
        return self

    def part(self, code: str) -> str:
        """Order number of a value."""
        return self.order_number.replace("{code}", code)

    def lcsc_of(self, code: str) -> str:
        """Number of a value at LCSC; empty where it is not known."""
        return dict(number.split() for number in self.lcsc_by_code).get(code, self.lcsc)
