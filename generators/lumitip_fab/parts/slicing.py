"""Slicing of the built parts with PrusaSlicer: time, mass and what hangs in the air, from the
G-code."""

import dataclasses
import json
import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table
from scipy.spatial import cKDTree

from lumitip_fab.design import Design
from lumitip_fab.design.encoding import read_design
from lumitip_fab.design.mould import printed_times
from lumitip_fab.errors import BuildError, OutputError

PROGRAMS = ("prusa-slicer", "PrusaSlicer", "prusa-slicer-console")
_MOST_S = 600.0
_COMPLAINTS = ("warning", "error", "empty layer", "could not", "fail")
_WORD = re.compile(r"([XYE])(-?\d*\.?\d+)")
_STEP_MM = 0.2  # between points of a line; finer than the widths of lines
_UNITS_S = {"d": 86400, "h": 3600, "m": 60, "s": 1}
_NO_PART = ("Skirt/Brim", "Custom", "Support")


@dataclass(frozen=True)
class Sliced:
    """One part, sliced."""

    part: str
    """Path of its 3MF below the output folder."""
    number: int
    """How often it is printed for a pair of fingers: 0 for a sheet of a mask of film."""
    settings: str
    filament: str
    seconds: int
    """Of one, as the figures below."""
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
                    (_number(design, part), filament.file, filament.name),
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


def _number(design: Design, part: str) -> int:
    """How often a 3MF is printed for a pair of fingers."""
    if part.startswith("mask/") and design.mask.route != "tpu":
        return 0
    return printed_times(design.mould_accessories, part.removesuffix("3mf") + "stl")


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
    return tuple(line.strip() for line in said if any(w in line.lower() for w in _COMPLAINTS))


def _read(
    file: Path,
    part: str,
    text: str,
    warnings: tuple[str, ...],
    printed_from: tuple[int, str, str],
    density_g_ml: float,
    line_mm: float,
) -> Sliced:
    found = layers_of(text)
    if not found:
        raise BuildError(f"{part}: the slicer made no layer")
    reach, at_mm = reach_mm(found)
    mesh = trimesh.load(file, force="mesh")
    first = found[0].length_mm * line_mm
    return Sliced(
        part,
        *printed_from,
        seconds(text),
        grams(text),
        float(mesh.volume) / 1000 * density_g_ml,
        len(found),
        first,
        reach,
        at_mm,
        warnings,
    )


def as_json(parts: tuple[Sliced, ...]) -> str:
    """Every figure of every part, and the sums for a pair of fingers."""
    record: dict[str, Any] = {
        "parts": [dataclasses.asdict(part) for part in parts],
        "seconds": sum(part.number * part.seconds for part in parts),
        "grams": round(sum(part.number * part.grams for part in parts), 2),
    }
    return json.dumps(record, indent=1)


def print_table(parts: tuple[Sliced, ...], console: Console) -> None:
    """Number, time and mass of each, and what hangs over nothing; sums for a pair of fingers, and
    warnings of the slicer below."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("part", no_wrap=True)
    table.add_column("filament", no_wrap=True)
    for heading in ("times", "time", "filament", "of it solid", "layers", "hangs out", "at"):
        table.add_column(heading, justify="right", no_wrap=True)
    for p in parts:
        table.add_row(
            p.part,
            p.filament,
            str(p.number) if p.number else "not needed",
            _time(p.seconds),
            f"{p.grams:.1f} g",
            f"{p.solid_g:.1f} g",
            str(p.layers),
            f"{p.reach_mm:.1f} mm",
            f"{p.reach_at_mm:.1f} mm",
        )
    total_g = sum(p.number * p.grams for p in parts)
    whole_s = sum(p.number * p.seconds for p in parts)
    table.add_row("one pair of fingers", "", "", _time(whole_s), f"{total_g:.1f} g")
    console.print(table)
    for part in parts:
        for line in part.warnings:
            console.print(f"{part.part}: {line}")


def _time(seconds: int) -> str:
    return f"{seconds // 3600} h {seconds % 3600 // 60:02d} min"


@dataclass(frozen=True, eq=False)
class Layer:
    """Extrusion of one layer of the part, without brim and support."""

    z_mm: float
    points_mm: NDArray[np.float64]
    """Along the lines, at most 0.2 mm apart, shape `(n, 2)`."""
    length_mm: float
    """Length of all its lines."""


def seconds(text: str) -> int:
    """The slicer's own estimate of the time.

    Raises:
        BuildError: if the G-code has none.
    """
    found = re.search(r"^; estimated printing time \(normal mode\) = (.+)$", text, re.MULTILINE)
    if not found:
        raise BuildError("the slicer's G-code has no time")
    return sum(int(n) * _UNITS_S[unit] for n, unit in re.findall(r"(\d+)([dhms])", found[1]))


def grams(text: str) -> float:
    """Mass of all that is extruded, brim too.

    Raises:
        BuildError: if the G-code has none.
    """
    found = re.search(r"^; total filament used \[g\] = ([\d.]+)$", text, re.MULTILINE)
    if not found:
        raise BuildError("the slicer's G-code has no mass")
    return float(found[1])


def layers_of(text: str) -> tuple[Layer, ...]:
    """The layers from the bed up. Needs absolute coordinates, and PrusaSlicer's own comments."""
    lines: dict[float, list[NDArray[np.float64]]] = {}
    x = y = z = e = 0.0
    kind = ""
    for line in text.splitlines():
        if line.startswith(";TYPE:"):
            kind = line[6:]
        elif line.startswith(";Z:"):
            z = float(line[3:])
        elif line.startswith("G92 "):
            e = 0.0
        elif line.startswith(("G0 ", "G1 ")):
            words = {name: float(value) for name, value in _WORD.findall(line)}
            before, (x, y) = (x, y), (words.get("X", x), words.get("Y", y))
            pushed, e = words.get("E", e) - e, words.get("E", e)
            if pushed > 0 and (x, y) != before and not kind.startswith(_NO_PART):
                lines.setdefault(z, []).append(_along(before, (x, y)))
    return tuple(
        Layer(z, np.concatenate(lines[z]), sum(float(np.hypot(*(a[-1] - a[0]))) for a in lines[z]))
        for z in sorted(lines)
    )


def reach_mm(layers: tuple[Layer, ...]) -> tuple[float, float]:
    """How far at most a line is from the nearest one of the layer below it, and at what height
    (mm): what a bridge spans is up to twice as much."""
    worst, at_mm = 0.0, 0.0
    for below, layer in pairwise(layers):
        far = float(cKDTree(below.points_mm).query(layer.points_mm)[0].max())
        if far > worst:
            worst, at_mm = far, layer.z_mm
    return worst, at_mm


def _along(begin: tuple[float, float], end: tuple[float, float]) -> NDArray[np.float64]:
    a, b = np.array(begin), np.array(end)
    steps = max(1, int(np.ceil(np.linalg.norm(b - a) / _STEP_MM)))
    share = np.linspace(0.0, 1.0, steps + 1)[:, None]
    points: NDArray[np.float64] = a + share * (b - a)
    return points
