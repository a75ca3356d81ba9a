"""Opening a DXF of which every program draws, prints and cuts the same."""

from pathlib import Path
from typing import Any

import ezdxf

_UP = (0.0, 0.0, 1.0)
_KINDS = frozenset({"CIRCLE", "LINE", "LWPOLYLINE", "TEXT"})
"""Entities of the drawings, all of whose lines are straight: no arc and no spline."""
_SOLID = frozenset({"BYLAYER", "CONTINUOUS"})


def read_plain_dxf(path: Path) -> Any:
    """A DXF file with ezdxf.

    Raises:
        OSError: if it is missing.
        DXFError: if it is none.
        ValueError: if a layer or an object is not shown, or an object is drawn from below, which
            programs mirror or not; is of another kind than drawings are made of; is dashed, wide
            or bent.
    """
    document = ezdxf.readfile(path)
    for layer in document.layers:
        printed = layer.dxf.get("plot", 1) or layer.dxf.name == "Defpoints"
        if layer.is_off() or layer.is_frozen() or not printed:
            raise ValueError(f"layer {layer.dxf.name} is off, frozen or not printed")
        if layer.dxf.linetype.upper() not in _SOLID:
            raise ValueError(f"layer {layer.dxf.name} has dashed lines")
    for entity in document.modelspace():
        wrong = _oddity(entity)
        if wrong:
            raise ValueError(f"a {entity.dxftype()} on {entity.dxf.layer} {wrong}")
    return document


def _oddity(entity: Any) -> str:
    """By what an object is not a plain one; empty if it is."""
    if entity.dxftype() not in _KINDS:
        return "is of another kind than drawings are made of"
    if entity.dxf.get("invisible", 0):
        return "is not shown"
    if tuple(entity.dxf.get("extrusion", _UP)) != _UP:
        return "is drawn from below"
    if entity.dxf.get("linetype", "BYLAYER").upper() not in _SOLID:
        return "is dashed"
    if entity.dxftype() == "LWPOLYLINE":
        if entity.dxf.get("const_width", 0.0) or any(any(p) for p in entity.get_points("se")):
            return "is wide"
        if any(bulge for (bulge,) in entity.get_points("b")):
            return "is bent"
    return ""
