"""The robot side of Lumitip: the layout of a fingertip, and the programs that read it.

Needs only numpy; links, recordings and views need extras.
"""

TYPE_CHECKING = False  # `typing` is slow to import

if TYPE_CHECKING:
    from typing import Any

    from lumitip.async_fingertip import AsyncFingertip
    from lumitip.calibration import Calibration
    from lumitip.errors import LayoutError, LumitipError
    from lumitip.fingertip import Fingertip
    from lumitip.frame import Block, Frame
    from lumitip.group import FingertipGroup
    from lumitip.layout import Cell, Layout, Optics
    from lumitip.links.base import LinkEvent
    from lumitip.options import OpenOptions
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
    "OpenOptions",
    "Optics",
    "Stats",
]

_LAZY = {
    "AsyncFingertip": "async_fingertip",
    "Block": "frame",
    "Calibration": "calibration",
    "Cell": "layout",
    "Fingertip": "fingertip",
    "FingertipGroup": "group",
    "Frame": "frame",
    "Layout": "layout",
    "LayoutError": "errors",
    "LinkEvent": "links.base",
    "LumitipError": "errors",
    "OpenOptions": "options",
    "Optics": "layout",
    "Stats": "session.stats",
}

_MODULES = ("errors", "grid", "layout")
"""Modules that are attributes without being imported."""


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, *_MODULES})


def __getattr__(name: str) -> "Any":
    # Imported on first use: many programs need only the layout, and a command can handle Ctrl-C
    # before the slow imports.
    from importlib import import_module

    if name in _MODULES:
        return import_module(f"{__name__}.{name}")
    if name not in _LAZY:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_LAZY[name]}"), name)
