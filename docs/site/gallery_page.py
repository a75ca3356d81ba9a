"""The gallery: the face of the default design and of every preset, to one scale, and figures."""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import lumitip_fab
from design_drawings import outline_points, paint_face
from dimensioned import Drawing
from markdown_text import code, plain, prose, table
from preset_figures import FILE, PRESETS
from repository_pages import ROOT

_INCHES_PER_MM = 0.045
_INTRO = """# Gallery of presets

Faces of the fingers, seen at the silicone with the tip up, all to one scale; the default design,
`fingertip`, comes first. Their figures are in the table; each is written by
`python docs/site/preset_figures.py`, which builds them all.

- **Price**: all of `outputs/bom.csv`, one pair with controller, at assumed prices of {stated}.
- **Prints**: estimated hours and filament of all printed parts.
- **Expected error**: rms of offset and angle for edges and cables at gaps of 2, 4 and 6 mm, in
  simulation, with optics and gains unknown ([how it is computed](goals.md#how-a-design-is-judged)).
  Every design is taken as well exposed, and other LEDs and detectors as equally bright. Nobody has
  built one of them.

"""
_HEADINGS = (
    *("preset", "cells", "pitch (mm)", "hole (mm)", "LEDs (mA)", "price (EUR)"),
    *("prints (h)", "prints (g)", "edge", "cable"),
)


def gallery_pages() -> Iterator[tuple[str, str]]:
    """Path and text of the page and of its pictures."""
    figures = json.loads(FILE.read_text("utf-8"))
    shown = []
    for preset in PRESETS:
        text = preset.read_text("utf-8")
        name = plain(tomllib.loads(text)["name"])
        shown.append(
            f"## {name}\n\n![Face of the finger: {name}](images/presets/{preset.stem}.svg)\n\n"
            f"{prose(about(text))}{left_out(preset)}\n\n{code(preset.relative_to(ROOT).as_posix())}\n\n"
        )
        yield f"images/presets/{preset.stem}.svg", face(preset).svg()
    stated = plain(figures["published"]["price_stated"].split(", ")[1])
    rows = [_row(preset.stem, figures[preset.stem]) for preset in PRESETS]
    yield "gallery.md", _INTRO.format(stated=stated) + table(_HEADINGS, rows) + "".join(shown)


def about(text: str) -> str:
    """The comment at the head of a parameter file, without the line for editors."""
    lines = text.partition("\n\n")[0].splitlines()
    return " ".join(line.lstrip("# ") for line in lines if not line.startswith("#:"))


def left_out(preset: Path) -> str:
    """The parts that a preset is made without, as a sentence; empty if it has all."""
    design = lumitip_fab.derived(preset)
    lacking = [part for part in ("holder", "flange") if not getattr(design, f"{part}s")]
    return f" Made without {' and '.join(lacking)}." if lacking else ""


def face(preset: Path) -> Drawing:
    """The face of a preset's receiver."""
    design = lumitip_fab.derived(preset)
    width_mm, length_mm = np.ptp(outline_points(design), axis=0)
    size_in = float(width_mm) * _INCHES_PER_MM, float(length_mm) * _INCHES_PER_MM
    return Drawing(preset.stem, "", size_in, lambda axes: paint_face(axes, design))


def _row(name: str, found: dict[str, float]) -> tuple[str, ...]:
    return (
        code(name),
        str(found["cells"]),
        f"{found['pitch_mm']:g}",
        f"{found['hole_mm']:g}",
        f"{found['current_ma']:.0f}",
        f"{found['price']:.0f}",
        f"{found['print_h']:.1f}",
        f"{found['print_g']:.0f}",
        f"{found['edge_mm']:.2f} mm, {found['edge_deg']:.1f}°",
        f"{found['cable_mm']:.2f} mm, {found['cable_deg']:.1f}°",
    )
