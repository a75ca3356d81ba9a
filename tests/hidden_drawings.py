"""DXFs that programs show or mirror in different ways."""

from collections.abc import Callable
from pathlib import Path

import ezdxf
from ezdxf.document import Drawing


def layer_off(drawing: Drawing) -> None:
    drawing.layers.get("FOLD").off()


def layer_frozen(drawing: Drawing) -> None:
    drawing.layers.get("CUT").freeze()


def layer_not_printed(drawing: Drawing) -> None:
    drawing.layers.get("CUT").dxf.plot = 0


def object_invisible(drawing: Drawing) -> None:
    next(iter(drawing.modelspace().query("LWPOLYLINE"))).dxf.invisible = 1


def object_from_below(drawing: Drawing) -> None:
    next(iter(drawing.modelspace().query("LWPOLYLINE"))).dxf.extrusion = (0, 0, -1)


HIDDEN = (layer_off, layer_frozen, layer_not_printed, object_invisible, object_from_below)


def redrawn(file: str, change: Callable[[Drawing], None]) -> Callable[[Path], None]:
    """Change a DXF of a folder."""

    def damage(folder: Path) -> None:
        document = ezdxf.readfile(folder / file)
        change(document)
        document.saveas(folder / file)

    return damage
