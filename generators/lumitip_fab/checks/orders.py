"""What is sent to the board houses, against the board files: layers, drills, parts, places."""

import csv
import io
import math
import zipfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import Read
from lumitip_fab.checks.gerber_read import drilled, gerber_area
from lumitip_fab.checks.kicad_board import Part, read_board
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.design import Design, Fab
from lumitip_fab.errors import OutputError

READS = ("boards/*.kicad_pcb", "boards/*.zip", "boards/*.csv")
AREA_SHARE = 0.001  # of the copper
PLACE_MM = 0.001
MASK_GAP_MM = 0.1  # an opening round a pad, each side, at most
TURN_DEG = 0.1
_SIDES = ("front", "back")
_Files = dict[str, bytes]


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every zip of both boards; the layers of the first, which the others are to equal."""
    for finger in design.fingers:
        folder = outputs / "boards" / finger.name
        subject = f"boards/{finger.name}/{finger.name}.kicad_pcb"
        try:
            read = Read(subject, read_board(outputs / subject), finger, design)
        except OutputError as error:
            yield unreadable("orders.board", subject, str(error))
            continue
        first: _Files | None = None
        for fab in design.fabs:
            name = f"{fab.name}_{finger.name}.zip"
            path = f"boards/{finger.name}/order/{name}"
            try:
                files = _unzipped(folder / "order" / name)
                layers = {key: files[finger.name + end] for key, end in fab.layers}
                yield _tables_twice(path, folder / "order", fab, finger.name, files)
                if first is None:
                    yield from _layers(path, read, layers)
                else:
                    other = [key for key in first if first[key] != layers[key]]
                    yield _count("same", path, other, "layers that differ")
                first = first or layers
                yield from _parts(path, read, fab, files)
            except (OSError, KeyError, ValueError, SyntaxError, zipfile.BadZipFile) as error:
                yield unreadable("orders.readable", path, f"cannot be read: {error!r:.200}")


def _layers(path: str, read: Read, layers: _Files) -> Iterator[Measurement]:
    """Copper, mask, edge and drills against the board file."""
    text = {key: data.decode() for key, data in layers.items()}
    for side, layer in zip(_SIDES, (read.board.layers[0], read.board.layers[-1]), strict=True):
        areas = [p.area for p in read.board.copper() if layer in p.layers]
        copper = _in_sensor(read, shapely.union_all(areas))
        painted = gerber_area(text[f"{side} copper"])
        share = painted.symmetric_difference(copper).area / copper.area
        yield Measurement("orders.copper", f"{path}: {side}", share, 0, AREA_SHARE, "of the copper")
        pads = [t.copper.area for part in read.board.parts for t in part.terminals
                if t.copper is not None and layer in t.copper.layers]  # fmt: skip
        covered = _in_sensor(read, shapely.union_all(pads)) - gerber_area(text[f"{side} mask"])
        yield Measurement("orders.mask", f"{path}: {side}", covered.area, 0, PLACE_MM, "mm²",
                          "of pads under the mask")  # fmt: skip
        bare = gerber_area(text[f"{side} mask"]) - _in_sensor(read, _openable(read, layer))
        yield Measurement("orders.exposed", f"{path}: {side}", bare.area, 0, PLACE_MM, "mm²",
                          "open away from pads and holes")  # fmt: skip
        soldered = _in_sensor(read, _soldered(read, layer))
        off = gerber_area(text[f"{side} paste"]).symmetric_difference(soldered).area
        yield Measurement("orders.paste", f"{path}: {side}", off, 0, PLACE_MM, "mm²",
                          "differs from the pads of mounted parts")  # fmt: skip
    edge = gerber_area(text["outline"]).bounds
    wanted = _in_sensor(read, shapely.union_all(list(read.board.edges))).bounds
    pen = (np.subtract(edge, wanted) * (-1, -1, 1, 1)).tolist()
    off = max(pen) - min(pen)
    yield Measurement("orders.outline", path, off, 0, PLACE_MM, "mm", "from the board's edge")
    plated = [(t.at, t.drill_mm) for part in read.board.parts for t in part.terminals
              if t.copper is not None and t.drill_mm]  # fmt: skip
    vias = [((p.area.centroid.x, p.area.centroid.y), p.drill_mm)
            for p in read.board.loose if p.kind == "via"]  # fmt: skip
    holes = [(t.at, t.drill_mm) for t in read.holes]
    for key, told in (("plated", plated + vias), ("unplated", holes)):
        off = _apart(read, drilled(text[key]), told)
        note = f"worst of {len(told)} {key} holes"
        yield Measurement("orders.drills", path, off, 0, PLACE_MM, "mm", note)


def _openable(read: Read, layer: str) -> BaseGeometry:
    """Where the mask may be open on a layer: pads and holes with a gap, marks with their ring."""
    areas = []
    for part in read.board.parts:
        for t in part.terminals:
            if t.copper is None:
                areas.append(shapely.Point(t.at).buffer(t.drill_mm / 2 + MASK_GAP_MM))
            elif layer in t.copper.layers:
                left, _, right, _ = t.copper.area.bounds
                ring = (right - left) / 2 if part.footprint.startswith("Fiducial") else 0.0
                areas.append(t.copper.area.buffer(ring + MASK_GAP_MM))
    return shapely.union_all(areas)


def _soldered(read: Read, layer: str) -> BaseGeometry:
    """Pads on a layer of the parts that are mounted on it."""
    return shapely.union_all([
        t.copper.area for part in read.board.parts if "exclude_from_bom" not in part.attributes
        for t in part.terminals
        if t.copper is not None and not t.drill_mm and layer in t.copper.layers
    ])  # fmt: skip


def _apart(
    read: Read, found: list[tuple[float, float, float]],
    wanted: list[tuple[tuple[float, float], float]],
) -> float:  # fmt: skip
    """Worst place or diameter of a hole; NaN if there are more or fewer."""
    if len(found) != len(wanted) or not found:
        return math.nan
    places = read.sensor([at for at, _ in wanted])
    told = np.column_stack([places, [size for _, size in wanted]])
    order = [np.lexsort(np.round(a, 2).T) for a in (told, np.array(found))]
    return float(np.abs(told[order[0]] - np.array(found)[order[1]]).max())


def _parts(path: str, read: Read, fab: Fab, files: _Files) -> Iterator[Measurement]:
    """Bill of materials and placement list against the parts on the board."""
    name = read.finger.name
    bom = _rows(files[f"{name}_bom.csv"], fab.bom)
    mounted = {p.ref for p in read.board.parts if "exclude_from_bom" not in p.attributes}
    refs = [ref for row in bom for ref in row["refs"].split(",")]
    wrong = sorted(mounted ^ set(refs)) + [ref for ref in set(refs) if refs.count(ref) > 1]
    wrong += [row["part"] for row in bom if "quantity" in row
              and int(row["quantity"]) != len(row["refs"].split(","))]  # fmt: skip
    wrong += [
        f"{row['refs']:.20} is {row['part'] or 'without a number'}"
        for row in bom
        if {row["part"]} != {_number(read, ref) for ref in row["refs"].split(",")}
    ]
    yield _count("bom", path, wrong, "parts")
    rows = _rows(files[f"{name}_positions.csv"], fab.positions)
    lost = sorted(mounted ^ {row["ref"] for row in rows})
    yield _count("placed", path, lost, "parts")
    known = [(row, read.parts[row["ref"]]) for row in rows if row["ref"] in read.parts]
    told = np.array([(float(row["x_mm"]), float(row["y_mm"])) for row, _ in known])
    off = np.abs(told - read.sensor([part.at for _, part in known])).max(initial=0.0)
    yield Measurement("orders.positions", path, float(off), 0, PLACE_MM, "mm")
    sides = [row["ref"] for row, part in known if row["side"] != fab.sides[not part.front]]
    yield _count("sides", path, sides, "parts")
    turns = [_turned_by(row, part, fab) for row, part in known]
    yield Measurement("orders.turns", path, max(turns), 0, TURN_DEG, "°")


def _number(read: Read, ref: str) -> str:
    """What to order for a part, by the catalogue; the board tells a resistor's value."""
    packages, part = read.design.packages, read.parts.get(ref)
    emitter = read.finger.name == "emitter"
    numbers = {
        "D": packages.led.part, "Q": packages.photodetector.part, "U": packages.multiplexer.part,
        "C": packages.capacitor.part,
        "R": (packages.string_resistor if emitter else packages.pull_up).part,
    }  # fmt: skip
    return numbers.get(ref[:1], "").replace("{code}", part.value if part else "?")


def _turned_by(row: dict[str, str], part: Part, fab: Fab) -> float:
    """How far a part would be turned from its pads: from lead 1 along its row to the right."""
    pads = {t.number: t.at for t in part.terminals}
    last = str(max(2, len(pads) // 2))
    dx, dy = np.subtract(pads[last], pads["1"])
    seen = math.degrees(math.atan2(-dy, dx))  # counter-clockwise, from the front
    if not part.front:
        seen = 180 - seen if fab.back_from_behind else seen
    fits = [(start, turn) for start, turn in fab.rotations if part.footprint.startswith(start)]
    seen += max(fits, key=lambda fit: len(fit[0]))[1] if fits else 0.0
    return abs((float(row["angle_deg"]) - seen + 180) % 360 - 180)


def _tables_twice(path: str, folder: Path, fab: Fab, name: str, files: _Files) -> Measurement:
    """The tables beside a zip are those inside it."""
    told = (f"{name}_bom.csv", f"{name}_positions.csv")
    differ = [t for t in told if (folder / f"{fab.name}_{t}").read_bytes() != files[t]]
    return _count("tables", path, differ, "tables that differ")


def _in_sensor(read: Read, area: BaseGeometry) -> BaseGeometry:
    return shapely.transform(area, read.sensor)


def _count(check: str, path: str, wrong: list[str], unit: str) -> Measurement:
    return Measurement(f"orders.{check}", path, len(wrong), 0, 0, unit, ", ".join(wrong[:4]))


def _unzipped(path: Path) -> _Files:
    with zipfile.ZipFile(path) as package:
        return {name: package.read(name) for name in package.namelist()}


def _rows(data: bytes, columns: tuple[tuple[str, str], ...]) -> list[dict[str, str]]:
    """The rows of a table by field."""
    table = csv.DictReader(io.StringIO(data.decode()))
    return [{field: row[heading] for heading, field in columns} for row in table]
