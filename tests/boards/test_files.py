"""The files of a board as files: same bytes, whole text, frames, identifiers."""

import dataclasses
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from lumitip_fab.boards import files
from lumitip_fab.boards.files import board_files
from lumitip_fab.boards.kicad.sexpr import Quoted, number, written
from lumitip_fab.boards.model import Fill, Routing, Text, stable_uuid
from lumitip_fab.boards.outline import fractured
from lumitip_fab.boards.silk.strokes import text_strokes, upright
from lumitip_fab.checks.readers.kicad_shapes import child, children, read_nodes, words
from lumitip_fab.cli.steps import STEPS
from lumitip_fab.design import Design
from lumitip_fab.design.frames import applied
from lumitip_fab.errors import BuildError
from lumitip_fab.pipeline.workers import tasks

pytestmark = pytest.mark.slow

Designs = Callable[[str], Design]
AGAIN = """
import hashlib, sys
from pathlib import Path
from lumitip_fab.boards.files import board_files
from lumitip_fab.design.encoding import read_design
from lumitip_fab.cli.steps import STEPS
from lumitip_fab.pipeline.workers import tasks
for task in tasks(STEPS, read_design(Path(sys.argv[1]))):
    if task.name == "finger_board.emitter":
        for made in board_files(task.design, *task.item):
            print(hashlib.sha256(made.data).hexdigest(), made.path)
"""


def test_the_same_design_gives_the_same_bytes(boards: Callable[[str], Path]) -> None:
    folder = boards("small")
    told = []
    for seed in ("1", "2"):
        command = [sys.executable, "-c", AGAIN, str(folder / "design.json")]
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        done = subprocess.run(command, env=environment, capture_output=True, check=True, text=True)
        told.append(done.stdout)
    assert told[0] == told[1]
    paths = {line.split()[1] for line in told[0].splitlines()}
    files = (f for f in (folder / "boards" / "emitter").rglob("*") if f.is_file())
    assert paths == {f.relative_to(folder).as_posix() for f in files}


def test_a_board_file_is_moved_into_the_sensor_frame(designs: Designs) -> None:
    design = designs("small")
    task = next(t for t in tasks(STEPS, design) if t.name == "finger_board.emitter")
    made = {a.path.rpartition("/")[2]: a for a in board_files(task.design, *task.item)}
    board = made["emitter.kicad_pcb"]
    at = re.search(rb"\(at (\S+) (\S+) \S+\)(?=[^@]{0,300}?reference \"D1\")", board.data)
    assert at
    x, y, z = applied(board.to_sensor, np.array([[float(at[1]), float(at[2])]]))[0]
    assert (x, y) == pytest.approx(design.emitter.cells[0], abs=1e-6)
    assert z == pytest.approx(design.stack.rim_z_mm)
    assert made["emitter_front.png"].frame == ""


@pytest.mark.parametrize("finger", ["emitter", "receiver"])
def test_identifiers_are_used_once(boards: Callable[[str], Path], finger: str) -> None:
    text = (boards("small") / f"boards/{finger}/{finger}.kicad_pcb").read_text()
    found = re.findall(r"\(tstamp ([0-9a-f-]{36})\)", text)
    assert len(found) > 500
    assert len(set(found)) == len(found)


@pytest.mark.parametrize("board", ["emitter", "receiver", "breakout", "flange"])
def test_footprints_have_the_fields_of_their_symbols(
    boards: Callable[[str], Path], board: str
) -> None:
    file = boards("small") / f"boards/{board}/{board}.kicad_pcb"
    parts = {
        (words(child(part, "path"))[0], *words(field))
        for part in children(read_nodes(file), "footprint")
        for field in children(part, "property")
    }
    symbols = {
        (f"/{words(child(symbol, 'uuid'))[0]}", *words(field))
        for symbol in children(read_nodes(file.with_suffix(".kicad_sch")), "symbol")
        for field in children(symbol, "property")
    }
    assert parts == {field for field in symbols if field[1] in ("Manufacturer", "MPN")} != set()


def test_identifiers_never_change() -> None:
    assert stable_uuid("receiver", "symbol", "U1") == "a239dece-9245-5ca3-bacb-4514ff64d59e"


def test_numbers_keep_a_nanometre() -> None:
    told = [number(v) for v in (0.1 + 0.2, -1e-9, 0, 12.0, 150.123456, -0.000001)]
    assert told == ["0.3", "0", "0", "12", "150.123456", "-0.000001"]


def test_text_comes_back_as_it_was_written(tmp_path: Path) -> None:
    node = ("a", Quoted('with "quotes" and \\ and (brackets)'), ("b", 1.5, Quoted("")))
    (tmp_path / "a").write_text(written(node))
    assert read_nodes(tmp_path / "a") == [
        "a",
        'with "quotes" and \\ and (brackets)',
        ["b", "1.5", ""],
    ]


discs = st.tuples(st.floats(2, 18), st.floats(2, 18), st.floats(0.2, 3))


@given(st.lists(discs, max_size=12))
def test_one_line_goes_round_an_area_with_holes(holes: list[tuple[float, float, float]]) -> None:
    taken = shapely.union_all([shapely.Point(x, y).buffer(r, quad_segs=4) for x, y, r in holes])
    for area in shapely.get_parts(shapely.box(0, 0, 20, 20) - taken):
        line = np.array(fractured(area))
        following = np.roll(line, -1, axis=0)
        enclosed = (line[:, 0] * following[:, 1] - following[:, 0] * line[:, 1]).sum() / 2
        assert enclosed == pytest.approx(-area.area, abs=1e-3)  # clockwise, as KiCad 6 wants it
        assert shapely.Polygon(line).buffer(0).symmetric_difference(area).area < 1e-3


def test_text_is_read_from_its_own_side() -> None:
    assert [upright(a, "front") for a in (0, 90, 180, 270, -90)] == [0, 90, 0, 90, 90]
    assert [upright(a, "back") for a in (0, 90, 180, 270, -90)] == [0, -90, 0, -90, -90]
    letter = Text("L", 0, 0, 1.0, 0.1)
    front, back = (
        np.concatenate([s.points for s in text_strokes("L", letter, (0, 0), 0, side)])
        for side in ("front", "back")
    )
    assert back == pytest.approx(front * (-1, 1))
    corner = front[np.lexsort((front[:, 0], front[:, 1]))[0]]
    assert corner[0] == front[:, 0].min()  # the foot of an L begins at the left


def test_a_board_that_lost_a_track_is_never_written(
    designs: Designs, monkeypatch: pytest.MonkeyPatch
) -> None:
    (task,) = (t for t in tasks(STEPS, designs("small")) if t.name == "finger_board.emitter")
    pour = files.pour

    def losing(*arguments: Any) -> tuple[Routing, tuple[Fill, ...], frozenset[tuple[str, str]]]:
        routing, fills, solid = pour(*arguments)
        kept = tuple(t for t in routing.tracks if t.net != "S1_1")
        assert kept != routing.tracks
        return dataclasses.replace(routing, tracks=kept), fills, solid

    monkeypatch.setattr(files, "pour", losing)
    with pytest.raises(BuildError, match=r"emitter board breaks its rules:\nnet S1_1 is in pieces"):
        board_files(task.design, *task.item)
