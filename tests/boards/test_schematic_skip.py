"""A user's script reads and edits the schematics with kicad-skip."""

from collections.abc import Callable
from pathlib import Path

import pytest
from skip import Schematic

from lumitip_fab.boards.placement import place
from lumitip_fab.boards.schematic import schematic_files
from lumitip_fab.design import Design


@pytest.fixture(params=["emitter", "receiver"])
def sheet(
    designs: Callable[[str], Design], request: pytest.FixtureRequest, tmp_path: Path
) -> tuple[dict[str, str], Path]:
    """Value of every part of a finger's board, and its schematic."""
    d = designs("small")
    finger = next(f for f in d.fingers if f.name == request.param)
    board = place(d.title, d.reading, d.board, finger, d.wiring, d.packages, d.rules)
    for name, data in schematic_files(board, d.wiring, d.packages).items():
        (tmp_path / name).write_bytes(data)
    parts = {c.ref: c.value for c in board.components if c.kind != "fiducial"}
    return parts, tmp_path / f"{finger.name}.kicad_sch"


def values(schematic: Schematic) -> dict[str, str]:
    found = {s.property.Reference.value: s.property.Value.value for s in schematic.symbol}
    return {ref: value for ref, value in found.items() if not ref.startswith("#")}


def test_every_part_with_its_value(sheet: tuple[dict[str, str], Path]) -> None:
    wanted, file = sheet
    assert values(Schematic(str(file))) == wanted


def test_a_value_edited_and_saved(sheet: tuple[dict[str, str], Path]) -> None:
    wanted, file = sheet
    schematic = Schematic(str(file))
    first = next(s for s in schematic.symbol if s.property.Reference.value == "R1")
    first.property.Value.value = "1k"
    schematic.write(str(file))
    assert values(Schematic(str(file))) == {**wanted, "R1": "1k"}
