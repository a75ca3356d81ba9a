"""The words on the exploded drawings of the fingers."""

import re
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
    called = {"led": "LED", "switch": "transistor", "capacitor": "bulk capacitor"}
    return {
        f"Backing, {stack.plate_mm:g} mm",
        f"Board, {stack.pcb_mm:g} mm",
        f"Silicone, {stack.silicone_mm:g} mm",
        f"Mask, {stack.film_mm:g} mm",
        *(["Interface"] if design.interfaces else []),
        f"{len(finger.connector.pads)} wires",
        f"{finger.name.capitalize()} finger, exploded",
        *(f"{kinds.count(k)} {called.get(k, k)}{'s' * (kinds.count(k) > 1)}" for k in kinds),
    }


def missing(design: Design, finger: Finger, drawing: Drawing) -> set[str]:
    """Labels that are not on a drawing."""
    return labels(design, finger) - {words for words, _ in drawing.words}


def least_gap_mm(drawing: Drawing) -> float:
    """Least distance from a line of words to the next one in its column."""
    columns = defaultdict(list)
    for _, extent in drawing.words:
        columns[round(float(extent[0, 0]), 1)].append(float(extent[0, 1]))
    return min(b - a for c in columns.values() for a, b in pairwise(sorted(c)))


def test_every_layer_and_kind_of_part_is_named(
    drawings: tuple[Design, dict[str, Drawing]],
) -> None:
    design, drawn = drawings
    assert [missing(design, f, drawn[f.name]) for f in design.fingers] == [set(), set()]


def test_no_two_lines_of_words_meet(drawings: tuple[Design, dict[str, Drawing]]) -> None:
    assert min(map(least_gap_mm, drawings[1].values())) >= LINE_MM


@pytest.mark.parametrize(
    ("old", "new"),
    [("Silicone, 1.5", "Silicone, 1.6"), ("32 photodetectors", "31 photodetectors")],
)
def test_a_wrong_label_is_seen(outputs: Path, tmp_path: Path, old: str, new: str) -> None:
    text = (outputs / "assembly/receiver_exploded.svg").read_text(encoding="utf-8")
    assert old in text
    file = tmp_path / "receiver_exploded.svg"
    file.write_text(text.replace(old, new), encoding="utf-8")
    design = read_design(outputs / "design.json")
    (lost,) = missing(design, design.receiver, read_drawing(file))
    assert lost.startswith(old)


def test_lines_that_meet_are_seen(outputs: Path, tmp_path: Path) -> None:
    text = (outputs / "assembly/receiver_exploded.svg").read_text(encoding="utf-8")
    silicone = r'( y=")(-?[\d.]+)("[^>]*>Silicone.*?<text [^>]* y=")[-\d.]+'
    moved, count = re.subn(silicone, r"\1\2\3\2", text, flags=re.DOTALL)
    assert count == 1
    (tmp_path / "moved.svg").write_text(moved, encoding="utf-8")
    assert least_gap_mm(read_drawing(tmp_path / "moved.svg")) < LINE_MM
