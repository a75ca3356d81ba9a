"""What was sliced, as a table and as JSON."""

import dataclasses
import json
from typing import Any

from rich.console import Console
from rich.table import Table

from lumitip_fab.slicing.slicer import Sliced


def as_json(parts: tuple[Sliced, ...]) -> str:
    """Every figure of every part, and the sums."""
    told: dict[str, Any] = {
        "parts": [dataclasses.asdict(part) for part in parts],
        "seconds": sum(part.seconds for part in parts),
        "grams": round(sum(part.grams for part in parts), 2),
    }
    return json.dumps(told, indent=1)


def print_table(parts: tuple[Sliced, ...], console: Console) -> None:
    """Time, mass and what hangs over nothing; warnings of the slicer below."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("part", no_wrap=True)
    table.add_column("filament", no_wrap=True)
    for heading in ("time", "filament", "of it solid", "layers", "hangs out", "at"):
        table.add_column(heading, justify="right", no_wrap=True)
    for p in parts:
        table.add_row(
            p.part, p.filament, _time(p.seconds), f"{p.grams:.1f} g", f"{p.solid_g:.1f} g",
            str(p.layers), f"{p.reach_mm:.1f} mm", f"{p.reach_at_mm:.1f} mm",
        )  # fmt: skip
    total_g = sum(p.grams for p in parts)
    table.add_row("all", "", _time(sum(p.seconds for p in parts)), f"{total_g:.1f} g")
    console.print(table)
    for part in parts:
        for line in part.warnings:
            console.print(f"{part.part}: {line}")


def _time(seconds: int) -> str:
    return f"{seconds // 3600} h {seconds % 3600 // 60:02d} min"
