"""Folder of a study: parameter files that an earlier study wrote there, and those of a user."""

import hashlib
import json
import re
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.errors import InputError, OutputError
from lumitip_fab.pipeline import manifest

STUDY = "study.json"
_POINT = re.compile(r"point-[1-9]\d*")
_REMEDY = "Move it to another folder or name to keep it, or remove it; then start again."


def hashes(files: Mapping[str, bytes]) -> dict[str, str]:
    """SHA-256 (hex) of each parameter and catalogue file, by its name."""
    return {
        name: hashlib.sha256(data).hexdigest()
        for name, data in sorted(files.items())
        if name.endswith(".toml")
    }


def require_own(folder: Path, parts: Mapping[str, bytes]) -> None:
    """Refuse a folder in which a study would lose a user's file, or mix one with its own.

    Args:
        folder: of the study.
        parts: files of the catalogue that the study writes there, or that are there.

    Raises:
        OutputError: with each `point-N.toml` that is not as the last study wrote it, and each file
            in `parts` that is neither this nor the catalogue's of this study.
    """
    last, same = _written(folder), hashes(parts)
    faults = []
    for name in sorted({*_points(folder), *_parts(folder)}):
        found = manifest.sha256_of(folder / name)
        if found is not None and found in (last.get(name), same.get(name)):
            continue
        which = "is not as lumitip-fab design wrote it last, and would be written over or removed"
        if name.startswith("parts/"):
            which = "is no file of the base's catalogue, and the points would be built with it"
        faults.append(f"{folder / name}: {which}. {_REMEDY}")
    if faults:
        raise OutputError("\n".join(faults))


def remove_old(folder: Path, names: Collection[str]) -> None:
    """Remove points and parts that an earlier study wrote and this one does not have.

    Args:
        folder: of the study, see `require_own`.
        names: files of this study.
    """
    for name in _written(folder).keys() - set(names):
        (folder / name).unlink(missing_ok=True)


def outdated(folder: Path) -> Iterator[Path]:
    """Output folders `point-N` that were not built of the `point-N.toml` of now."""
    for path in sorted(folder.iterdir()):
        if _POINT.fullmatch(path.name) and path.is_dir():
            built = manifest.read(path)
            if built.files and built.origin.parameters_hash != _parameters_hash(path):
                yield path


def _parameters_hash(point: Path) -> str | None:
    try:
        return derive(load(point.with_suffix(".toml"))).parameters_hash
    except InputError:
        return None


def _points(folder: Path) -> list[str]:
    return [f.name for f in folder.glob("point-*.toml") if _POINT.fullmatch(f.stem)]


def _parts(folder: Path) -> list[str]:
    return [f"parts/{f.name}" for f in folder.glob("parts/*.toml")]


def _written(folder: Path) -> dict[str, str]:
    """Points and parts that the last study wrote, by name, with their SHA-256."""
    try:
        files = json.loads((folder / STUDY).read_text(encoding="utf-8"))["files"]
        found = {str(name): str(of) for name, of in files.items()}
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        return {}
    plain = re.compile(rf"({_POINT.pattern}|parts/\w+)\.toml")
    return {name: of for name, of in found.items() if plain.fullmatch(name)}
