"""The words on the exploded drawings of the fingers."""

from collections import defaultdict
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest

from lumitip_fab.checks.readers.drawing import Drawing, read_drawing
from lumitip_fab.design import Design, Finger
from lumitip_fab.design.encoding import read_design

LINE_MM = 3.0
SLOW = [pytest.param(name, marks=pytest.mark.slow) for name in ("dense", "flex")]


@pytest.fixture(params=["published", *SLOW])
def drawings(
    request: pytest.FixtureRequest, built: Callable[[str], Path]
) -> tuple[Design, dict[str, Drawing]]:
    """A preset with the drawing of each finger."""
    folder = built(request.param)
    design = read_design(folder / "design.json")
    files = {f.name: folder / f"assembly/{f.name}_exploded.svg" for f in design.fingers}
    return design, {name: read_drawing(file) for name, file in files.items()}


def labels(design: Design, finger: Finger) -> set[str]:
    """Every label of a finger's drawing."""
    stack = design.stack
    kinds = [part.kind for part in finger.parts if part.side == "front"]
    plural = {"led": "LEDs"}
    return {
        f"Backing, {stack.plate_mm:g} mm",
        f"Board, {stack.pcb_mm:g} mm",
        f"Silicone, {stack.silicone_mm:g} mm",
        f"Film, {stack.film_mm:g} mm",
        *(["Interface"] if design.interfaces else []),
        f"{len(finger.connector.pads)} wires",
        f"{finger.name.capitalize()} finger, exploded",
        *(f"{kinds.count(k)} {plural.get(k, k + 's')}" for k in kinds),
    }


def test_every_layer_and_kind_of_part_is_named(
    drawings: tuple[Design, dict[str, Drawing]],
) -> None:
    design, drawn = drawings
    for finger in design.fingers:
        assert labels(design, finger) <= {words for words, _ in drawn[finger.name].words}


def test_no_two_lines_of_words_meet(drawings: tuple[Design, dict[str, Drawing]]) -> None:
    for drawing in drawings[1].values():
        columns = defaultdict(list)
        for _, extent in drawing.words:
            columns[round(float(extent[0, 0]), 1)].append(float(extent[0, 1]))
        gaps = [b - a for c in columns.values() for a, b in pairwise(sorted(c))]
        assert min(gaps) >= LINE_MM
