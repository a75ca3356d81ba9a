"""The manual's last pages name every part of every board, with the value that the board has."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip_fab.checks.readers.kicad_board import read_board
from lumitip_fab.text import runs
from manual_reader import read_html

RATING = re.compile(r", [\d.]+ V$")
HEADING = re.compile(r"Parts of the (\w+) board")


def expanded(cell: str) -> list[str]:
    """Each reference of a cell such as `R1 to R3, R7 and R8`."""
    found = []
    for run in re.split(r", | and ", cell):
        first, _, last = run.partition(" to ")
        letters = first.rstrip("0123456789")
        ends = int(first[len(letters) :]), int((last or first)[len(letters) :])
        found += [f"{letters}{n}" for n in range(ends[0], ends[1] + 1)]
    return found


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["published", "integrated", "dense"])
def test_every_part_is_listed(built: Callable[[str], Path], preset: str) -> None:
    out = built(preset)
    shown = {}
    for chapter in read_html(out / "manual/manual.html").chapters:
        if found := HEADING.fullmatch(chapter.heading):
            rows = chapter.tables[0][1:]
            values = {
                ref: RATING.sub("", value.removesuffix(" (by hand)"))
                for refs, value, _ in rows
                for ref in expanded(refs)
            }
            assert len(values) == sum(len(expanded(refs)) for refs, *_ in rows)
            shown[found[1]] = values
    assert shown == {
        path.stem: {part.ref: part.value for part in read_board(path).parts if part.bought}
        for path in out.glob("boards/*/*.kicad_pcb")
    }


@pytest.mark.parametrize(
    ("refs", "said"),
    [
        (["R1"], "R1"),
        (["R1", "R2"], "R1 and R2"),
        (["R1", "R2", "R3"], "R1 to R3"),
        (["R1", "R3", "R4", "R5", "C6"], "R1, R3 to R5 and C6"),
        (["R9", "R10", "R11"], "R9 to R11"),
        (["LED", "LED1", "LED2", "LED3"], "LED and LED1 to LED3"),
    ],
)
def test_references_that_follow_one_another_are_a_run(refs: list[str], said: str) -> None:
    assert runs(refs) == said
