"""A mutant in a folder: the manifest is right, the checks find it, and the folder is as before."""

import json
from collections import Counter
from hashlib import sha256
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.checks import layout
from lumitip_fab.pipeline import manifest
from mutations import sample
from mutations.damage import Mutant
from mutations.formats import artefact
from mutations.sample import Equivalent, drawn, files_of, made
from mutations.trial import board_of, damaged, tried

COUNT, SEED = 40, 1
LEAST_CAUGHT = 36
"""Of them. It may only rise."""


def _hashes(out: Path) -> dict[str, str]:
    files = (p for p in out.rglob("*") if p.is_file())
    return {str(p): sha256(p.read_bytes()).hexdigest() for p in files}


@pytest.fixture
def small(outputs: Path, tmp_path: Path) -> Path:
    """An output folder with a manifest of two files."""
    record = json.loads((outputs / "manifest.json").read_text())
    names = ("layout.json", "design.json")
    record["files"] = {name: record["files"][name] for name in names if name in record["files"]}
    for name in names:
        (tmp_path / name).write_bytes((outputs / name).read_bytes())
    (tmp_path / "manifest.json").write_text(json.dumps(record))
    return tmp_path


@pytest.mark.parametrize("kind", ["number", "remove", "lose", "stray"])
def test_the_manifest_is_made_right_and_the_folder_put_back(small: Path, kind: str) -> None:
    before = _hashes(small)
    mutant = next(_some(small, "layout.json", kind))
    with damaged(small, mutant):
        assert _hashes(small) != before
        assert manifest.read(small).intact(small)
        assert ("layout.json" in manifest.read(small).files) == (kind != "lose")
    assert _hashes(small) == before


def _some(out: Path, path: str, kind: str) -> Any:
    for seed in range(40):
        try:
            yield made(out, path, kind, seed)
        except sample.NotApplicableError:
            continue


def test_a_damaged_manifest_stays_damaged(small: Path) -> None:
    mutant = next(_some(small, "manifest.json", "truncate"))
    with damaged(small, mutant):
        assert not manifest.read(small).files


def test_a_check_that_stops_has_caught_nothing(
    small: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(*_: object) -> None:
        raise ZeroDivisionError("by a pitch of 0")

    monkeypatch.setattr(layout, "measure", stop)
    trial = tried(small, next(_some(small, "layout.json", "number")))
    assert trial.crash.startswith("ZeroDivisionError: by a pitch of 0 (test_trial.py:")
    assert not trial.caught


def test_a_design_that_is_refused_is_caught(small: Path) -> None:
    trial = tried(small, next(_some(small, "design.json", "truncate")))
    assert trial.caught
    assert trial.failed[0].startswith("design: ")


@pytest.mark.parametrize(
    ("paths", "board"),
    [
        (["boards/emitter/order/a.zip"], "emitter"),
        (["boards/emitter/a.csv", "boards/flange/a.csv"], ""),
        (["boards/models/a.step"], ""),
        (["mask/a.pdf"], ""),
    ],
)
def test_of_a_file_of_one_board_that_board_alone_is_measured(paths: list[str], board: str) -> None:
    assert board_of(paths) == board


def test_every_artefact_has_its_share(outputs: Path) -> None:
    paths = [
        p for p in files_of(outputs) if p.startswith(("wiring/", "firmware/", "boards/models"))
    ]
    count = 3 * len({artefact(p) for p in paths})
    mutants = [drawn(outputs, paths, 5, number) for number in range(count)]
    assert set(Counter(artefact(m.path) for m in mutants).values()) == {3}
    assert [drawn(outputs, paths, 5, number) for number in range(count)] == mutants


def test_a_damage_that_nobody_can_see_is_not_drawn(
    outputs: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rule = Equivalent("wiring/*", "[!t]*", "*", "of a test")
    monkeypatch.setattr(sample, "equivalents", lambda: (rule,))
    mutants = [drawn(outputs, ["wiring/cables.csv"], 1, number) for number in range(10)]
    assert {m.kind for m in mutants} == {"truncate"}


def test_every_equivalent_damage_has_a_reason() -> None:
    assert all(e.reason for e in sample.equivalents())


@pytest.mark.slow
def test_a_sample_of_damages_is_caught(damaged: Path) -> None:
    """`make bench` tries 2,000."""
    paths = files_of(damaged)
    trials = [tried(damaged, drawn(damaged, paths, SEED, number)) for number in range(COUNT)]
    missed = [f"{t.path} {t.kind!r} {t.seed}: {t.description}" for t in trials if not t.caught]
    assert [t.crash for t in trials if t.crash] == []
    assert COUNT - len(missed) >= LEAST_CAUGHT, "\n".join(missed)


def test_a_mutant_is_named_by_path_kind_and_seed(outputs: Path) -> None:
    mutant = drawn(outputs, files_of(outputs, "wiring/*"), 3, 4)
    assert isinstance(mutant, Mutant)
    assert made(outputs, mutant.path, mutant.kind, mutant.seed) == mutant
