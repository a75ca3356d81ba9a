"""Whole studies: figures, refusals, going on after a stop, local workers and a cluster."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip_fab.cli import main
from lumitip_fab.config.load import Input, load
from lumitip_fab.derive import derive, resolve
from lumitip_fab.errors import InputError, OutputError
from lumitip_fab.explore import report
from lumitip_fab.explore.accuracy import Sample, accuracy
from lumitip_fab.explore.evaluate import NAME, Job, Journal, bill, cost, evaluate
from lumitip_fab.explore.run import Found, Study, explore
from lumitip_fab.explore.vary import changed

FEW = Sample(fingers=1, poses=3)
# The third hole leaves no web between apertures, so two of the six are refused.
TEXTS = ("grid.pitch_mm=5,6", "mask.hole_mm=1.5,2.5,5.9")
Explored = Callable[..., Study]


def silent(*_: int) -> None:
    """No progress is shown."""


@pytest.fixture(scope="module")
def config(design_dir: Path) -> Input:
    return load(design_dir / "fingertip.toml")


@pytest.fixture(scope="module")
def explored(design_dir: Path) -> Explored:
    """`explored(out)`: a study of six designs."""

    def run(out: Path, scheduler: str | None = None, sample: Sample = FEW) -> Study:
        file = design_dir / "fingertip.toml"
        return explore(file, TEXTS, out, 6, False, sample, scheduler, silent)

    return run


@pytest.fixture(scope="module")
def studied(explored: Explored, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Study]:
    """A study that local workers did, written."""
    out = tmp_path_factory.mktemp("study")
    study = explored(out)
    report.write(study, out)
    return out, study


def _files(folder: Path) -> dict[str, bytes]:
    return {f.name: f.read_bytes() for f in sorted(folder.iterdir()) if f.name != NAME}


@pytest.mark.slow
def test_every_design_has_figures_or_the_reasons_why_it_is_refused(
    studied: tuple[Path, Study],
) -> None:
    out, study = studied
    assert [bool(found.refused) for found in study.designs] == [False, False, True] * 2
    assert study.designs[2].refused[0].startswith("mask.hole_mm is 5.9")
    assert study.evaluated == 6
    rows = list(csv.DictReader((out / "designs.csv").read_text(encoding="utf-8").splitlines()))
    told = json.loads((out / "designs.json").read_text(encoding="utf-8"))
    assert [row["mask.hole_mm"] for row in rows] == ["1.5", "2.5", "5.9"] * 2
    assert [row["refused"] != "" for row in rows] == [False, False, True] * 2
    for row, design, found in zip(rows, told["designs"], study.designs, strict=True):
        assert design["refused"] == list(found.refused)
        if found.figures:
            assert float(row["error_mm"]) == design["error_mm"] == found.figures["error_mm"]
            assert (row["cells"], row["columns"]) == ("32.0", "5 4 5 4 5 4 5")
    assert (out / "pareto.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
def test_what_is_known_is_not_evaluated_again(
    explored: Explored, studied: tuple[Path, Study], tmp_path: Path
) -> None:
    done = (studied[0] / NAME).read_bytes().splitlines(keepends=True)
    # Stopped while the fifth line was written.
    (tmp_path / NAME).write_bytes(b"".join(done[:4]) + done[4][:40])
    study = explored(tmp_path)
    assert study.evaluated == 2
    assert study.designs == studied[1].designs
    assert len((tmp_path / NAME).read_bytes().splitlines()) == 6
    report.write(study, tmp_path)
    assert _files(tmp_path) == _files(studied[0])
    assert explored(tmp_path).evaluated == 0


KILLED = f"""
import sys
from pathlib import Path
from lumitip_fab.explore.accuracy import Sample
from lumitip_fab.explore.run import explore
if __name__ == "__main__":
    explore(Path(sys.argv[1]), {TEXTS!r}, Path(sys.argv[2]), 6, False, Sample(1, 3), None, print)
"""


@pytest.mark.slow
def test_a_killed_study_goes_on(
    explored: Explored, studied: tuple[Path, Study], design_dir: Path, tmp_path: Path
) -> None:
    program, out = tmp_path / "killed.py", tmp_path / "out"
    program.write_text(KILLED, encoding="utf-8")
    journal, deadline = out / NAME, time.monotonic() + 300.0
    told = [sys.executable, str(program), str(design_dir / "fingertip.toml"), str(out)]
    with subprocess.Popen(told, stdout=subprocess.DEVNULL, start_new_session=True) as victim:
        while not (journal.exists() and journal.read_bytes().count(b"\n")):
            assert time.monotonic() < deadline
            time.sleep(0.02)
        os.killpg(victim.pid, signal.SIGKILL)
    known = journal.read_bytes().count(b"\n")
    study = explored(out)
    assert study.evaluated == 6 - known
    assert study.designs == studied[1].designs


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_a_cluster_of_two_workers_finds_the_same(
    cluster: str, explored: Explored, studied: tuple[Path, Study], tmp_path: Path
) -> None:
    assert cluster.startswith("tcp://")
    study = explored(tmp_path, cluster)
    assert study.evaluated == 6
    report.write(study, tmp_path)
    assert _files(tmp_path) == _files(studied[0])


def test_a_scheduler_that_does_not_answer_is_told(explored: Explored, tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    with pytest.raises(OutputError, match="no scheduler answers there"):
        explored(tmp_path, "nonsense://127.0.0.1:1")


def test_another_seed_or_price_is_evaluated_anew(config: Input) -> None:
    prices = config.catalogue.prices
    one = Job.of(config, (), prices, FEW)
    assert one.key == Job.of(config, (), prices, FEW).key
    dearer = prices.model_copy(update={"each": {**prices.each, "0603": 9.0}})
    wider = changed(config, (("mask.hole_mm", 3.0),))
    others = [
        Job.of(config, (), prices, Sample(1, 3, seed=1)),
        Job.of(config, (), dearer, FEW),
        Job.of(wider, (), prices, FEW),
    ]
    assert len({one.key, *(job.key for job in others)}) == 4


def test_a_design_whose_cells_are_too_few_for_a_pose_is_refused(config: Input) -> None:
    few = changed(
        config,
        (
            ("grid.columns", (2, 1)),
            ("emitter.resistor", "1206"),
            ("emitter.resistor_side", "front"),
            ("emitter.current_ma", 6.0),
        ),
    )
    (told,) = evaluate(Job.of(few, (), config.catalogue.prices, FEW))["refused"]
    assert told.startswith("grid.columns: layout has 3 cells; a pose needs at least 4")


@pytest.mark.slow
def test_figures_are_those_of_the_design(config: Input) -> None:
    prices, design = config.catalogue.prices, derive(config)
    config = resolve(config).config
    told = evaluate(Job.of(config, (), prices, FEW))["figures"]
    assert (told["cells"], told["current_ma"]) == (32, pytest.approx(57.7, abs=1.0))
    needed = bill(config, design)
    assert needed["15406085BA300"] == needed["SML-H10TBT86"] == 32
    assert needed["74HC4051PW"] == needed["100nF 0603"] == 4
    strings = len(design.wiring.strings)
    assert (needed["LT3092"], needed["4x0603"]) == (strings, 32 / 4)
    assert needed["0603"] == 2 * strings + 1  # at the sources, and at the gate of the switch
    free = prices.model_copy(update={"each": {**prices.each, "15406085BA300": 0.0}})
    led = prices.each["15406085BA300"]
    assert cost(config, design, prices) - cost(config, design, free) == pytest.approx(32 * led)


@pytest.mark.slow
def test_a_finer_grid_sees_better(config: Input) -> None:
    errors = [
        accuracy(derive(changed(config, (("grid.pitch_mm", pitch),))).layout, Sample(2, 15))
        for pitch in (5.0, 8.0)
    ]
    assert errors[0]["error_mm"] < errors[1]["error_mm"]
    assert errors[0]["bound_mm"] < errors[1]["bound_mm"]
    assert errors[0]["bound_mm"] < errors[0]["error_mm"]


def test_the_front_has_what_nothing_is_better_than() -> None:
    def found(error: float, cells: float, size: float = 1.0) -> Found:
        figures = {
            "error_mm": error,
            "cells": cells,
            "cost": 1.0,
            "current_ma": 1.0,
            "grid_cm2": size,
        }
        return Found((), (), figures, ())

    designs = [
        found(1.0, 30.0),
        found(0.5, 60.0),
        found(1.1, 30.0),
        found(1.1, 30.0, 2.0),
        Found((), (), {}, ("refused",)),
        found(0.5, 60.0),
    ]
    assert report.front(designs) == {0, 1, 3, 5}


def test_lines_that_are_no_records_are_passed_over(tmp_path: Path) -> None:
    (tmp_path / NAME).write_bytes(b'nonsense\n[]\n{"key": 3}\n{"key": "a", "refused": ["x"]}\nhalf')
    with Journal(tmp_path) as journal:
        assert list(journal.known) == ["a"]
        journal.add({"key": "b", "figures": {}})
    with Journal(tmp_path) as journal:
        assert set(journal.known) == {"a", "b"}


def test_a_part_without_a_price_and_a_doubled_grid_are_refused(
    design_dir: Path, tmp_path: Path
) -> None:
    parts = tmp_path / "parts"
    parts.mkdir()
    text = (design_dir / "parts" / "prices.toml").read_text(encoding="utf-8")
    (parts / "prices.toml").write_text(text.replace('"0603" = 0.01\n', ""), encoding="utf-8")
    file = tmp_path / "mine.toml"
    file.write_bytes((design_dir / "fingertip.toml").read_bytes())
    with pytest.raises(InputError) as caught:
        explore(file, ["grid.columns=[[5, 4]]"], tmp_path / "out", 6, True, FEW, None, print)
    assert "has no price of '0603'" in str(caught.value)
    assert "grid.columns: and --keep-size exclude each other" in str(caught.value)
    (parts / "prices.toml").write_text('currency = "euro"\ndated = 3\n', encoding="utf-8")
    with pytest.raises(InputError) as caught:
        explore(file, TEXTS, tmp_path / "out", 6, True, FEW, None, print)
    assert {p.field for p in caught.value.problems} >= {"currency", "dated", "each", "board"}
    assert not (tmp_path / "out").exists()


def test_the_command_refuses_with_every_fault(
    design_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    told = main(
        [
            "explore",
            str(design_dir / "fingertip.toml"),
            "--out",
            str(tmp_path / "out"),
            "--vary",
            "grid.pitch=3:8",
            "--vary",
            "mask.hole_mm=8:1",
        ]
    )
    assert told == 2
    assert capsys.readouterr().err.count("--vary: ") == 2


def test_pictures_of_an_earlier_study_are_removed_if_all_designs_are_refused(
    tmp_path: Path,
) -> None:
    for name in ("pareto.svg", "pareto.png", "mine.png"):
        (tmp_path / name).write_bytes(b"old")
    report.write(Study((), (Found((), (5, 4), {}, ("too wide",)),), "EUR", 1), tmp_path)
    assert {f.name for f in tmp_path.iterdir()} == {"designs.csv", "designs.json", "mine.png"}
