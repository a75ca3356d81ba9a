"""Speed of the boards: placement, routing, pour and files against the number of cells.

Run by `make bench`, or with numbers of cells as arguments; exits 1 if a goal is missed. Each stage
runs once before it is measured, so that its code is compiled. Wall time depends on the machine and
its load, so processor time is shown too.
"""

import math
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from common import Goals
from lumitip_fab.boards.files import finished, model_files
from lumitip_fab.boards.model import BoardModel
from lumitip_fab.boards.placement import place
from lumitip_fab.boards.pour import pour
from lumitip_fab.boards.route import route
from lumitip_fab.boards.route.wider import with_wider_tracks
from lumitip_fab.boards.verify import verify
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design, Finger
from lumitip_fab.errors import FabError

DESIGN = Path(__file__).parents[1] / "design"
LIMITS_S = {32: 15.0, 128: 120.0, 257: 400.0}
COLUMNS = {65: [7, 6] * 5, 128: [9, 8] * 7 + [9], 257: [14, 13] * 9 + [14]}
_FILE = """\
extends = "published.toml"
name = "bench {cells}"

[grid]
columns = {columns}

[emitter]
current_ma = 4.5
resistor_side = "front"

[receiver]
multiplexer = "74HC4067PW"

[controller]
board = "bench"

[supply]
max_ma = 5000
{tracks}"""
_FINE = """
[board]               # as in the dense preset
track_mm = 0.15
copper_gap_mm = 0.15
via_mm = 0.45
via_drill_mm = 0.2
channel_mm = 4.0
"""
FINE_FROM = 256  # cells from which the lines between two rows of multiplexers need fine tracks
_T = TypeVar("_T")


def design_of(cells: int) -> Design:
    """The published design with another grid."""
    if cells == 32:
        return derive(load(DESIGN / "presets" / "published.toml"))
    with tempfile.TemporaryDirectory() as name:
        presets = Path(name) / "presets"
        presets.mkdir()
        (Path(name) / "parts").symlink_to(DESIGN / "parts")
        published = (DESIGN / "presets" / "published.toml").read_text(encoding="utf-8")
        (presets / "published.toml").write_text(published, encoding="utf-8")
        file = presets / "bench.toml"
        tracks = _FINE if cells >= FINE_FROM else ""
        text = _FILE.format(cells=cells, columns=COLUMNS[cells], tracks=tracks)
        file.write_text(text, encoding="utf-8")
        return derive(load(file))


def measure(design: Design, finger: Finger, goals: Goals) -> str:
    """One row of the table: each stage once."""
    d, seconds = design, []

    def timed(stage: Callable[[], _T]) -> _T:
        begun = time.perf_counter()
        result = stage()
        seconds.append(time.perf_counter() - begun)
        return result

    busy = time.process_time()
    placement = timed(lambda: place(d, finger))
    found = timed(lambda: with_wider_tracks(placement, route(placement)))
    routing, fills, _ = timed(lambda: pour(placement, found))
    model = BoardModel(placement, routing, fills)
    timed(lambda: model_files(design, model))
    busy = time.process_time() - busy
    name, faults = f"{len(d.layout)} cells, {finger.name}", len(verify(model))
    if limit_s := LIMITS_S.get(len(d.layout)):
        goals.at_most(name, sum(seconds), limit_s, "s")
    goals.at_most(name, faults, 0, "faults")
    length = sum(math.dist(t.start, t.end) for t in routing.tracks)
    return (
        f"{len(design.layout):>6}{finger.name:>10}"
        + "".join(f"{s:>8.2f}" for s in (*seconds, sum(seconds), busy))
        + f"{len(routing.vias):>7}{length:>9.0f}{routing.iterations:>8}{faults:>8}"
    )


def main(counts: list[int]) -> int:
    """Print the table; the exit code."""
    goals = Goals()
    small = design_of(32)
    model_files(small, _board(small))  # compiles, and does late imports
    print("seconds, but for the last columns; cpu is processor time")
    print(
        f"{'cells':>6}{'board':>10}{'place':>8}{'route':>8}{'pour':>8}{'files':>8}{'all':>8}{'cpu':>8}"
        f"{'vias':>7}{'track mm':>9}{'rounds':>8}{'faults':>8}"
    )
    for cells in counts:
        design = design_of(cells)
        for finger in design.fingers:
            try:
                print(measure(design, finger, goals), flush=True)
            except FabError as fault:
                goals.not_measured(f"{cells} cells, {finger.name}", str(fault))
    return goals.exit_code()


def _board(design: Design) -> BoardModel:
    d = design
    return finished(place(d, d.emitter))


if __name__ == "__main__":
    sys.exit(main([int(a) for a in sys.argv[1:]] or [32, *COLUMNS]))
