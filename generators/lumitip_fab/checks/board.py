"""The boards' KiCad files: cells, edge, holes, heights, copper, circuit and silkscreen."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeVar

import shapely

from lumitip_fab.checks.board_carrier import (
    measure_edge,
    measure_hot_loop,
    measure_joined,
    measure_keep_outs,
    measure_lands,
    measure_names,
    measure_screws,
    measure_supplies,
)
from lumitip_fab.checks.board_circuit import measure_channels, measure_connector, measure_strings
from lumitip_fab.checks.board_contacts import measure_contact_map
from lumitip_fab.checks.board_copper import measure_copper, measure_nets
from lumitip_fab.checks.board_flex import measure_flexible
from lumitip_fab.checks.board_place import (
    measure_cells,
    measure_heights,
    measure_holes,
    measure_outline,
)
from lumitip_fab.checks.board_read import Read, ReadCarrier, read_all
from lumitip_fab.checks.board_silk import measure_silk, measure_targets
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.design import Design

READS = ("boards/*.kicad_pcb",)

_Any = TypeVar("_Any", Read, ReadCarrier)
_OF_FINGERS: tuple[Callable[[Read], Iterator[Measurement]], ...] = (
    measure_cells, measure_outline, measure_holes, measure_heights, measure_copper, measure_nets,
    measure_connector, measure_silk, measure_targets, measure_flexible,
)  # fmt: skip
_OF_CARRIERS: tuple[Callable[[ReadCarrier], Iterator[Measurement]], ...] = (
    measure_edge, measure_screws, measure_lands, measure_names, measure_copper, measure_nets,
    measure_joined, measure_supplies, measure_hot_loop, measure_keep_outs,
    measure_contact_map,
)  # fmt: skip


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every figure of every board."""
    for subject, read in read_all(outputs, design):
        if isinstance(read, str):
            yield unreadable("board.readable", subject, read)
            continue
        yield read.figure("readable", len(read.board.parts), 1, float("inf"), "parts")
        if isinstance(read, ReadCarrier):
            yield from _measured(read, _OF_CARRIERS)
        else:
            own = measure_strings if read.name == "emitter" else measure_channels
            yield from _measured(read, (*_OF_FINGERS, own))


def _measured(
    read: _Any, steps: "tuple[Callable[[_Any], Iterator[Measurement]], ...]"
) -> Iterator[Measurement]:
    for step in steps:
        try:
            yield from step(read)
        except (ArithmeticError, LookupError, ValueError, shapely.errors.ShapelyError) as error:
            name = step.__name__.removeprefix("measure_")
            yield unreadable(f"board.{name}", read.subject, f"cannot be measured: {error!r:.200}")
