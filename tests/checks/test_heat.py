"""No step heats a part beyond its material's limit: refused, and seen in what was written."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from damages import edit, excerpt
from damages import failing as failing_of
from lumitip_fab.config.load import Input, load
from lumitip_fab.derive import derive
from lumitip_fab.errors import InputError

NOTE = "mask/receiver_wrapping.md"


@pytest.fixture
def copied(outputs: Path, tmp_path: Path) -> Path:
    """The notes and the manual of the published design, to damage."""
    return excerpt(outputs, tmp_path / "told", "manual", "mask", "mould", "wiring")


def failing(folder: Path) -> set[str]:
    return failing_of(folder, "heat")


def test_nothing_fails_as_it_is_written(copied: Path) -> None:
    assert failing(copied) == set()


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        (
            NOTE,
            "No part of a finger is heated from here on.",
            "Warm it to 90 °C (hot air or an oven).",
            {"notes", "orders"},
        ),
        (
            NOTE,
            "No part of a finger is heated from here on.",
            "Warm the finger until the film is limp.",
            {"orders"},
        ),
        (NOTE, "that line alone to 90 °C", "that line alone to 130 °C", {"notes"}),
        ("mould/emitter_casting.md", "curing at 23 °C", "curing at 80 °C", {"notes"}),
        ("mould/emitter_casting.md", "Leave it for", "Bake it for", {"orders"}),
        ("wiring/cables.md", "solder them on the front", "solder them at 350 °C", {"notes"}),
        ("manual/manual.html", "<td>crease</td>", "<td>fold</td>", {"steps"}),
        ("manual/manual.html", "120 °C (film", "150 °C (film", {"steps"}),
    ],
)
def test_a_note_that_tells_to_heat_more_is_seen(
    copied: Path, file: str, old: str, new: str, expected: set[str]
) -> None:
    edit(copied / file, old, new)
    assert failing(copied) == expected


def test_a_step_beyond_a_limit_is_seen_in_the_design(copied: Path) -> None:
    file = copied / "design.json"
    told = json.loads(file.read_text(encoding="utf-8"))
    step = next(step for step in told["heat"] if step["name"] == "cure")
    step["temperature_c"] = 80.0
    file.write_text(json.dumps(told), encoding="utf-8")
    assert failing(copied) == {"limit", "steps"}


@pytest.mark.parametrize("part", ["glue", "primer", "tape", "insulation"])
def test_a_limit_below_the_cure_is_seen_in_the_design(copied: Path, part: str) -> None:
    file = copied / "design.json"
    design = json.loads(file.read_text(encoding="utf-8"))
    step = next(step for step in design["heat"] if step["name"] == "cure")
    next(each for each in step["parts"] if each["name"] == part)["limit_c"] = 22.0
    file.write_text(json.dumps(design), encoding="utf-8")
    assert failing(copied) == {"limit", "notes", "steps"}


def test_lost_notes_are_told(copied: Path) -> None:
    (copied / NOTE).unlink()
    assert failing(copied) == {"notes"}
    (copied / "manual/manual.html").unlink()
    assert failing(copied) == {"notes", "steps"}


@pytest.fixture
def published(design_dir: Path) -> Input:
    """The published parameter file."""
    return load(design_dir / "presets" / "published.toml")


def with_entry(config: Input, kind: str, name: str, **values: Any) -> Input:
    table = getattr(config.catalogue, kind)
    entry = table[name].model_copy(update=values)
    parts = config.catalogue.model_copy(update={kind: {**table, name: entry}})
    return replace(config, catalogue=parts)


@pytest.mark.parametrize(
    ("change", "field", "words"),
    [
        (
            lambda given: with_entry(given, "silicones", "Solaris", cure_c=80.0),
            "mould.silicone",
            (
                "80 °C",
                "the backing of PETG withstands 65 °C",
                "Choose a silicone that cures at a lower temperature",
            ),
        ),
        (
            lambda given: with_entry(given, "films", "TPU 100um", soften_c=125.0),
            "mask.film",
            ("125 °C", "withstands 120 °C", "Choose another film"),
        ),
    ],
)
def test_a_step_that_is_too_hot_is_refused(
    published: Input, change: Callable[[Input], Input], field: str, words: tuple[str, ...]
) -> None:
    with pytest.raises(InputError) as refusal:
        derive(change(published))
    (told,) = {p.message for p in refusal.value.problems if words[1] in p.message}
    assert all(word in told for word in words)
    assert {p.field for p in refusal.value.problems} == {field}


@pytest.mark.parametrize(
    ("kind", "name", "withstands", "remedy"),
    [
        ("adhesives", "epoxy", "glue of slow two-part epoxy", "another glue (backing.glue)"),
        (
            "primers",
            "DOWSIL PR-1200",
            "silicone primer DOWSIL PR-1200",
            "another primer (mould.primer)",
        ),
        (
            "tapes",
            "polyimide tape",
            "polyimide tape 12 mm with silicone adhesive",
            "another tape (mould.tape)",
        ),
        ("packs", "stranded wire", "insulation of stranded wire", "wires with another insulation"),
    ],
)
def test_a_cure_that_another_material_does_not_bear_is_refused(
    published: Input, kind: str, name: str, withstands: str, remedy: str
) -> None:
    with pytest.raises(InputError) as refusal:
        derive(with_entry(published, kind, name, limit_c=22.0))
    (problem,) = [p for p in refusal.value.problems if p.field == "mould.silicone"]
    for words in ("to 23 °C", f"the {withstands} withstands 22 °C", f"temperature, or {remedy}"):
        assert words in problem.message


def test_a_bendable_plate_counts_its_thread(design_dir: Path) -> None:
    flex = load(design_dir / "presets" / "flex.toml")
    with pytest.raises(InputError) as refusal:
        derive(with_entry(flex, "packs", "waxed thread", limit_c=22.0))
    (problem,) = [p for p in refusal.value.problems if p.field == "mould.silicone"]
    assert "the waxed thread withstands 22 °C" in problem.message


def test_every_material_of_the_catalogue_has_a_limit(published: Input) -> None:
    known = published.catalogue
    kinds = (known.adhesives, known.films, known.filaments, known.primers, known.silicones)
    for entry in (each for kind in (*kinds, known.tapes) for each in kind.values()):
        assert entry.limit_c > 25.0
    assert known.packs["stranded wire"].limit_c and known.packs["waxed thread"].limit_c


def test_the_finger_itself_is_heated_by_its_cure_and_its_own_leds_alone(published: Input) -> None:
    steps = derive(published).heat
    assert [s.name for s in steps if {"backing"} & {p.name for p in s.parts}] == ["cure", "use"]
    for step in steps:
        assert step.temperature_c <= step.limit_c
