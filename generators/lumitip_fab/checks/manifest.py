"""`manifest.json` against the files it lists: their bytes, their facts, and their frames."""

import os
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePath
from xml.etree.ElementTree import ParseError

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.checks.facts import Facts, other_facts
from lumitip_fab.checks.places import EDITORS, SOLIDS, named, of_a_kind, places
from lumitip_fab.checks.readers import MALFORMED
from lumitip_fab.checks.readers.vertices import corners_mm
from lumitip_fab.checks.result import Measurement, count, unreadable
from lumitip_fab.design import Design
from lumitip_fab.design.frames import Matrix, applied
from lumitip_fab.errors import OutputError
from lumitip_fab.paths import packaged_design
from lumitip_fab.pipeline import manifest

Vector = NDArray[np.float64]

READS = ("*",)
_FILE = "manifest.json"
_PLACE_MM = 0.05
_SQUARE = 1e-6
_REPORTS = (manifest.NAME, *manifest.REPORTS, "README.md", "bench-tasks/*")
"""Files that `make outputs` and `make bench` write beside those of a build, and the page of the
folder `outputs` in the source."""


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Count files that are missing or changed; move every STL by its matrix and see it in place."""
    no_files = manifest.no_files(outputs)
    yield count("manifest.kinds", ".", no_files, "pipes, devices or folders instead of files")
    recorded = manifest.read(outputs)
    if not recorded.files:
        yield unreadable("manifest.files", _FILE, "missing, or not of this version: build again")
        yield unreadable("manifest.frames", _FILE, "lists no file")
        return
    changed = [p for p, e in recorded.files.items() if not _as_listed(outputs / p, e)]
    note = ", ".join(changed[:3]) or f"of {len(recorded.files)}"
    yield Measurement("manifest.files", _FILE, len(changed), 0, 0, "missing or changed", note)
    yield count(
        "manifest.strays",
        ".",
        sorted(_strays(outputs, recorded.files)),
        "files of no build: move them elsewhere",
    )
    odd = [path for path, entry in sorted(recorded.files.items()) if not _placed(path, entry)]
    yield count("manifest.matrices", _FILE, odd, "matrices that place no file")
    listed = {path: entry for path, entry in recorded.files.items() if path not in odd}
    yield count("manifest.frames", _FILE, list(_misplaced(listed, design)), "files misplaced")
    others = sorted(path for path in recorded.files if not of_a_kind(path))
    yield count("manifest.endings", _FILE, others, "files of a kind that their folder has not")
    for path, entry in sorted(recorded.files.items()):
        if path in odd or path in no_files:
            continue
        if entry.facts and not changed:
            yield _facts(outputs, path, entry.facts, design)
        placed = path.startswith(("backing/", "interface/", "mould/", "mask/", "gauge/"))
        if path.endswith(".stl") and placed and entry.frame:
            yield _frame(outputs, path, np.array(entry.to_sensor), design)


def _facts(outputs: Path, path: str, facts: Facts, design: Design) -> Measurement:
    """Figures of a file that differ from those in the file."""
    name = f"{_FILE}: {path}"
    try:
        wrong = list(other_facts(outputs, path, facts, design))
    except (OutputError, OSError, ParseError, *MALFORMED) as error:
        return unreadable("manifest.facts", name, f"cannot be compared: {error!r:.200}")
    return count("manifest.facts", name, wrong, "facts that the file has not")


def _as_listed(path: Path, entry: manifest.Entry) -> bool:
    return manifest.sha256_of(path) == entry.sha256 and path.stat().st_size == entry.bytes


def _placed(path: str, entry: manifest.Entry) -> bool:
    """Whether a file's matrix is one: of a solid, a motion or mirror image; a page may be scaled
    for its printer, and a scene is in metres."""
    matrix = entry.matrix
    if matrix is None or (matrix[3] != (0, 0, 0, 1)).any():
        return False
    square = matrix[:3, :3] @ matrix[:3, :3].T
    if path.endswith(SOLIDS):
        return bool(np.allclose(square, np.eye(3), atol=_SQUARE))
    return bool(np.linalg.det(square) > 0)


def _misplaced(listed: Mapping[str, manifest.Entry], design: Design) -> Iterator[str]:
    """Files that lie elsewhere than the design's, and solids of no part of it; models of bought
    parts and the robot's meshes are in the frame that they are used in."""
    wanted = places(design)
    for path, entry in sorted(listed.items()):
        is_part = path.endswith(SOLIDS) and not path.startswith(("boards/", "robot/"))
        if path in wanted:
            frame, matrix = wanted[path]
            if entry.frame != frame or not _equal(entry.matrix, matrix):
                yield path
        elif is_part or (path.endswith(SOLIDS) and not _equal(entry.matrix, np.eye(4))):
            yield path


def _equal(one: Matrix | None, other: Matrix) -> bool:
    return one is not None and bool(np.allclose(one, other, rtol=0.0, atol=_SQUARE))


def _strays(outputs: Path, listed: Mapping[str, manifest.Entry]) -> Iterator[str]:
    """Files of no build, any of which could be sent, printed or compiled with the design's."""
    for top, folders, names in os.walk(outputs):
        folder = Path(top)
        folders[:] = [f for f in folders if not _others(folder / f)]
        for path in ((folder / name).relative_to(outputs).as_posix() for name in names):
            if path not in listed and not _kept(path):
                yield path


def _kept(path: str) -> bool:
    """Whether a file is a report, an editor's, or the user's own catalogue beside its output."""
    own = path.startswith("parts/") and (packaged_design() / path).is_file()
    return own or named(path, _REPORTS) or named(PurePath(path).name, EDITORS)


def _others(folder: Path) -> bool:
    """Whether a folder is hidden, an editor's, or holds another design's outputs."""
    return named(folder.name, EDITORS) or (folder / manifest.NAME).is_file()


def _frame(outputs: Path, path: str, matrix: Matrix, design: Design) -> Measurement:
    """How far a part, moved by its matrix, lies from where the sensor frame has it."""
    name = f"{_FILE}: {path}"
    try:
        corners = applied(matrix, corners_mm(outputs / path))
    except OutputError as error:
        return unreadable("manifest.frames", name, str(error))
    low, high = corners.min(axis=0), corners.max(axis=0)
    apart = [abs(low[0] + high[0]), *_apart(path, low, high, design)]
    turn = matrix[:3, :3]
    apart.append(float(np.abs(turn @ turn.T - np.eye(3)).max()) + abs(np.linalg.det(turn) - 1))
    note = "after its matrix, from its place in its frame"
    return Measurement("manifest.frames", name, float(np.max(apart)), 0, _PLACE_MM, "mm", note)


def _apart(path: str, low: Vector, high: Vector, design: Design) -> Iterator[float]:
    """How far sides of a part lie from where they should be."""
    stack, tip_y = design.stack, design.outline.tip_y_mm
    if path.startswith("backing/"):
        yield from (abs(high[1] - tip_y), abs(high[2] - stack.face_z_mm))
    elif path.startswith("interface/"):
        (interface,) = design.interfaces
        yield abs(high[1] - interface.box.y_max_mm)
        yield abs(high[2] - stack.back_z_mm - interface.rim_height_mm)
    elif path in {clamp.file for clamp in design.clamps}:
        for clamp in design.clamps:
            yield abs(low[2] - (stack.back_z_mm - clamp.foot_mm - clamp.thickness_mm))
            yield abs(high[1] - clamp.legs[-1].y_max_mm)
    elif path in {prop.file for prop in design.props}:
        for prop in design.props:
            bed_z = stack.silicone_z_mm + design.mould.floor_mm
            yield abs(high[2] - bed_z - prop.height_mm)
            yield abs(high[1] - prop.plate.y_max_mm)
    elif path.startswith("mould/"):
        # It lies under the skin, its floor `floor_mm` high, and reaches round the tip.
        yield abs(high[2] - (stack.silicone_z_mm + design.mould.floor_mm))
        yield max(tip_y - high[1], 0.0)
    elif path.startswith("mask/"):
        yield from (abs(high[2]), abs(low[2] + design.mask.sheet.thickness_mm))
        yield max(tip_y - high[1], 0.0)
    for card in design.gauge_cards:
        if path == card.file:
            yield from (abs(high[2] - card.gap_mm), abs(low[2] + card.rail_mm))
            yield from (abs(low[1] - card.low_y_mm), abs(high[1] - card.high_y_mm))
