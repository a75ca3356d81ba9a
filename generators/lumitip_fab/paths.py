"""Where the design folder is: the user's own, or the one that comes with the package; and where
the firmware is."""

import math
import os
import stat
from importlib.resources import files
from pathlib import Path

LARGEST_INPUT_BYTES = 200_000


def packaged_design() -> Path:
    """The `design/` that comes with the package: inside the wheel, or beside the source."""
    inside = Path(str(files("lumitip_fab"))) / "_design"
    return inside if inside.is_dir() else Path(__file__).parents[2] / "design"


def firmware_sources() -> tuple[Path, ...]:
    """The files of the sketch that all designs share: inside the wheel, or beside the source."""
    inside = Path(str(files("lumitip_fab"))) / "_firmware"
    folder = inside if inside.is_dir() else Path(__file__).parents[2] / "readout" / "firmware"
    return tuple(sorted(f for f in folder.glob("*.*") if f.suffix in (".h", ".ino", ".md")))


def resolved(path: Path) -> Path:
    """A path without symbolic links; of links in a circle, as far as it can be followed."""
    return Path(os.path.realpath(path))  # `Path.resolve` raises for a circle before Python 3.13


def read_input(path: Path) -> bytes:
    """The bytes of a file that a user wrote.

    Raises:
        OSError: if it cannot be read, is no plain file, or is too long; the reason is its
            `strerror`.
    """
    return read_plain(path, LARGEST_INPUT_BYTES)


def read_plain(path: Path, most_bytes: float = math.inf) -> bytes:
    """The bytes of a file.

    Raises:
        OSError: if it cannot be read, or is no plain file but a folder, pipe or device, of which
            some never end, or has more bytes than are allowed; the reason is its `strerror`.
    """
    found = path.stat()
    if not stat.S_ISREG(found.st_mode):
        kind = "folder" if path.is_dir() else "pipe or device"
        raise OSError(0, f"it is a {kind}, and a file is needed")
    if found.st_size > most_bytes:
        raise OSError(0, f"it has {found.st_size} bytes, and at most {most_bytes} are allowed")
    return path.read_bytes()


def design_folder(file: Path) -> Path:
    """The folder that a parameter file belongs to: that or the one above with `parts/` in it, or
    with what is to be that folder and cannot be opened.

    No base file outside it is read.
    """
    here = resolved(file).parent
    return next((f for f in (here, here.parent) if _has_parts(f)), here)


def _has_parts(folder: Path) -> bool:
    parts = folder / "parts"
    return os.path.lexists(parts) and not parts.is_file()


def parts_folders(folder: Path) -> tuple[Path, Path]:
    """Where the catalogue of a design folder is looked for: its own, then the packaged one."""
    return folder / "parts", packaged_design() / "parts"


def parts_file(folder: Path, kind: str) -> Path:
    """The catalogue file of a kind: the user's own, whatever lies there, else the packaged one."""
    own, packaged = (f / f"{kind}.toml" for f in parts_folders(folder))
    return own if os.path.lexists(own) else packaged
