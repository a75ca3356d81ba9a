"""The page about an output folder: one HTML file that needs nothing else."""

import base64
import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from html import escape
from string import Template
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from lumitip.layout import Layout
from lumitip.twin import Model
from lumitip_fab.site.answers import answers, lead
from lumitip_fab.site.beds import bed_mesh
from lumitip_fab.site.boards import Followed, board_svg
from lumitip_fab.site.cells import CellRecord, cell_records
from lumitip_fab.site.checks import check_rows
from lumitip_fab.site.folder import WIRING, Folder, board_path
from lumitip_fab.site.library import colour_ramp, three_js
from lumitip_fab.site.masks import grid_svg, mask_svg
from lumitip_fab.site.tables import (
    Figure,
    bill_table,
    figure_table,
    file_lists,
    order_table,
    print_table,
    prints,
    totals,
)
from lumitip_fab.site.targets import Targets
from lumitip_fab.text import data_file

SCRIPTS = (
    "follow.js",
    "boards.js",
    "tables.js",
    "scene.js",
    "viewer.js",
    "turn.js",
    "model.js",
    "bed.js",
    "rays.js",
    "twin.js",
    "grasp.js",
    "start.js",
)
LARGER = '<button type="button" class="larger" aria-pressed="false">larger</button>'
_SVG = re.compile(r'<svg\b[^>]*\bviewBox="([^"]+)"[^>]*>(.*)', re.DOTALL)


def page(
    folder: Folder, figures: Sequence[Figure], errors: Mapping[str, float], stamp: str = ""
) -> str:
    """The whole page; the same files give the same bytes.

    Args:
        folder: the output folder.
        figures: of the design, beside the published ones.
        errors: expected ones in mm and degrees: `edge_mm`, `edge_deg`, `cable_mm`, `cable_deg`.
        stamp: of a folder that is watched: the open page is loaded again when another is written.

    Raises:
        OutputError: if a file cannot be read.
    """
    design, parts = folder.design, prints(folder)
    targets = Targets(folder, [part.file for part in parts])
    layout, records = design.layout, cell_records(folder)
    checks = check_rows(folder, targets)
    used, packs, stated = totals(folder)
    middle = int(np.hypot(layout.x_mm, layout.y_mm).argmin())
    data = {
        "cells": [record.data() for record in records],
        "checks": checks,
        "middle": middle,
        "twin": twin_data(layout),
        "extent": {"x": _extent(layout, layout.x_mm), "y": _extent(layout, layout.y_mm)},
        "prints": [
            {"file": part.file, "text": part.text, **bed_mesh(folder, part.file)} for part in parts
        ],
    }
    scripts: tuple[str, ...] = SCRIPTS
    if stamp:
        data["stamp"], scripts = stamp, (*SCRIPTS, "watched.js")
    values = {
        "title": f"{escape(design.title.name)} {escape(design.title.revision)}",
        "hash": layout.design_hash[:12],
        "lead": escape(lead(folder)),
        "answers": "".join(answers(folder, checks, parts, errors)),
        "cells": len(layout),
        "last": len(layout) - 1,
        "grid": grid_svg(layout.x_mm.tolist(), layout.y_mm.tolist(), layout.pitch_mm),
        "inputs": _inputs(records, folder),
        "wiring": _wiring(folder),
        "auxiliary": "".join(_auxiliary(folder)),
        "orders": order_table(folder, targets),
        "prints": print_table(parts),
        "parts": "".join(f"<option>{escape(part.file)}</option>" for part in parts),
        "bill": bill_table(folder, targets),
        "sums": f"{used:.2f} used by one pair of fingers, {packs:.2f} if whole packs are bought",
        "prices": escape(stated),
        "figures": figure_table(figures),
        "files": "".join(file_lists(folder)),
        "larger": LARGER,
        "style": data_file("site/page.css"),
        "script": "\n".join([colour_ramp(), *(data_file(f"site/{name}") for name in scripts)]),
        "data": _json(data),
        "three": three_js(),
        "scene": _scene(folder),
    }
    values |= {f.name: _finger(folder, f.name, records) for f in design.fingers}
    values |= {f"{f.name}_mask": mask_svg(folder, f) for f in design.fingers}
    return Template(data_file("site/page.html")).substitute(values)


def twin_data(layout: Layout) -> dict[str, Any]:
    """Cells and optical model, as the twin in the page takes them."""
    model = asdict(Model.from_layout(layout))
    return {
        "x_mm": layout.x_mm.tolist(),
        "y_mm": layout.y_mm.tolist(),
        "holes": layout.hole_share.tolist(),
        "model": model,
    }


def _extent(layout: Layout, along_mm: NDArray[np.float64]) -> tuple[int, int]:
    """From where to where an object may be moved, mm: a pitch beyond the cells."""
    pitch = layout.pitch_mm
    return math.floor(along_mm.min() - pitch), math.ceil(along_mm.max() + pitch)


def _scene(folder: Folder) -> str:
    """The GLB of the whole system, or of both fingers, in base 64.

    Raises:
        OutputError: if it holds no such scene: a browser would stop at it.
    """
    if not folder.scene.nodes:
        raise folder.damaged(folder.scene_file, "it holds no bodies")
    return base64.b64encode((folder.out / folder.scene_file).read_bytes()).decode()


def _json(data: Any) -> str:
    """JSON that may stand in a script element."""
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return text.replace("</", "<\\/").replace("<!--", "<\\u0021--")


def _finger(folder: Folder, name: str, records: Sequence[CellRecord]) -> str:
    """The board of a finger, with the parts and nets of its cells."""
    roles = {"emitter": "led", "receiver": "detector"}
    parts = {record.parts[roles[name]].partition(".")[2]: record.index for record in records}
    nets = {
        net.partition(":")[2]: record.index
        for record in records
        for net in record.nets[:1]
        if net.startswith(f"{name}:")
    }
    label = f"{name.capitalize()} board seen from its front, tip up"
    return _board(folder, name, label, Followed(parts, nets))


def _board(folder: Folder, name: str, label: str, followed: Followed) -> str:
    try:
        return board_svg(name, folder.board(name), label, followed)
    except ValueError as error:
        raise folder.damaged(board_path(name), error) from error


def _auxiliary(folder: Folder) -> list[str]:
    return [
        f'<figure class="panel" id="board-{a.name}"><figcaption><h3>{a.name.capitalize()}</h3>'
        f'<p class="soft">{escape(a.title)}. {LARGER}</p></figcaption>'
        + _board(folder, a.name, f"{a.title} from its front", Followed({}, {}))
        + "</figure>"
        for a in folder.design.auxiliary_boards
    ]


def _inputs(records: Sequence[CellRecord], folder: Folder) -> str:
    """The inputs of all multiplexers as a table of cells."""
    layout = folder.design.layout
    at = {(int(layout.mux[r.index]), int(layout.channel[r.index])): r.index for r in records}
    channels = len(folder.design.packages.multiplexer.inputs)
    head = "".join(f'<th scope="col">{channel}</th>' for channel in range(channels))
    rows = []
    for mux in range(folder.design.wiring.muxes):
        cells = "".join(
            f'<td><button type="button" class="input cell" data-cell="{at[mux, channel]}" '
            f'aria-label="Cell {at[mux, channel]}: channel {channel} of U{mux + 1}">'
            f"{at[mux, channel]}</button></td>"
            if (mux, channel) in at
            else "<td></td>"
            for channel in range(channels)
        )
        rows.append(f'<tr><th scope="row">U{mux + 1}</th>{cells}</tr>')
    return (
        f'<table class="inputs"><thead><tr><th scope="col">channel</th>{head}</tr></thead>'
        f"<tbody>{''.join(rows)}</tbody></table>"
    )


def _wiring(folder: Folder) -> str:
    """The diagram of the cables, its wires by their numbers, without a size of its own.

    Raises:
        OutputError: if the file is no SVG with a view box.
    """
    svg = folder.text(WIRING)
    try:
        ElementTree.fromstring(svg)  # one that is not closed would take in the rest of the page
    except ElementTree.ParseError as error:
        raise folder.damaged(WIRING, error) from error
    if (found := _SVG.search(svg)) is None:
        raise folder.damaged(WIRING, "it has no view box")
    body = found[2].replace(' id="', ' data-wire="')
    return f'<svg class="wiring" viewBox="{found[1]}" role="img" aria-label="Wiring">{body}'
