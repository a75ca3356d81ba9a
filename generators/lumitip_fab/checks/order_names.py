"""Nets and pads by name in a zip's copper: a fab that reads them tests bare boards by them."""

import re
from collections import defaultdict
from collections.abc import Iterator

import numpy as np
import shapely

from lumitip_fab.checks.board_read import ReadBoard, lands
from lumitip_fab.checks.result import Measurement, Subject

_NEAR_MM = 0.01  # chords of round copper and six digits of files
_STATEMENT = re.compile(
    r"%T(?P<attribute>[OD])(?:\.(?P<name>\w+),(?P<value>[^*%\n]*))?\*%"
    r"|(?:X(?P<x>-?\d+))?(?:Y(?P<y>-?\d+))?D0[123]\*"
)
_FORM = "%FSLAX46Y46*%"
_MM = 1e6
"""Of the coordinates in this form."""
_NO_NET = "N/C"


def measure_names(path: str, read: ReadBoard, layers: dict[str, str]) -> Measurement:
    """Net and pad of every point that is flashed or drawn, against the board's copper there.

    Args:
        path: of the zip.
        read: its board.
        layers: text of each copper layer, by its name on the board.
    """
    wrong = sorted({name for layer, text in layers.items() for name in _wrong(read, layer, text)})
    return Subject("orders", path).count("names", wrong, "nets and pads named wrongly")


def _wrong(read: ReadBoard, layer: str, text: str) -> Iterator[str]:
    nets, pads = defaultdict(list), defaultdict(list)
    for piece in read.board.copper():
        if layer in piece.layers:
            nets[piece.net or _NO_NET].append(piece.area)
    for part, terminal, land in lands(read.board, layer):
        pads[f"{part.ref},{terminal.number}"].append(land.area)
    areas = {**nets, **{f"pad {pad}": found for pad, found in pads.items()}}
    for name, points in _points(text).items():
        area = shapely.transform(shapely.union_all(areas.get(name, [])), read.sensor)
        shapely.prepare(area)
        if not (shapely.distance(area, shapely.points(points)) <= _NEAR_MM).all():
            yield f"{name or 'no net'} on {layer}"


def _points(text: str) -> dict[str, list[tuple[float, float]]]:
    """Every point of a layer by the net that is in force there, and by the pad, if there is one.

    Raises:
        ValueError: if its coordinates are of another form.
    """
    if _FORM not in text or "%MOMM*%" not in text:
        raise ValueError("coordinates are not in mm with six decimals")
    found = defaultdict(list)
    values: dict[str, str] = {}
    x = y = np.nan
    for statement in _STATEMENT.finditer(text):
        if statement["attribute"] == "D":
            values = {} if statement["name"] is None else values
        elif statement["attribute"]:
            values[statement["name"]] = statement["value"]
        else:
            x = float(statement["x"]) / _MM if statement["x"] else x
            y = float(statement["y"]) / _MM if statement["y"] else y
            found[values.get("N", "")].append((x, y))
            if "P" in values:
                found[f"pad {values['P']}"].append((x, y))
    return found
