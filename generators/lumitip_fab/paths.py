"""Where the design folder is: the user's own, or the one that comes with the package; and where
the firmware is."""

from importlib.resources import files
from pathlib import Path


def packaged_design() -> Path:
    """The `design/` that comes with the package: inside the wheel, or beside the source."""
    inside = Path(str(files("lumitip_fab"))) / "_design"
    return inside if inside.is_dir() else Path(__file__).parents[2] / "design"


def firmware_sources() -> tuple[Path, ...]:
    """The files of the sketch that all designs share: inside the wheel, or beside the source."""
    inside = Path(str(files("lumitip_fab"))) / "_firmware"
    folder = inside if inside.is_dir() else Path(__file__).parents[2] / "readout" / "firmware"
    return tuple(sorted(f for f in folder.glob("*.*") if f.suffix in (".h", ".ino", ".md")))


def design_folder(file: Path) -> Path:
    """The folder that a parameter file belongs to: that or the one above with `parts/` in it.

    No base file outside it is read.
    """
    here = file.resolve().parent
    return next((f for f in (here, here.parent) if (f / "parts").is_dir()), here)


def parts_folders(folder: Path) -> tuple[Path, Path]:
    """Where the catalogue of a design folder is looked for: its own, then the packaged one."""
    return folder / "parts", packaged_design() / "parts"


def parts_file(folder: Path, kind: str) -> Path:
    """The catalogue file of a kind: the user's own, else the packaged one."""
    own, packaged = (f / f"{kind}.toml" for f in parts_folders(folder))
    return own if own.is_file() else packaged
