"""The mutators of each format, and those of files as a whole."""

from pathlib import Path, PurePosixPath

from numpy.random import Generator

from mutations.damage import Mutators, NotApplicableError
from mutations.drawings import DXF, SVG
from mutations.expressions import KICAD
from mutations.gerbers import ORDER
from mutations.pages import PDF
from mutations.records import CIR, CSV, INI, JSON, KICAD_PROJECT, TOML
from mutations.robots import ROBOT
from mutations.scenes import GLB, PNG
from mutations.solids import STL, THREEMF
from mutations.sources import HTML, MARKDOWN, SOURCE
from mutations.step import STEP

BY_SUFFIX: dict[str, Mutators] = {
    ".stl": STL,
    ".3mf": THREEMF,
    ".step": STEP,
    ".pdf": PDF,
    ".svg": SVG,
    ".dxf": DXF,
    ".zip": ORDER,
    ".kicad_pcb": KICAD,
    ".kicad_sch": KICAD,
    ".kicad_mod": KICAD,
    ".kicad_sym": KICAD,
    ".kicad_pro": KICAD_PROJECT,
    "": KICAD,  # fp-lib-table, sym-lib-table
    ".csv": CSV,
    ".json": JSON,
    ".toml": TOML,
    ".ini": INI,
    ".cir": CIR,
    ".urdf": ROBOT,
    ".xacro": ROBOT,
    ".xml": ROBOT,
    ".h": SOURCE,
    ".ino": SOURCE,
    ".md": MARKDOWN,
    ".html": HTML,
    ".glb": GLB,
    ".png": PNG,
}
WHOLE = ("swap", "lose", "stray")
"""Kinds of damage of a whole file, which every format has."""
Files = dict[str, bytes | None]


def suffix(path: str) -> str:
    """The key of a path in `BY_SUFFIX`."""
    return PurePosixPath(path).suffix.lower()


def artefact(path: str) -> str:
    """Top folder and format, like `"mask/pdf"`; at the top, the file itself."""
    top, _, rest = path.partition("/")
    return f"{top}/{suffix(path).removeprefix('.') or PurePosixPath(path).name}" if rest else path


def of_whole_file(
    kind: str, out: Path, path: str, paths: list[str], rng: Generator
) -> tuple[Files, str]:
    """Differences of a file that is swapped with another, not written, or written twice.

    Args:
        kind: one of `WHOLE`.
        out: the output folder.
        path: the file.
        paths: all files that may be damaged.
        rng: draws the other file.
    """
    data = (out / path).read_bytes()
    if kind == "lose":
        return {path: None}, "the file was not written, and is not in the manifest"
    if kind == "stray":
        name = PurePosixPath(path)
        stray = str(name.with_name(f"{name.stem}_copy{name.suffix}"))
        return {stray: data}, f"a stray file {stray}"
    alike = [p for p in paths if artefact(p) == artefact(path) and suffix(p) == suffix(path)]
    others = [p for p in alike if (out / p).read_bytes() != data]
    if not others:
        raise NotApplicableError
    other = others[int(rng.integers(len(others)))]
    return {path: (out / other).read_bytes(), other: data}, f"swapped with {other}"
