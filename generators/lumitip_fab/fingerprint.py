"""One hash of everything that a build reads, taken without understanding any of it.

It is kept beside the manifest, not in it: the manifest is the same on every machine that has the
tools which the files depend on, whatever else is installed there.
"""

import hashlib
import tomllib
from pathlib import Path

from lumitip_fab import manifest
from lumitip_fab.locate import design_folder, parts_folders
from lumitip_fab.toolchain import installed_hash, whole_code_hash

STAMP = ".built"


def unchanged(out: Path, told: str) -> manifest.Manifest | None:
    """The manifest of a folder that this input gave, if nobody has changed a file since."""
    try:
        stamp = (out / STAMP).read_text(encoding="utf-8")
    except (OSError, ValueError):
        return None
    before = manifest.read(out)
    return before if told and stamp == _stamp(out, told) and before.intact(out) else None


def remember(out: Path, told: str) -> None:
    """Keep what a folder has just been built from."""
    manifest.write_file(out / STAMP, _stamp(out, told).encode())


def _stamp(out: Path, told: str) -> str:
    return f"{told} {manifest.sha256_of(out / manifest.NAME)}\n"


def input_hash(file: Path) -> str:
    """SHA-256 over the parameter file, its bases, the catalogue, the code and what is installed.

    Empty where the input cannot be read; reading it properly then says why.
    """
    try:
        files = _with_bases(file)
        for folder in parts_folders(design_folder(file)):
            files += sorted(folder.glob("*.toml"))
        told = [f"{path.name}\0{hashlib.sha256(path.read_bytes()).hexdigest()}" for path in files]
    except (OSError, ValueError, RecursionError):
        return ""
    told += [whole_code_hash(), installed_hash()]
    return hashlib.sha256("\n".join(told).encode()).hexdigest()


def _with_bases(file: Path) -> list[Path]:
    """The file and all that it extends; a circle ends where it closes."""
    files: list[Path] = []
    name: object = file.resolve()
    while isinstance(name, str | Path):
        file = (file.resolve().parent / name).resolve()
        if file in files:
            break
        files.append(file)
        name = tomllib.loads(file.read_text(encoding="utf-8")).get("extends")
    return files
