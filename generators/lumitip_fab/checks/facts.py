"""Facts of the manifest, from which documents are written, against the files that they are of."""

import math
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from lumitip_fab.checks.order_ways import TEXTS
from lumitip_fab.checks.readers.kicad_board import Part, read_board
from lumitip_fab.checks.readers.tables import table
from lumitip_fab.checks.readers.vertices import corners_mm
from lumitip_fab.design import Design
from lumitip_fab.text import passage

Facts = Mapping[str, Any]
_SHARE = 1e-4
"""Of areas and volumes: coordinates of an STL have 24 bits."""
_ROUNDED = 0.0051
"""Of what tables and notes state to the hundredth."""
_LEVEL = 0.999
"""Upward part of the normal of a level triangle."""
_ON_BED_MM = 0.01
_G_PER_KG = 1000.0
_CAST_ML = re.compile(r"stays on the finger \| \*\*([\d.]+) mL")
_MIXED_ML = re.compile(r"cup and the weir \| ([\d.]+) mL")
_PART_G = re.compile(r"part ([AB]) \| \*\*([\d.]+) g\*\*")
_FLAP = re.compile(r"^\| (\d+) \| ([\d.]+) \| ([\d.]+) \| (-?[\d.]+) \|$", re.MULTILINE)
_FLAP_MM = 0.051
_BILL = {"where": "for", "each": "unit_price"}
"""Columns of a bill that are not called as the facts of its lines."""


def other_facts(outputs: Path, path: str, facts: Facts, design: Design) -> Iterator[str]:
    """Facts of a file that it does not have."""
    for pattern, of_file in _KINDS.items():
        if re.fullmatch(pattern, path):
            yield from of_file(outputs, path, facts, design)


def _solid(outputs: Path, path: str, facts: Facts, _design: Design) -> Iterator[str]:
    corners = corners_mm(outputs / path).reshape(-1, 3, 3)
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    areas = np.linalg.norm(across, axis=1)
    up = across[:, 2] / np.where(areas > 0, areas, 1)
    low, high = corners[:, :, 2].min(), corners[:, :, 2].max()
    level, middle = np.abs(up) > _LEVEL, corners[:, :, 2].mean(axis=1)
    found = {
        "volume_mm3": np.linalg.det(corners).sum() / 6,
        "height_mm": high - low,
        "side_mm2": np.hypot(across[:, 0], across[:, 1]).sum(),
        "base_mm2": areas[level & (middle < low + _ON_BED_MM)].sum(),
        "top_mm2": areas[level & (up > 0)].sum(),
    }
    yield from (
        name
        for name, value in found.items()
        if not abs(float(facts[name]) - value) <= _SHARE * value
    )
    if "cast_ml" in facts:
        note = (outputs / path.replace("_mould.stl", "_casting.md")).read_text(encoding="utf-8")
        yield from _stated("cast_ml", facts["cast_ml"], _CAST_ML.findall(note))


def _casting(outputs: Path, path: str, facts: Facts, _design: Design) -> Iterator[str]:
    text = (outputs / path).read_text(encoding="utf-8")
    grams = dict(_PART_G.findall(text))
    yield from _stated("volume_ml", facts["volume_ml"], _CAST_ML.findall(text))
    yield from _stated("mix_ml", facts["mix_ml"], _MIXED_ML.findall(text))
    for part in "AB":
        name = f"part_{part.lower()}_g"
        yield from _stated(name, facts[name], [grams[part]])


def _stated(name: str, value: float, texts: list[str]) -> Iterator[str]:
    if [abs(float(text) - value) <= _ROUNDED for text in texts] != [True]:
        yield name


def _bill(outputs: Path, path: str, facts: Facts, _design: Design) -> Iterator[str]:
    *rows, last = table((outputs / path).read_text(encoding="utf-8"))
    yield from _lines(facts["lines"], rows, _BILL, ("pack",))
    yield from _stated("total", facts["total"], [last["price"]])
    if facts["prices"] != last["for"]:
        yield "prices"


def _order(outputs: Path, path: str, facts: Facts, _design: Design) -> Iterator[str]:
    *rows, last = table((outputs / path).read_text(encoding="utf-8"))
    by_item = {row["item"]: row for row in rows}
    packed = [by_item[line["item"]] for line in facts["lines"]]
    yield from _lines(facts["lines"], packed, {}, ())
    yield from _stated("total", facts["total"], [last["price"]])
    single = facts["total"] - sum(line["price"] or 0.0 for line in facts["lines"])
    if not abs(single - facts["single"]) <= _ROUNDED:
        yield "single"


def _lines(
    lines: list[Facts], rows: list[dict[str, str]], names: dict[str, str], left_out: tuple[str, ...]
) -> Iterator[str]:
    for line, row in zip(lines, rows, strict=True):
        for name in (name for name in line if name not in left_out):
            if not _same(line[name], row[names.get(name, name)]):
                yield f"{name} of {row['item']}"


def _same(value: Any, text: str) -> bool:
    if isinstance(value, int | float):
        return bool(abs(value - (float(text) if text else math.nan)) <= _ROUNDED)
    return bool((value or "") == text)


def _parts(outputs: Path, path: str, facts: Facts, design: Design) -> Iterator[str]:
    """Of a board: the lines of its tables for a PCB fab, and the numbers of all its parts."""
    board, stop = Path(path).stem, f" ({passage(TEXTS, 'stop_row')})"
    for fab in design.fabs:
        tables = outputs / f"boards/{board}/order/{fab.name}_{board}_bom.csv"
        rows = table(tables.read_text(encoding="utf-8"))
        for part, row in zip(facts["parts"], rows, strict=True):
            other = [
                field
                for head, field in fab.bom
                if field in part and part[field] != row[head].removesuffix(stop)
            ]
            yield from (f"{field} of {part['refs']:.20}" for field in other)
    of_facts = {
        ref: (row["manufacturer"], row["part"])
        for row in (*facts["parts"], *facts["by_hand"])
        for ref in row["refs"].split(",")
    }
    of_board = {p.ref: _number(p) for p in read_board(outputs / path).parts if p.bought}
    yield from (f"part of {ref}" for ref, _ in sorted({*of_facts.items()} ^ {*of_board.items()}))


def _number(part: Part) -> tuple[str, str]:
    fields = dict(part.fields)
    return fields.get("Manufacturer", ""), fields.get("MPN", "")


def _masses(outputs: Path, path: str, facts: Facts, design: Design) -> Iterator[str]:
    links = ElementTree.parse(outputs / path).getroot().iter("link")
    masses = {link.get("name"): link.find("inertial/mass") for link in links}
    for finger in design.fingers:
        mass = masses[f"lumitip_{finger.name}"]
        kg = math.nan if mass is None else float(mass.get("value", "nan"))
        if not abs(facts[f"{finger.name}_g"] - _G_PER_KG * kg) <= _ROUNDED:
            yield f"{finger.name}_g"


def _flaps(outputs: Path, path: str, facts: Facts, design: Design) -> Iterator[str]:
    if facts["apertures"] != len(design.cells):
        yield "apertures"
    note = (outputs / path.replace("_mask.svg", "_wrapping.md")).read_text(encoding="utf-8")
    rows = {int(n): tuple(map(float, mm)) for n, *mm in _FLAP.findall(note)}
    for flap in facts["flaps"]:
        wanted = tuple(flap[name] for name in ("width_mm", "length_mm", "reach_mm"))
        stated = rows[flap["number"]]
        if not max(abs(a - b) for a, b in zip(wanted, stated, strict=True)) <= _FLAP_MM:
            yield f"flap {flap['number']}"
    if len(facts["flaps"]) != len(rows):
        yield "flaps"


_KINDS: dict[str, Callable[[Path, str, Facts, Design], Iterator[str]]] = {
    r".*\.stl": _solid,
    r"mould/\w+_casting\.md": _casting,
    r"bom\.csv": _bill,
    r"order\.csv": _order,
    r"boards/\w+/\w+\.kicad_pcb": _parts,
    r"robot/lumitip\.urdf": _masses,
    r"mask/\w+_mask\.svg": _flaps,
}
"""By the paths of files."""
