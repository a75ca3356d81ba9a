"""Hashes of everything that a result depends on: input files, code and installed tools."""

import hashlib
import sys
import tomllib
from collections.abc import Iterable
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import lumitip
from lumitip_fab.paths import (
    design_folder,
    firmware_sources,
    parts_folders,
    read_input,
    read_plain,
    resolved,
)
from lumitip_fab.pipeline import manifest

PACKAGE = Path(__file__).parents[1]
# What design and layout are made of, and what generators share; a change in one of them may change
# every file.
SHARED = (
    "catalogue",
    "derive",
    "design",
    "errors.py",
    "paths.py",
    "pipeline/artefact.py",
    "pipeline/dependencies.py",
    "pipeline/fingerprint.py",
    "pipeline/workers.py",
    "pipeline/manifest.py",
    "text.py",
    "typeface.py",
)
LAYOUT = ("errors.py", "grid.py", "layout.py")
JUDGING = ("estimation", "processing", "protocol", "twin", "arguments.py", "frame.py", "values.py")
"""Modules of the robot's side that studies judge designs with."""
_SOURCES = {".css", ".kicad_sch", ".kicad_sym", ".md", ".py", ".svg", ".toml", ".txt"}


@lru_cache
def code_hash(*parts: str) -> str:
    """Hash of some modules and folders of this package and of those that all share."""
    roots = [PACKAGE / name for name in (*parts, *SHARED)]
    roots += [Path(lumitip.__file__).parent / name for name in LAYOUT]
    if {"models", "scenes"} & {*parts}:
        roots.append(PACKAGE / "parts")
    if "parts" in parts:
        roots.append(PACKAGE / "mask")
    if "firmware" in parts:
        roots += [Path(lumitip.__file__).parent / "protocol", *firmware_sources()]
    if {"explore", "solve", "tolerance"} & {*parts}:
        roots += [PACKAGE / "config", *(Path(lumitip.__file__).parent / name for name in JUDGING)]
    return _hash(f for r in roots for f in (_sources(r) if r.is_dir() else [r]))


@lru_cache
def whole_code_hash() -> str:
    """Hash of all of both packages, and of the firmware."""
    roots = (PACKAGE, Path(lumitip.__file__).parent)
    return _hash([*(f for r in roots for f in _sources(r)), *firmware_sources()])


def _sources(folder: Path) -> list[Path]:
    """Code, and the texts and tables beside it."""
    return sorted(f for f in folder.rglob("*") if f.suffix in _SOURCES)


def _hash(files: Iterable[Path]) -> str:
    digest = hashlib.sha256()
    for file in files:
        digest.update(file.name.encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()


@lru_cache
def tool_version(distribution: str) -> str:
    """A distribution with its version; Python itself goes with every one."""
    python = f"{sys.version_info.major}.{sys.version_info.minor}"
    try:
        return f"{distribution} {version(distribution)} on Python {python}"
    except PackageNotFoundError:  # one of two distributions of the same kernel
        return f"no {distribution}"


def made_with(room: str, *tools: str) -> dict[str, str]:
    """What the figures of a study were computed with: this package with the hash of the code, and
    libraries."""
    own = f"{version('lumitip')}, code {code_hash(room)[:16]}"
    return {"lumitip": own} | {tool: tool_version(tool) for tool in tools}


@lru_cache
def installed_hash() -> str:
    """Hash of the name and version of every installed distribution, and of Python's."""
    folders = (Path(entry) for entry in sys.path if entry)
    names = sorted(d.name for f in folders if f.is_dir() for d in f.glob("*.dist-info"))
    return hashlib.sha256("\n".join([sys.version, *names]).encode()).hexdigest()


STAMP = ".built"


def unchanged(out: Path, fingerprint: str) -> manifest.Manifest | None:
    """The manifest of a folder that this input gave, if nobody has changed a file since."""
    try:
        stamp = read_plain(out / STAMP).decode()
    except (OSError, ValueError):
        return None
    before = manifest.read(out)
    return (
        before if fingerprint and stamp == _stamp(out, fingerprint) and before.intact(out) else None
    )


def remember(out: Path, fingerprint: str) -> None:
    """Keep what a folder has just been built from."""
    manifest.write_file(out / STAMP, _stamp(out, fingerprint).encode())


def _stamp(out: Path, fingerprint: str) -> str:
    return f"{fingerprint} {manifest.sha256_of(out / manifest.NAME)}\n"


def input_hash(file: Path) -> str:
    """SHA-256 over the parameter file, its bases, the catalogue, the code and what is installed.

    Empty where the input cannot be read; reading it properly then says why.
    """
    try:
        files = _with_bases(file)
        for folder in parts_folders(design_folder(file)):
            files += sorted(folder.glob("*.toml"))
        lines = [f"{path.name}\0{hashlib.sha256(read_input(path)).hexdigest()}" for path in files]
    except (OSError, ValueError, RecursionError):
        return ""
    lines += [whole_code_hash(), installed_hash()]
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()


def _with_bases(file: Path) -> list[Path]:
    """The file and all that it extends; a circle ends where it closes."""
    files: list[Path] = []
    name: object = resolved(file)
    while isinstance(name, str | Path):
        file = resolved(resolved(file).parent / name)
        if file in files:
            break
        files.append(file)
        name = tomllib.loads(read_input(file).decode()).get("extends")
    return files
