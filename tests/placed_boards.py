"""Both boards of some presets, placed but without copper."""

from pathlib import Path

import shapely

from lumitip_fab.boards.model import Placement
from lumitip_fab.boards.placement import place
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Box, Component, Design, Finger

PRESETS = ("published", "asymmetric", "dense", "mux16")
FINGERS = ("emitter", "receiver")
Placed = tuple[Design, Finger, Placement]
Boards = dict[tuple[str, str], Placed]


def placed_boards(design_dir: Path) -> Boards:
    """By preset and finger."""
    found = {}
    for preset in PRESETS:
        design = derive(load(design_dir / "presets" / f"{preset}.toml"))
        for finger in design.fingers:
            found[preset, finger.name] = design, finger, place(design, finger)
    return found


def polygon(box: Box) -> shapely.Polygon:
    return shapely.box(box.x_min_mm, box.y_min_mm, box.x_max_mm, box.y_max_mm)


def parts_of(placement: Placement, kind: str) -> list[Component]:
    return [part for part in placement.components if part.kind == kind]
