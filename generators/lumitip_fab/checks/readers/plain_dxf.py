"""Opening a DXF of which every program draws, prints and cuts the same."""

from pathlib import Path
from typing import Any

import ezdxf

_UP = (0.0, 0.0, 1.0)


def read_plain_dxf(path: Path) -> Any:
    """A DXF file with ezdxf.

    Raises:
        OSError: if it is missing.
        DXFError: if it is none.
        ValueError: if a layer or an object is not shown, or an object is drawn from below, which
            programs mirror or not.
    """
    document = ezdxf.readfile(path)
    for layer in document.layers:
        printed = layer.dxf.get("plot", 1) or layer.dxf.name == "Defpoints"
        if layer.is_off() or layer.is_frozen() or not printed:
            raise ValueError(f"layer {layer.dxf.name} is off, frozen or not printed")
    for entity in document.modelspace():
        if entity.dxf.get("invisible", 0):
            raise ValueError(f"a {entity.dxftype()} on {entity.dxf.layer} is not shown")
        if tuple(entity.dxf.get("extrusion", _UP)) != _UP:
            raise ValueError(f"a {entity.dxftype()} on {entity.dxf.layer} is drawn from below")
    return document
