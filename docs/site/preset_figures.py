"""Build the default design and every preset, and write their figures into `preset_figures.json`,
which the gallery shows.

python docs/site/preset_figures.py           # all of them, about half an hour on two cores
python docs/site/preset_figures.py dense     # this one; the figures of the others stay
"""

import json
import math
import sys
import tempfile
from pathlib import Path
from typing import Any

import lumitip_fab
from lumitip_fab.design import Design
from lumitip_fab.site.folder import Folder
from lumitip_fab.site.tables import prints, totals
from lumitip_fab.solve.information import USUAL, expected
from repository_pages import ROOT

PRESETS = [ROOT / "design/fingertip.toml", *sorted((ROOT / "design/presets").glob("*.toml"))]
"""The default design, and the presets."""
FILE = Path(__file__).with_name("preset_figures.json")


def main(names: list[str]) -> None:
    """Measure the presets of these names, all if there are none."""
    known = [preset.stem for preset in PRESETS]
    if unknown := sorted(set(names) - set(known)):
        sys.exit(f"the preset is {unknown[0]!r}; known are {', '.join(known)}")
    figures = json.loads(FILE.read_text("utf-8")) if FILE.exists() else {}
    for name in names or known:
        figures[name] = measured(name)
        text = json.dumps({n: figures[n] for n in known if n in figures}, indent=1)
        FILE.write_text(text + "\n", "utf-8")
        print(name, figures[name], flush=True)


def measured(name: str) -> dict[str, Any]:
    """Figures of a preset, built in a temporary folder."""
    (file,) = (preset for preset in PRESETS if preset.stem == name)
    with tempfile.TemporaryDirectory() as out:
        lumitip_fab.build(file, out)
        return {**drawn(lumitip_fab.derived(file)), **built(Path(out))}


def drawn(design: Design) -> dict[str, Any]:
    """Figures that need no build: cells, pitch and hole (mm), LED current (mA), and the expected
    rms errors of edges and cables (mm and degrees) with optics and gains unknown."""
    layout = design.layout
    errors = expected(layout, USUAL).rms()
    return {
        "cells": len(layout),
        "pitch_mm": layout.pitch_mm,
        "hole_mm": layout.optics.hole_mm,
        "current_ma": round(math.fsum(design.wiring.current_ma), 1),
        **{figure: round(error, 3) for figure, error in errors.items()},
    }


def built(out: Path) -> dict[str, Any]:
    """Figures of an output folder: price of a pair, and estimated hours and grams of all prints."""
    folder = Folder.of(out)
    parts = prints(folder)
    price, _, stated = totals(folder)
    return {
        "price": round(price, 2),
        "price_stated": stated,
        "print_h": round(math.fsum(part.number * part.minutes for part in parts) / 60, 1),
        "print_g": round(math.fsum(part.number * part.grams for part in parts), 1),
    }


if __name__ == "__main__":
    main(sys.argv[1:])
