"""Lines of the boards' bills of materials that a manufacturer or LCSC has a number for."""

from collections.abc import Iterator
from pathlib import Path

from lumitip_fab.checks.readers.tables import table
from lumitip_fab.design import Design, Fab
from lumitip_fab.docs.outside import Row
from lumitip_fab.errors import OutputError


def part_number_rows(out: Path, design: Design) -> Iterator[Row]:
    """A row for each board and one for all, from the bill of materials for a fab that asks for both
    numbers; none where no fab does.

    Raises:
        OutputError: if a bill of materials cannot be read.
    """
    fab = next((f for f in design.fabs if {"part", "lcsc"} <= {field for _, field in f.bom}), None)
    if fab is None:
        return
    boards = [f.name for f in design.fingers] + [a.name for a in design.auxiliary_boards]
    lines = {board: _lines(out, board, fab) for board in boards}
    for board in boards:
        yield _row(f"part numbers of the {board} board", lines[board])
    yield _row("part numbers of all boards", [line for each in lines.values() for line in each])


def _row(quantity: str, lines: list[tuple[str, str]]) -> Row:
    """Counts of lines as pairs of order number and LCSC number."""
    known, at_lcsc = (sum(bool(line[i]) for line in lines) for i in (0, 1))
    missing = sorted({part for part, number in lines if not number})
    return Row(
        quantity,
        "not stated",
        f"{known} of {len(lines)} lines, {at_lcsc} with LCSC's ({_percent(at_lcsc, len(lines))} %)",
        f"LCSC numbers are not known for {', '.join(missing)}" if missing else "all are known",
    )


def _percent(count: int, total: int) -> int:
    return 100 * count // total if total else 100


def _lines(out: Path, board: str, fab: Fab) -> list[tuple[str, str]]:
    heading = {field: name for name, field in fab.bom}
    path = out / "boards" / board / "order" / f"{fab.name}_{board}_bom.csv"
    try:
        rows = table(path.read_text(encoding="utf-8"))
        return [(row[heading["part"]], row[heading["lcsc"]]) for row in rows]
    except (OSError, ValueError, KeyError) as error:
        raise OutputError(f"{path}: cannot be read: {error}. Run lumitip-fab build.") from error
