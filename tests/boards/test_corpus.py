"""Random boards of small grids: routed, and clean by the rules that KiCad ships with."""

import dataclasses
from pathlib import Path

import pytest

from acceptance.trial import fill
from corpus.draw import board_design
from corpus.trial import stock_errors, try_boards
from lumitip_fab.boards.files import finished
from lumitip_fab.boards.model import Routing, Track
from programs import needs
from small_boards import crossing

pytestmark = [pytest.mark.slow, needs("kicad-cli")]
MOST_CELLS, DESIGNS, SEED = 48, 3, 7


def test_random_boards_are_routed_and_clean(tmp_path: Path) -> None:
    fill(tmp_path)
    drawn = (board_design(SEED, i) for i in range(1000))
    small = (d for d in drawn if sum(d.edits["grid.columns"]) <= MOST_CELLS)
    for design in (next(small) for _ in range(DESIGNS)):
        file = tmp_path / f"{design.name}.toml"
        file.write_text(design.text, encoding="utf-8")
        trial = try_boards(file, kicad=True)
        assert not (trial.refusals or trial.crash), design.text
        assert [b.unrouted or b.faults for b in trial.boards] == [(), ()], design.text


def test_kicad_finds_what_is_damaged() -> None:
    model = finished(crossing())
    before = set(stock_errors(model, 1.6))
    tracks, vias = model.routing.tracks, model.routing.vias

    def found(routing: Routing) -> set[str]:
        return set(stock_errors(dataclasses.replace(model, routing=routing), 1.6)) - before

    signals = tuple(t for t in tracks if t.net != "3V3")
    assert found(Routing(signals, vias, 1)) == {"kicad unconnected"}
    (x, y), own = signals[0].start, signals[0].net
    other = next(t.net for t in signals if t.net != own)
    across = Track(other, signals[0].side, (x - 0.5, y - 0.5), (x + 0.5, y + 0.5), 0.2)
    shorts = {"kicad shorting_items", "kicad tracks_crossing"}
    assert shorts & found(Routing((*tracks, across), vias, 1))
