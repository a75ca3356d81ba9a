"""`Memory`: what has not changed since the last run is not measured again."""

import ast
import json
import math
from collections.abc import Iterable
from dataclasses import asdict
from functools import lru_cache
from pathlib import Path
from typing import Any

from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError
from lumitip_fab.paths import read_plain, resolved
from lumitip_fab.pipeline.dependencies import Dependencies, FieldHashes
from lumitip_fab.pipeline.fingerprint import PACKAGE, installed_hash, whole_code_hash
from lumitip_fab.pipeline.manifest import sha256_of, write_file

_FIGURES = ("measured", "low", "high")


class Memory:
    """Measurements of earlier runs, kept in a file.

    A module measures the same while the files that it `READS`, the fields of the design that it
    read last time, this package's code and what is installed are the same.

    It serves one run over one design.

    Args:
        path: the file; one that is missing or spoilt remembers nothing.
        out: the output folder that is checked.
        reports: files that the run itself writes, perhaps into that folder.
    """

    def __init__(self, path: Path, out: Path, reports: Iterable[Path] = ()) -> None:
        self._path = path
        self._known = _read(path)
        self._hashes: FieldHashes | None = None
        own = {resolved(f) for f in (path, *reports)}
        files = (f for f in sorted(out.rglob("*")) if not f.is_dir() and resolved(f) not in own)
        self._sha256 = {f.relative_to(out).as_posix(): str(sha256_of(f)) for f in files}

    def recalled(self, module: str, design: Design) -> tuple[Measurement, ...] | None:
        """Measurements of a module when all that it reads was as it is now; none if it was not."""
        entry = self._known.get(module)
        if entry is None or entry["key"] != self._key(module, design, entry["fields"]):
            return None
        return tuple(map(_measurement, entry["measurements"]))

    def keep(
        self,
        module: str,
        measurements: tuple[Measurement, ...],
        design: Design,
        fields: Iterable[str],
    ) -> None:
        """Keep what a module has just measured with these fields of the design.

        Raises:
            OutputError: if it cannot be written.
        """
        names = sorted(fields)
        self._known[module] = {
            "key": self._key(module, design, names),
            "fields": names,
            "measurements": [_entry(m) for m in measurements],
        }
        try:
            write_file(self._path, json.dumps(self._known, allow_nan=False).encode())
        except OSError as error:
            raise OutputError(f"{self._path}: cannot be written: {error.strerror}") from error

    def _key(self, module: str, design: Design, fields: Iterable[str]) -> str:
        if self._hashes is None:
            self._hashes = FieldHashes(design)
        needs = Dependencies(tuple(fields), reads(module))
        return needs.key(self._hashes, self._sha256, module, whole_code_hash(), installed_hash())


@lru_cache
def reads(module: str) -> tuple[str, ...]:
    """Patterns of the files that a check module opens: its `READS`, taken from its source,
    because importing a reader of solids takes most of a second."""
    tree = ast.parse((PACKAGE / "checks" / f"{module}.py").read_text(encoding="utf-8"))
    for node in tree.body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "READS":
            return tuple(ast.literal_eval(node.value))
    raise LookupError(f"lumitip_fab.checks.{module} does not say what it READS")


def _entry(m: Measurement) -> dict[str, Any]:
    """A measurement as JSON has it: a figure that is not finite is a word, like `"inf"`."""
    figures = {name: getattr(m, name) for name in _FIGURES}
    return asdict(m) | {n: v if math.isfinite(v) else str(v) for n, v in figures.items()}


def _measurement(entry: dict[str, Any]) -> Measurement:
    return Measurement(**entry | {name: float(entry[name]) for name in _FIGURES})


def _read(path: Path) -> dict[str, Any]:
    try:
        known = json.loads(read_plain(path).decode())
        for entry in known.values():
            tuple(map(_measurement, entry["measurements"]))
            "".join(entry["fields"])  # names, or a TypeError
    except (OSError, ValueError, TypeError, AttributeError, KeyError, RecursionError):
        return {}
    return dict(known)
