"""Slicing of the built parts with PrusaSlicer: time, mass and what hangs in the air."""

import dataclasses
import json
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import trimesh
from rich.console import Console
from rich.table import Table

from lumitip_fab.checks.readers import gcode
from lumitip_fab.design.encoding import read_design
from lumitip_fab.errors import BuildError, OutputError

PROGRAMS = ("prusa-slicer", "PrusaSlicer", "prusa-slicer-console")
_MOST_S = 600.0
_WORDS = ("warning", "error", "empty layer", "could not", "fail")


@dataclass(frozen=True)
class Sliced:
    """One part, sliced."""

    part: str
    """Path of its 3MF below the output folder."""
    settings: str
    filament: str
    seconds: int
    grams: float
    """Filament with the brim."""
    solid_g: float
    """Volume of its mesh by the filament's density."""
    layers: int
    first_layer_mm2: float
    """Area of the bed under the first layer, without brim: lines by their width."""
    reach_mm: float
    """How far at most a line hangs over nothing."""
    reach_at_mm: float
    """Height of that line over the bed."""
    warnings: tuple[str, ...]
    """Messages of the slicer."""


def slice_parts(
    out: Path, keep: Path | None = None, progress: Callable[[str, int, int], None] | None = None
) -> tuple[Sliced, ...]:
    """Slice every 3MF of a built folder with the settings beside it.

    Args:
        out: the output folder; nothing in it changes.
        keep: where the G-code goes; without one it is thrown away.
        progress: called with a part's name, how many are done, and how many there are.

    Raises:
        OutputError: if the folder was not built, or no PrusaSlicer is installed.
        BuildError: if the slicer fails.
    """
    program = _program()
    design, parts = read_design(out / "design.json"), sorted(_parts(out))
    done = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = keep or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        for number, part in enumerate(parts):
            if progress:
                progress(part, number, len(parts))
            filament = design.slicing.of(part)
            code = folder / (Path(part).stem + ".gcode")
            said = _run(program, out / filament.file, out / part, code)
            done.append(
                _read(
                    out / part,
                    part,
                    code.read_text(encoding="utf-8"),
                    said,
                    (filament.file, filament.name),
                    filament.density_g_ml,
                    design.printing.line_mm,
                )
            )
    return tuple(done)


def _parts(out: Path) -> Iterator[str]:
    try:
        listed = json.loads((out / "manifest.json").read_text(encoding="utf-8"))["files"]
    except (OSError, ValueError, KeyError) as problem:
        raise OutputError(f"{out}: was not built ({problem}): run lumitip-fab build") from None
    return (path for path in listed if path.endswith(".3mf"))


def _program() -> str:
    for name in PROGRAMS:
        if found := shutil.which(name):
            return found
    raise OutputError(
        f"none of {', '.join(PROGRAMS)} is installed: apt install prusa-slicer, or open "
        "print/*.ini and the parts in a PrusaSlicer of your own"
    )


def _run(program: str, settings: Path, part: Path, code: Path) -> tuple[str, ...]:
    """Slice one part; returns the lines that say that something is wrong."""
    command = [program, "--export-gcode", "--load", str(settings), "--output", str(code), str(part)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=_MOST_S, check=False)
    except (OSError, subprocess.TimeoutExpired) as problem:
        raise BuildError(f"{part}: the slicer does not run: {problem}") from problem
    said = f"{done.stdout}\n{done.stderr}".splitlines()
    if done.returncode or not code.is_file():
        raise BuildError(f"{part}: the slicer failed: {' '.join(said[-3:]).strip()}")
    return tuple(line.strip() for line in said if any(w in line.lower() for w in _WORDS))


def _read(
    file: Path,
    part: str,
    text: str,
    warnings: tuple[str, ...],
    printed_from: tuple[str, str],
    density_g_ml: float,
    line_mm: float,
) -> Sliced:
    layers = gcode.layers(text)
    if not layers:
        raise BuildError(f"{part}: the slicer made no layer")
    reach, at_mm = gcode.reach_mm(layers)
    mesh = trimesh.load(file, force="mesh")
    first = layers[0].length_mm * line_mm
    return Sliced(
        part,
        *printed_from,
        gcode.seconds(text),
        gcode.grams(text),
        float(mesh.volume) / 1000 * density_g_ml,
        len(layers),
        first,
        reach,
        at_mm,
        warnings,
    )


def as_json(parts: tuple[Sliced, ...]) -> str:
    """Every figure of every part, and the sums."""
    record: dict[str, Any] = {
        "parts": [dataclasses.asdict(part) for part in parts],
        "seconds": sum(part.seconds for part in parts),
        "grams": round(sum(part.grams for part in parts), 2),
    }
    return json.dumps(record, indent=1)


def print_table(parts: tuple[Sliced, ...], console: Console) -> None:
    """Time, mass and what hangs over nothing; warnings of the slicer below."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("part", no_wrap=True)
    table.add_column("filament", no_wrap=True)
    for heading in ("time", "filament", "of it solid", "layers", "hangs out", "at"):
        table.add_column(heading, justify="right", no_wrap=True)
    for p in parts:
        table.add_row(
            p.part,
            p.filament,
            _time(p.seconds),
            f"{p.grams:.1f} g",
            f"{p.solid_g:.1f} g",
            str(p.layers),
            f"{p.reach_mm:.1f} mm",
            f"{p.reach_at_mm:.1f} mm",
        )
    total_g = sum(p.grams for p in parts)
    table.add_row("all", "", _time(sum(p.seconds for p in parts)), f"{total_g:.1f} g")
    console.print(table)
    for part in parts:
        for line in part.warnings:
            console.print(f"{part.part}: {line}")


def _time(seconds: int) -> str:
    return f"{seconds // 3600} h {seconds % 3600 // 60:02d} min"


__all__ = ["Sliced", "slice_parts"]
