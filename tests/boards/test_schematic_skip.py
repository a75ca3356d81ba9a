"""A user's script reads and edits the schematics with kicad-skip."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from skip import Schematic

from lumitip_fab.boards.kicad.schematic import schematic_files
from lumitip_fab.boards.placement import place
from lumitip_fab.design import Design
from programs import needs, program

# The library catches its own warnings where they are errors, and reads on without what it warned
# of: only without that is it what a user's script meets.
pytestmark = [pytest.mark.filterwarnings("default"), pytest.mark.slow]


@pytest.fixture(params=["emitter", "receiver"])
def sheet(
    designs: Callable[[str], Design], request: pytest.FixtureRequest, tmp_path: Path
) -> tuple[dict[str, str], Path]:
    """Value of every part of a finger's board, and its schematic."""
    d = designs("small")
    finger = next(f for f in d.fingers if f.name == request.param)
    board = place(d, finger)
    for name, data in schematic_files(board, d).items():
        (tmp_path / name).write_bytes(data)
    parts = {c.ref: c.value for c in board.components if c.kind != "fiducial"}
    return parts, tmp_path / f"{finger.name}.kicad_sch"


def edit(file: Path) -> None:
    """Give a resistor another value."""
    schematic = Schematic(str(file))
    first = next(s for s in schematic.symbol if s.property.Reference.value == "R1")
    first.property.Value.value = "1k"
    schematic.write(str(file))


def values(schematic: Schematic) -> dict[str, str]:
    found = {s.property.Reference.value: s.property.Value.value for s in schematic.symbol}
    return {ref: value for ref, value in found.items() if not ref.startswith("#")}


def test_every_part_with_its_value(sheet: tuple[dict[str, str], Path]) -> None:
    wanted, file = sheet
    assert values(Schematic(str(file))) == wanted


def test_a_value_edited_and_saved(sheet: tuple[dict[str, str], Path]) -> None:
    wanted, file = sheet
    edit(file)
    assert values(Schematic(str(file))) == {**wanted, "R1": "1k"}


@needs("kicad-cli")
def test_kicad_reads_what_was_saved(sheet: tuple[dict[str, str], Path], tmp_path: Path) -> None:
    wanted, file = sheet
    edit(file)
    table = tmp_path / "parts.csv"
    fields = [
        "--fields",
        "Reference,Value",
        "--include-excluded-from-bom",
        "--string-delimiter",
        "",
    ]
    done = subprocess.run(
        [program("kicad-cli"), "sch", "export", "bom", *fields, "-o", table, file],
        check=False,
        capture_output=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    _, *rows = table.read_text(encoding="utf-8").splitlines()
    read = dict(row.split(",", 1) for row in rows)
    assert read == {**wanted, "R1": "1k"}
