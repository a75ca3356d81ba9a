"""How many lines of the boards' lists have numbers to order by."""

import math
from collections.abc import Iterator
from pathlib import Path

from lumitip_fab.checks.board_read import names_of
from lumitip_fab.checks.readers.tables import table
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.design import Design, Fab
from lumitip_fab.errors import OutputError

_FILE = "bom.csv"
_NUMBERED = 95.0
"""Percent of the boards' lines with a manufacturer and its order number, at least."""


def measure_numbers(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Share of the boards' lines with a manufacturer and its number, and with LCSC's number, in
    the written lists for the first PCB fab that asks for each. A part that LCSC does not sell is
    reported, and does not fail."""
    for check, fields, least in (
        ("bom.numbered", ("manufacturer", "part"), _NUMBERED),
        ("bom.lcsc", ("part", "lcsc"), -math.inf),
    ):
        fab = next((f for f in design.fabs if {*fields} <= {field for _, field in f.bom}), None)
        if fab is None:
            continue
        paths = [f"boards/{n}/order/{fab.name}_{n}_bom.csv" for n in names_of(design)]
        try:
            lines = [line for path in paths for line in _fields(outputs / path, fab, fields)]
        except OutputError as error:
            yield unreadable(check, _FILE, str(error))
            continue
        known = [line for line in lines if all(text not in ("", "any") for text in line.values())]
        without = sorted({line["part"] or "a line" for line in lines if line not in known})
        note = f"{len(known)} of {len(lines)} lines of the boards"
        note += f"; not {', '.join(without[:4])}" if without else ""
        share = 100 * len(known) / len(lines) if lines else 100.0
        yield Measurement(check, "boards/*/order", share, least, math.inf, "%", note)


def _fields(path: Path, fab: Fab, fields: tuple[str, ...]) -> list[dict[str, str]]:
    """Some fields of each line of a list for a PCB fab."""
    heading = {field: head for head, field in fab.bom}
    try:
        rows = table(path.read_text(encoding="utf-8"))
        return [{field: row[heading[field]].strip() for field in fields} for row in rows]
    except (OSError, ValueError, KeyError) as error:
        raise OutputError(f"{path}: cannot be read: {error!r:.120}") from error
