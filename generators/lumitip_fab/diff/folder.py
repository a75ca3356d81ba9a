"""An output folder, read and tested before anything is compared."""

import math
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lumitip_fab.checks.readers.tables import table
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import read_design
from lumitip_fab.design.frames import Matrix
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline import manifest
from lumitip_fab.pipeline.manifest import REPORTS, Manifest

PARAMETERS, BILL, ORDER, CABLES = "resolved.toml", "bom.csv", "order.csv", "wiring/cables.csv"
_NEEDED = ("design.json", PARAMETERS, BILL, ORDER, CABLES)
_ROBOT = "robot/"


@dataclass(frozen=True, eq=False)
class Folder:
    """An output folder."""

    out: Path
    name: str
    """Its name in reports, without the folders above it."""
    design: Design
    manifest: Manifest
    parameters: Mapping[str, Any]
    """Every value in force by its dotted name; a list is one value."""
    parts: Mapping[str, Any]
    """Likewise the values of the catalogue's entries that are used."""
    sha256: Mapping[str, str]
    """Hash of each file by its path, without reports and hidden files."""

    @property
    def edited(self) -> list[str]:
        """Files that are not as they were built."""
        built = self.manifest.files
        return [p for p, found in self.sha256.items() if p in built and built[p].sha256 != found]

    def paths(self, ending: str) -> set[str]:
        """Its files with an ending, but for the meshes for simulators."""
        paths = (path for path in self.sha256 if path.endswith(ending))
        return {path for path in paths if not path.startswith(_ROBOT)}

    def rows(self, path: str, number: str, *needed: str) -> list[dict[str, str]]:
        """The rows of one of its tables; the file has one row or more.

        Args:
            path: of the file.
            number: a column of finite numbers; it may be empty in a row.
            needed: further columns that the file must have.

        Raises:
            OutputError: if the file is no such table.
        """
        try:
            rows = table((self.out / path).read_text(encoding="utf-8"))
            lacking = {number, *needed} - {column for row in rows[:1] for column in row}
            if lacking:
                raise ValueError(f"no row with {min(lacking)}")
            wrong = [row[number] for row in rows if not math.isfinite(float(row[number] or 0))]
        except (OSError, ValueError) as error:
            raise self.damaged(path, error) from error
        if wrong:
            raise self.damaged(path, f"{number} is {wrong[0]}")
        return rows

    def damaged(self, path: str, reason: object) -> OutputError:
        """The error for a file that cannot be compared."""
        return OutputError(
            f"{self.out / path}: cannot be read ({reason!s:.200}); a file as lumitip-fab build "
            "writes it is needed. Build the design again."
        )


def read_folder(out: Path, name: str) -> Folder:
    """Read an output folder.

    Raises:
        OutputError: if it is no output folder, is incomplete, or is of another version.
    """
    recorded = manifest.read(out)
    if not recorded.files:
        raise OutputError(
            f"{out}: has no usable {manifest.NAME}; a parameter file, or an output folder of this "
            "version of lumitip-fab build, is needed. Build the design, and name its folder."
        )
    expected = {*recorded.files, *_NEEDED}
    missing = sorted(path for path in expected if not (out / path).is_file())
    if missing:
        raise OutputError(
            f"{out}: {len(missing)} of {len(expected)} files are missing, such as {missing[0]}; a "
            "complete output folder is needed. Build the design again, without --only."
        )
    design = read_design(out / "design.json")
    files = (f for f in sorted(out.rglob("*")) if f.is_file() and not f.name.startswith("."))
    paths = [
        path
        for f in files
        if (path := f.relative_to(out).as_posix()) not in (*REPORTS, manifest.NAME)
    ]
    sha256 = {path: str(manifest.sha256_of(out / path)) for path in paths}
    folder = Folder(out, name, design, recorded, {}, {}, sha256)
    _require_frames(folder)
    try:
        parameters, parts = _values((out / PARAMETERS).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise folder.damaged(PARAMETERS, error) from error
    return Folder(out, name, design, recorded, parameters, parts, sha256)


def _require_frames(folder: Folder) -> None:
    """The matrices of parts and boards turn and move, and no more."""
    shapes = folder.paths(".stl") | folder.paths(".kicad_pcb")
    entries = [e for path, e in folder.manifest.files.items() if path in shapes]
    try:
        matrices = np.array([entry.to_sensor for entry in entries], dtype=float)
        turns = matrices.reshape(-1, 4, 4)[:, :3, :3]
        exact = np.allclose(turns @ turns.transpose(0, 2, 1), np.eye(3), atol=1e-6)
    except (TypeError, ValueError) as error:
        raise folder.damaged(manifest.NAME, error) from error
    if not exact:
        raise folder.damaged(manifest.NAME, "a matrix to_sensor is no rotation")


def _values(text: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Parameters, and the catalogue's entries, which stand below them as comments."""
    _, mark, listed = text.partition("\n# [")
    lines = f"{mark}{listed}".splitlines()
    entries = "\n".join(line.removeprefix("#").removeprefix(" ") for line in lines)
    return dict(_flat(tomllib.loads(text))), dict(_flat(tomllib.loads(entries)))


def _flat(values: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in values.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{above}{key}.")
        else:
            yield f"{above}{key}", value


def frame_change(a: Folder, b: Folder, path: str) -> Matrix | None:
    """The matrix (4x4, mm) from the frame of B's file to that of A's, both in the same place of the
    finger or board; none where they are the same frame, or where a file has no frame."""
    first, second = (folder.manifest.files.get(path) for folder in (a, b))
    if first is None or second is None or not first.frame or first.frame != second.frame:
        return None
    if first.to_sensor == second.to_sensor:
        return None
    return np.linalg.solve(np.array(first.to_sensor), np.array(second.to_sensor))
