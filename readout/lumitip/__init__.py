"""The robot side of Lumitip: the layout of a fingertip, and the programs that read it.

Needs only numpy; links, recordings and views need extras.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from lumitip.errors import LayoutError, LumitipError
from lumitip.layout import Cell, Layout, Optics

if TYPE_CHECKING:
    from lumitip.async_fingertip import AsyncFingertip
    from lumitip.calibration import Calibration
    from lumitip.fingertip import Fingertip
    from lumitip.frame import Block, Frame
    from lumitip.group import FingertipGroup
    from lumitip.links.base import LinkEvent
    from lumitip.session.stats import Stats

__all__ = [
    "AsyncFingertip",
    "Block",
    "Calibration",
    "Cell",
    "Fingertip",
    "FingertipGroup",
    "Frame",
    "Layout",
    "LayoutError",
    "LinkEvent",
    "LumitipError",
    "Optics",
    "Stats",
]

_LAZY = {
    "AsyncFingertip": "async_fingertip",
    "Block": "frame",
    "Calibration": "calibration",
    "Fingertip": "fingertip",
    "FingertipGroup": "group",
    "Frame": "frame",
    "LinkEvent": "links.base",
    "Stats": "session.stats",
}


def __getattr__(name: str) -> Any:
    # Imported on first use: many programs need only the layout.
    if name not in _LAZY:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_LAZY[name]}"), name)
