"""What was measured before: the same files, code and tools measure the same."""

import ast
import hashlib
import json
import math
from collections.abc import Iterable
from dataclasses import asdict
from fnmatch import fnmatch
from functools import lru_cache
from pathlib import Path
from typing import Any

from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import canonical
from lumitip_fab.pipeline.fingerprint import PACKAGE, installed_hash, whole_code_hash
from lumitip_fab.pipeline.manifest import sha256_of, write_file

_FIGURES = ("measured", "low", "high")


class Watched:
    """A design that notes which of its fields are read."""

    def __init__(self, design: Design) -> None:
        self._design = design
        self.read: set[str] = set()

    def __getattr__(self, name: str) -> Any:
        told = getattr(self._design, name)
        if callable(told):
            raise TypeError(f"Design.{name} is a method: what it reads would not be noted")
        self.read.add(name)
        return told


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
        self._told = _read(path)
        self._slices: dict[str, str] = {}
        own = {f.resolve() for f in (path, *reports)}
        files = (f for f in sorted(out.rglob("*")) if f.is_file() and f.resolve() not in own)
        self._hashes = {f.relative_to(out).as_posix(): sha256_of(f) for f in files}

    def recalled(self, module: str, design: Design) -> tuple[Measurement, ...] | None:
        """What a module measured when all that it reads was as it is now; none if it was not."""
        told = self._told.get(module)
        if told is None or told["key"] != self._key(module, design, told["fields"]):
            return None
        return tuple(map(_measurement, told["measurements"]))

    def keep(
        self,
        module: str,
        measurements: tuple[Measurement, ...],
        design: Design,
        fields: Iterable[str],
    ) -> None:
        """Remember what a module has just measured with these fields of the design."""
        names = sorted(fields)
        self._told[module] = {
            "key": self._key(module, design, names),
            "fields": names,
            "measurements": [_entry(m) for m in measurements],
        }
        write_file(self._path, json.dumps(self._told, allow_nan=False).encode())

    def _key(self, module: str, design: Design, names: list[str]) -> str:
        told = [
            f"{path}\0{digest}"
            for path, digest in self._hashes.items()
            if any(fnmatch(path, pattern) for pattern in reads(module))
        ]
        told += [f"{name}\0{self._slice(design, name)}" for name in names]
        told += [module, whole_code_hash(), installed_hash()]
        return hashlib.sha256("\n".join(told).encode()).hexdigest()

    def _slice(self, design: Design, name: str) -> str:
        if name not in self._slices:  # many modules read the same fields
            self._slices[name] = canonical(getattr(design, name, None))
        return self._slices[name]


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
        told = json.loads(path.read_text(encoding="utf-8"))
        for entry in told.values():
            tuple(map(_measurement, entry["measurements"]))
            "".join(entry["fields"])  # names, or a TypeError
    except (OSError, ValueError, TypeError, AttributeError, KeyError):
        return {}
    return dict(told)
