"""Which files belong where: frame and matrix of each solid, scene and board file of a design, as
the manifest must have them, the kinds of files in each folder, and what editors add."""

from collections.abc import Iterable, Iterator
from fnmatch import fnmatchcase
from pathlib import Path, PurePath

import numpy as np

from lumitip_fab.design import Design, frames
from lumitip_fab.design.frames import Matrix

Place = tuple[str, Matrix]
"""Name of a frame, and the way to it from the file's own frame."""
KINDS = {
    "": {".csv", ".json", ".toml"},
    "assembly": {".glb", ".step", ".svg"},
    "backing": {".3mf", ".step", ".stl"},
    "boards": {
        *(".cir", ".csv", ".kicad_mod", ".kicad_pcb", ".kicad_pro", ".kicad_sch", ".kicad_sym"),
        *(".png", ".step", ".svg", ".wrl", ".zip", "fp-lib-table", "sym-lib-table"),
    },
    "firmware": {".h", ".ino", ".md"},
    "fit": {".3mf", ".step", ".stl"},
    "flange": {".3mf", ".step", ".stl"},
    "gauge": {".3mf", ".step", ".stl"},
    "holder": {".3mf", ".step", ".stl"},
    "interface": {".3mf", ".step", ".stl"},
    "manual": {".html", ".pdf", ".svg"},
    "mask": {".3mf", ".dxf", ".md", ".pdf", ".stl", ".svg"},
    "mould": {".3mf", ".dxf", ".md", ".pdf", ".step", ".stl"},
    "parts": {".toml"},
    "print": {".ini", ".md"},
    "robot": {".stl", ".urdf", ".xacro"},
    "wiring": {".csv", ".md", ".svg"},
}
"""Endings (or names that have none) of the files that a build writes into each folder."""
SOLIDS = (".stl", ".3mf", ".step")
EDITORS = (
    *(".*", "~*", "*~", "#*#", "_autosave-*", "*.bak", "*-bak", "*.lck", "*-backups"),
    *("*.kicad_prl", "fp-info-cache", "Thumbs.db", "desktop.ini"),
)
"""Names of files and folders that editors, KiCad and desktops keep for themselves."""
_MM = np.diag([1000.0, 1000.0, 1000.0, 1.0])
"""From a scene in m."""


def of_a_kind(path: str) -> bool:
    """Whether a file is of a kind that its folder has."""
    name = PurePath(path)
    folder = name.parts[0] if len(name.parts) > 1 else ""
    return (name.suffix or name.name) in KINDS.get(folder, set())


def named(name: str, patterns: Iterable[str]) -> bool:
    """Whether a name is like one of the patterns."""
    return any(fnmatchcase(name, pattern) for pattern in patterns)


def files_in(folder: Path) -> set[str]:
    """Paths of all files in a folder and those in it, but for what editors keep."""
    found = (path.relative_to(folder) for path in folder.rglob("*") if not path.is_dir())
    return {p.as_posix() for p in found if not any(named(part, EDITORS) for part in p.parts)}


def places(design: Design) -> dict[str, Place]:
    """By path: every solid of the design's parts, scene and drawing, and every board's file."""
    found: dict[str, Place] = {}
    for stem, frame, bed in (*_fingers(design), *_others(design)):
        found |= {f"{stem}{ending}": (frame, bed) for ending in (".stl", ".3mf")}
        found[f"{stem}.step"] = (frame, np.eye(4))
    for corner in design.fit_plate.corners:
        matrix = frames.fit_corner_to_sensor(corner, design.mount, design.stack)
        found |= {f"fit/fit_plate{ending}": ("sensor", matrix) for ending in (".stl", ".3mf")}
    found["assembly/assembly.step"] = ("gripper", np.eye(4))
    found["assembly/assembly.glb"] = ("gripper", _MM)
    found["assembly/system.glb"] = ("tool", _MM)
    mirrored = np.diag([-1.0, 1.0, 1.0, 1.0])
    for finger in design.fingers:
        page = frames.board_page_to_sensor(design.stack)
        found[f"boards/{finger.name}/{finger.name}.kicad_pcb"] = ("sensor", page)
        found |= {f"mask/{finger.name}_{of}.dxf": ("sensor", mirrored) for of in ("cut", "mask")}
    for board in design.auxiliary_boards:
        page = frames.board_page_to_auxiliary(design.stack)
        found[f"boards/{board.name}/{board.name}.kicad_pcb"] = ("auxiliary", page)
    return found


def _fingers(design: Design) -> Iterator[tuple[str, str, Matrix]]:
    """Path without its ending, frame, and way from the print bed to it."""
    mount, stack = design.mount, design.stack
    backing = frames.backing_bed_to_sensor(mount, stack)
    mould = frames.mould_bed_to_sensor(stack, design.mould)
    interface = frames.mount_to_sensor(mount, stack)
    for finger in design.fingers:
        yield f"backing/{finger.name}_backing", "sensor", backing
        yield f"mould/{finger.name}_mould", "sensor", mould
        yield f"mask/{finger.name}_sheet", "sensor", frames.sheet_bed_to_sensor()
        if design.interfaces:
            yield f"interface/{finger.name}_interface", "sensor", interface


def _others(design: Design) -> Iterator[tuple[str, str, Matrix]]:
    stack = design.stack
    for clamp in design.clamps:
        yield _stem(clamp.file), "sensor", frames.clamp_bed_to_sensor(stack, clamp)
    for prop in design.props:
        yield _stem(prop.file), "sensor", frames.prop_bed_to_sensor(stack, design.mould, prop)
    for card in design.gauge_cards:
        yield _stem(card.file), "sensor", frames.gauge_bed_to_sensor(card)
    for holder in design.holders:
        yield f"holder/{holder.name}", "auxiliary", frames.holder_bed_to_auxiliary(holder)
    for flange in design.flanges:
        for part, bed in frames.flange_beds(flange).items():
            yield f"flange/{flange.name}_{part}", "flange", bed
    yield "fit/fit_plate", "", np.eye(4)
    yield "mask/coupon", "", np.eye(4)


def _stem(file: str) -> str:
    return str(PurePath(file).with_suffix(""))
