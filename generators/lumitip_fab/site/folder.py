"""The files of an output folder that the page shows."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from lumitip_fab.checks.readers.kicad_board import KicadBoard, read_board
from lumitip_fab.checks.readers.scene import Scene, read_scene
from lumitip_fab.checks.readers.tables import table
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import read_design
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline import manifest
from lumitip_fab.pipeline.manifest import Entry, Manifest

CHECKS, BILL, ORDER, CABLES = "checks.json", "bom.csv", "order.csv", "wiring/cables.csv"
WIRING = "wiring/wiring.svg"
SCENES = ("assembly/system.glb", "assembly/assembly.glb")
"""The scene is the first of these that the folder has."""
_COLUMNS = {
    BILL: "group item manufacturer part for quantity unit price",
    ORDER: "price",
    CABLES: "wire signal from_board from_pad to_board to_pad colour length_mm",
}
_BOUNDS = {"measured": math.nan, "low": -math.inf, "high": math.inf}
"""Value of a figure that the report has no number for."""


@dataclass(frozen=True)
class Checked:
    """A measurement of the report, and whether the check passed it.

    Figures that are not finite are null in the report, and others are rounded, so that this cannot
    be found again from the figures.
    """

    measurement: Measurement
    passed: bool


@dataclass(frozen=True)
class Folder:
    """An output folder."""

    out: Path
    design: Design
    manifest: Manifest

    @classmethod
    def of(cls, out: Path) -> "Folder":
        """The folder at a path.

        Raises:
            OutputError: if it is no output folder, or is incomplete.
        """
        recorded = manifest.read(out)
        if not recorded.files:
            raise OutputError(
                f"--out: is {out}, which has no usable {manifest.NAME}; an output folder of this "
                "version is needed. Run lumitip-fab build."
            )
        missing = sorted(path for path in recorded.files if not (out / path).is_file())
        if missing:
            raise OutputError(
                f"--out: is {out}, where {len(missing)} of {len(recorded.files)} files are "
                f"missing, such as {missing[0]}; all are needed. Run lumitip-fab build."
            )
        return cls(out, read_design(out / "design.json"), recorded)

    def text(self, path: str) -> str:
        """The text of a file.

        Raises:
            OutputError: if it cannot be read.
        """
        try:
            return (self.out / path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise self.damaged(path, error) from error

    def rows(self, path: str) -> list[dict[str, str]]:
        """The rows of a table.

        Raises:
            OutputError: if it is no table, has no rows, or lacks a column.
        """
        try:
            rows = table(self.text(path))
        except ValueError as error:
            raise self.damaged(path, error) from error
        if not rows:
            raise self.damaged(path, "it has no rows")
        if missing := [name for name in _COLUMNS[path].split() if name not in rows[0]]:
            raise self.damaged(path, f"it has no column {missing[0]}")
        return rows

    def entry(self, path: str) -> Entry:
        """The manifest's entry of a file.

        Raises:
            OutputError: if there is none.
        """
        try:
            return self.manifest.files[path]
        except KeyError as error:
            raise self.damaged(manifest.NAME, f"it does not list {path}") from error

    def facts(self, path: str) -> Mapping[str, Any]:
        """Figures of a file, from the manifest.

        Raises:
            OutputError: if it does not list the file.
        """
        return self.entry(path).facts

    def board(self, name: str) -> KicadBoard:
        """A board by its name.

        Raises:
            OutputError: if it cannot be read.
        """
        return read_board(self.out / board_path(name))

    @cached_property
    def scene_file(self) -> str:
        """The GLB of the whole system, or of both fingers.

        Raises:
            OutputError: if there is none.
        """
        for path in SCENES:
            if path in self.manifest.files:
                return path
        raise self.damaged(SCENES[-1], "the manifest does not list it")

    @cached_property
    def scene(self) -> Scene:
        """That file's bodies.

        Raises:
            OutputError: if it cannot be read.
        """
        try:
            return read_scene(self.out / self.scene_file)
        except OutputError as error:
            raise self.damaged(self.scene_file, error) from error

    @cached_property
    def checked(self) -> tuple[Checked, ...] | None:
        """Measurements of the files as they are now; none where there is no report.

        It is empty if files have changed since they were checked.

        Raises:
            OutputError: if the report cannot be read.
        """
        if not (self.out / CHECKS).is_file():
            return None
        try:
            report = json.loads(self.text(CHECKS))
            checked = tuple(map(_checked, report["measurements"]))
            same = report["content_sha256"] == manifest.content_hash(self.out)
        except (ValueError, TypeError, KeyError, AttributeError) as error:
            raise OutputError(
                f"{self.out / CHECKS}: cannot be read ({error!r:.200}); a report of lumitip-fab "
                "check is needed. Run make outputs."
            ) from error
        return checked if same else ()

    def damaged(self, path: str, reason: object) -> OutputError:
        """The error for a file that cannot be shown."""
        return OutputError(
            f"{self.out / path}: cannot be read ({reason!s:.200}); a file as lumitip-fab build "
            "writes it is needed. Build the design again."
        )


def board_path(name: str) -> str:
    """The KiCad file of a board."""
    return f"boards/{name}/{name}.kicad_pcb"


def _checked(entry: dict[str, Any]) -> Checked:
    figures: dict[str, Any] = {
        name: unknown if entry[name] is None else entry[name] for name, unknown in _BOUNDS.items()
    }
    if not isinstance(entry["passed"], bool):
        raise TypeError(f"passed is {entry['passed']!r:.40}; true or false is needed")
    measurement = Measurement(
        entry["check"], entry["subject"], **figures, unit=entry["unit"], note=entry["note"]
    )
    return Checked(measurement, entry["passed"])
