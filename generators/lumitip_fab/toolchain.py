"""What a result depends on besides its input: this package's code and the tools it calls."""

import hashlib
import sys
from collections.abc import Iterable
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import lumitip
from lumitip_fab.locate import firmware_sources

PACKAGE = Path(__file__).parent
# What design and layout are made of, and what generators share; a change in one of them may change
# every file.
SHARED = (
    "artefact.py", "colours.py", "derive", "design", "encoding.py", "errors.py", "frames.py",
    "graph.py", "locate.py", "made.py", "markdown_text.py", "typeface.py", "values.py",
)  # fmt: skip
LAYOUT = ("errors.py", "grid.py", "layout.py")


@lru_cache
def code_hash(*parts: str) -> str:
    """Hash of some modules and folders of this package and of those that all share."""
    roots = [PACKAGE / name for name in (*parts, *SHARED)]
    roots += [Path(lumitip.__file__).parent / name for name in LAYOUT]
    if "firmware" in parts:
        roots += [Path(lumitip.__file__).parent / "protocol", *firmware_sources()]
    if "explore" in parts:
        roots += [Path(lumitip.__file__).parent / name for name in ("twin", "estimation")]
    return _hash(f for r in roots for f in (_sources(r) if r.is_dir() else [r]))


@lru_cache
def whole_code_hash() -> str:
    """Hash of all of both packages, and of the firmware."""
    roots = (PACKAGE, Path(lumitip.__file__).parent)
    return _hash([*(f for r in roots for f in _sources(r)), *firmware_sources()])


def _sources(folder: Path) -> list[Path]:
    """Code, and the sheet that schematics grow from."""
    return sorted(f for f in folder.rglob("*") if f.suffix in {".py", ".kicad_sch"})


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


@lru_cache
def installed_hash() -> str:
    """Hash of the name and version of every installed distribution, and of Python's."""
    folders = (Path(entry) for entry in sys.path if entry)
    names = sorted(d.name for f in folders if f.is_dir() for d in f.glob("*.dist-info"))
    return hashlib.sha256("\n".join([sys.version, *names]).encode()).hexdigest()
