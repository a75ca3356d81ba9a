"""The boards' KiCad files: cells, edge, holes, heights, copper, circuit and silkscreen."""

from collections.abc import Callable, Iterator
from pathlib import Path

import shapely

from lumitip_fab.checks.board_circuit import measure_channels, measure_connector, measure_strings
from lumitip_fab.checks.board_copper import measure_copper, measure_nets
from lumitip_fab.checks.board_place import (
    measure_cells,
    measure_heights,
    measure_holes,
    measure_outline,
)
from lumitip_fab.checks.board_read import Read
from lumitip_fab.checks.board_silk import measure_silk, measure_targets
from lumitip_fab.checks.kicad_board import read_board
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.design import Design, Finger
from lumitip_fab.errors import OutputError

READS = ("boards/*.kicad_pcb",)

Step = Callable[[Read], Iterator[Measurement]]
_BOTH: tuple[Step, ...] = (
    measure_cells, measure_outline, measure_holes, measure_heights, measure_copper, measure_nets,
    measure_connector, measure_silk, measure_targets,
)  # fmt: skip


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every figure of both boards."""
    for finger in design.fingers:
        subject = f"boards/{finger.name}/{finger.name}.kicad_pcb"
        try:
            read = Read(subject, read_board(outputs / subject), finger, design)
        except OutputError as error:
            yield unreadable("board.readable", subject, str(error))
            continue
        yield read.figure("readable", len(read.board.parts), 1, float("inf"), "parts")
        yield from _measured(read, finger)


def _measured(read: Read, finger: Finger) -> Iterator[Measurement]:
    own = measure_strings if finger.name == "emitter" else measure_channels
    for step in (*_BOTH, own):
        try:
            yield from step(read)
        except (ArithmeticError, LookupError, ValueError, shapely.errors.ShapelyError) as error:
            name = step.__name__.removeprefix("measure_")
            yield unreadable(f"board.{name}", read.subject, f"cannot be measured: {error!r:.200}")
