"""Numbers of a frame as JSON with a schema each, which plots and tables of Foxglove read: light of
the cells, contact of the published method, and estimate. What is not known is left out.

A type in a schema is one word: Foxglove does not read a list of types such as number or null.
"""

import json
import math
from dataclasses import dataclass
from typing import Any

from lumitip.estimation import Estimate
from lumitip.frame import Values
from lumitip.processing import Contact

Record = dict[str, Any]
NO_VALUE = -1.0
"""Light of a cell that has none."""
_NUMBER = {"type": "number"}
_POINT = {
    "type": "object",
    "properties": {"x": {"type": "number"}, "y": {"type": "number"}},
    "required": ["x", "y"],
}
_TEXTS = {"type": "array", "items": {"type": "string"}}


@dataclass(frozen=True)
class Schema:
    """A JSON schema of a topic."""

    name: str
    properties: Record
    always: tuple[str, ...]
    """Properties that every record has."""

    @property
    def text(self) -> str:
        """The schema as JSON."""
        whole = {
            "$schema": "https://json-schema.org/draft/2020-12/schema",
            "title": self.name,
            "type": "object",
            "properties": self.properties,
            "required": sorted(self.always),
            "additionalProperties": False,
        }
        return json.dumps(whole, sort_keys=True)


VALUES = Schema(
    "lumitip.Values",
    {
        "values": {
            "type": "array",
            "items": _NUMBER,
            "description": "Calibrated light of each cell in cell order, 255 is full light; -1 "
            "where a cell has no value.",
        },
        "mean": _NUMBER,
        "dropped_before": {"type": "integer", "description": "Frames lost just before this one."},
    },
    ("values",),
)
CONTACT = Schema(
    "lumitip.Contact",
    {
        "shape": {"type": "string", "enum": ["none", "edge", "corner", "cable", "covered"]},
        "threshold": _NUMBER,
        "contrast": _NUMBER,
        "centre_mm": _POINT,
        "angle_deg": {**_NUMBER, "description": "Of the line of an edge, or of a cable's axis."},
        "width_mm": {**_NUMBER, "description": "Of a cable."},
        "vertex_mm": _POINT,
        "opening_deg": {**_NUMBER, "description": "Of a corner."},
    },
    ("shape",),
)
ESTIMATE = Schema(
    "lumitip.Estimate",
    {
        "kind": {"type": "string", "enum": ["none", "edge", "corner", "cable", "covered"]},
        "flags": _TEXTS,
        "offset_mm": _NUMBER,
        "angle_deg": _NUMBER,
        "offset_sd_mm": _NUMBER,
        "angle_sd_deg": _NUMBER,
        "dark_side": {"type": "string", "description": "Of a sheet: left or right of the line."},
        "width_mm": _NUMBER,
        "curvature_per_mm": _NUMBER,
        "vertex_mm": _POINT,
        "opening_deg": _NUMBER,
        "direction_deg": _NUMBER,
        "transmittance": _NUMBER,
        "gain": _NUMBER,
        "rms_counts": _NUMBER,
        "parameters": _TEXTS,
        "covariance": {
            "type": "array",
            "items": _NUMBER,
            "description": "Of the parameters, row by row.",
        },
        "left_out": {"type": "array", "items": {"type": "integer"}},
    },
    ("kind", "flags", "dark_side", "parameters", "covariance", "left_out"),
)


_ESTIMATED = (
    "offset_mm",
    "angle_deg",
    "offset_sd_mm",
    "angle_sd_deg",
    "width_mm",
    "curvature_per_mm",
    "opening_deg",
    "direction_deg",
    "transmittance",
    "gain",
    "rms_counts",
)


def values_record(values: Values, dropped_before: int | None) -> Record:
    """For `VALUES`."""
    light = values.tolist()
    finite = [value for value in light if math.isfinite(value)]
    return _known(
        values=[value if math.isfinite(value) else NO_VALUE for value in light],
        mean=sum(finite) / len(finite) if finite else None,
        dropped_before=dropped_before,
    )


def contact_record(contact: Contact) -> Record:
    """For `CONTACT`."""
    cable = contact.cable if contact.shape == "cable" else None
    corner = contact.corner if contact.shape == "corner" else None
    line = contact.line if contact.shape == "edge" else None
    turned = cable or line
    return _known(
        shape=contact.shape,
        threshold=contact.threshold,
        contrast=contact.contrast,
        centre_mm=_point(contact.centre_mm),
        angle_deg=turned.angle_deg if turned else None,
        width_mm=cable.width_mm if cable else None,
        vertex_mm=_point(corner.vertex_mm if corner else None),
        opening_deg=corner.opening_deg if corner else None,
    )


def estimate_record(estimate: Estimate) -> Record:
    """For `ESTIMATE`."""
    return _known(
        kind=estimate.kind,
        flags=list(estimate.flags),
        dark_side=estimate.dark_side,
        vertex_mm=_point(estimate.vertex_mm),
        parameters=list(estimate.parameters),
        covariance=estimate.covariance.ravel().tolist(),
        left_out=list(estimate.left_out),
        **{name: float(getattr(estimate, name)) for name in _ESTIMATED},
    )


def encoded(record: Record) -> bytes:
    """A record as JSON.

    Raises:
        ValueError: if a number is not finite.
    """
    return json.dumps(record, allow_nan=False).encode()


def _known(**fields: Any) -> Record:
    """The fields that have a value; numbers as floats of Python."""
    record = {}
    for name, value in fields.items():
        number = isinstance(value, float)
        if value is not None and (not number or math.isfinite(value)):
            record[name] = float(value) if number else value
    return record


def _point(at: tuple[float, float] | None) -> Record | None:
    return {"x": float(at[0]), "y": float(at[1])} if at else None
