"""DXFs that programs show, mirror or cut in different ways, or otherwise than by their corners."""

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


def _points(drawing: Drawing, values: tuple[float, float, float]) -> None:
    """Start width, end width and bulge of every corner of the cut line."""
    line = next(iter(drawing.modelspace().query('LWPOLYLINE[layer=="CUT"]')))
    line.set_points([(x, y, *values) for x, y in line.get_points("xy")], format="xyseb")


def edge_bent(drawing: Drawing) -> None:
    _points(drawing, (0.0, 0.0, 0.4))


def edge_wide(drawing: Drawing) -> None:
    _points(drawing, (1.0, 0.0, 0.0))


def edge_all_wide(drawing: Drawing) -> None:
    next(iter(drawing.modelspace().query('LWPOLYLINE[layer=="CUT"]'))).dxf.const_width = 1.0


def line_dashed(drawing: Drawing) -> None:
    drawing.linetypes.add("DASHED", [1.0, 0.5, -0.5])
    next(iter(drawing.modelspace().query('LWPOLYLINE[layer=="CUT"]'))).dxf.linetype = "DASHED"


def layer_dashed(drawing: Drawing) -> None:
    drawing.linetypes.add("DASHED", [1.0, 0.5, -0.5])
    drawing.layers.get("CUT").dxf.linetype = "DASHED"


def spline_added(drawing: Drawing) -> None:
    points = [(0, 0), (1, 1), (2, 0), (3, 1)]
    drawing.modelspace().add_spline(points, dxfattribs={"layer": "CUT"})


def arc_added(drawing: Drawing) -> None:
    drawing.modelspace().add_arc((0, 0), 5, 0, 90, dxfattribs={"layer": "FOLD"})


HIDDEN = (
    *(layer_off, layer_frozen, layer_not_printed, layer_dashed, object_invisible),
    *(object_from_below, edge_bent, edge_wide, edge_all_wide, line_dashed),
    *(spline_added, arc_added),
)


def redrawn(file: str, change: Callable[[Drawing], None]) -> Callable[[Path], None]:
    """Change a DXF of a folder."""

    def damage(folder: Path) -> None:
        document = ezdxf.readfile(folder / file)
        change(document)
        document.saveas(folder / file)

    return damage
