"""The clamp: where it stands, what it presses with, and when there is none."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lumitip_fab.checks.mould_note import measure_note
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.clamp import torsion_mm4
from lumitip_fab.design.encoding import read_design
from lumitip_fab.docs.casting import casting_note, open_back, silicone_mix
from lumitip_fab.parts import clamp as parts

Write = Callable[[str], Path]


@pytest.fixture
def changed(design_dir: Path, tmp_path: Path) -> Callable[..., Design]:
    """The published design with some lines added, and with files of its own in `parts`."""

    def of(text: str = "", **tables: str) -> Design:
        file = tmp_path / "presets" / "changed.toml"
        file.parent.mkdir(exist_ok=True)
        for name in ("published.toml", "flex.toml"):
            (file.parent / name).write_bytes((design_dir / "presets" / name).read_bytes())
        (tmp_path / "parts").mkdir(exist_ok=True)
        for name, table in tables.items():
            (tmp_path / "parts" / f"{name}.toml").write_text(table, encoding="utf-8")
        extended = "" if text.startswith("extends") else 'extends = "published.toml"\n'
        file.write_text(extended + text, encoding="utf-8")
        return derive(load(file))

    return of


def test_one_clamp_serves_both_fingers(changed: Callable[..., Design]) -> None:
    design = changed()
    (clamp,) = design.clamps
    for foot in clamp.feet:
        assert foot.mirrored() in clamp.feet
    assert clamp.pads_n(clamp.thickness_mm) >= clamp.needed_n > 0
    layers = clamp.thickness_mm / design.mould.layer_mm
    assert layers == pytest.approx(round(layers))
    thinner = clamp.thickness_mm - design.mould.layer_mm
    assert clamp.pads_n(thinner) < clamp.needed_n or thinner < 4.0


def test_marks_of_clamp_and_rail_are_at_one_height(changed: Callable[..., Design]) -> None:
    (clamp,) = changed().clamps
    assert clamp.leg_end_mm < clamp.mark_mm - 0.4
    assert clamp.mark_mm + 0.4 < clamp.rail_mm
    assert {leg.x_max_mm for leg in clamp.legs if leg.x_max_mm > 0} == {clamp.rails[1].x_max_mm}


def test_feet_of_a_compliant_finger_stand_beside_its_interface(
    changed: Callable[..., Design],
) -> None:
    design = changed('extends = "flex.toml"\n')
    (clamp,), (interface,) = design.clamps, design.interfaces
    assert open_back(design, design.emitter)
    for foot in clamp.feet[:2]:
        assert abs(foot.centre_mm[0]) - foot.width_mm / 2 > interface.box.x_max_mm
    for foot in clamp.feet[2:]:
        assert foot.y_min_mm > interface.box.y_max_mm
    mix = silicone_mix(4.0, design.mould)
    notes = [casting_note(d, d.emitter, mix) for d in (design, changed())]
    assert ["hold its tip on its stop with a strip" in note for note in notes] == [True, False]


@pytest.mark.slow
def test_a_longer_finger_has_a_thicker_clamp(changed: Callable[..., Design]) -> None:
    columns = ", ".join(["13", "12"] * 3 + ["13"])
    long = changed(f"[grid]\ncolumns = [{columns}]\npitch_mm = 6.0\n").clamps
    assert long[0].thickness_mm > changed().clamps[0].thickness_mm


def test_without_room_there_is_no_clamp_and_the_note_says_so(
    changed: Callable[..., Design], design_dir: Path
) -> None:
    design = changed()
    fasteners = (design_dir / "parts/fasteners.toml").read_text(encoding="utf-8")
    without = fasteners.replace('["M3"]', '["M3.5"]')
    bare = changed(fasteners=without)
    assert bare.clamps == ()
    assert _tape_m(bare) > _tape_m(design)
    notes = [casting_note(d, d.emitter, silicone_mix(4.0, d.mould)) for d in (design, bare)]
    assert "`mould/clamp.3mf`" in notes[0] and "M3 x 20 countersunk" in notes[0]
    assert "This finger has no printed clamp" in notes[1] and "two strips of" in notes[1]
    assert "clamp.3mf" not in notes[1] and "M3" not in notes[1]


def test_a_note_that_is_silent_about_a_missing_clamp_is_seen(
    changed: Callable[..., Design], design_dir: Path, tmp_path: Path
) -> None:
    fasteners = (design_dir / "parts/fasteners.toml").read_text(encoding="utf-8")
    bare = changed(fasteners=fasteners.replace('["M3"]', '["M3.5"]'))
    mix = silicone_mix(4.0, bare.mould)
    note = casting_note(bare, bare.emitter, mix)
    file = tmp_path / "mould/emitter_casting.md"
    file.parent.mkdir()

    def failed(text: str) -> set[str]:
        file.write_text(text, encoding="utf-8")
        found = measure_note(tmp_path, bare, bare.emitter)
        return {m.check for m in found if not m.passed}

    assert failed(note) == set()
    assert failed(note.replace("This finger has no printed clamp.", "")) == {"mould.clamped"}


def _tape_m(design: Design) -> float:
    return sum(p.quantity for p in design.purchase.pieces if p.pack == "polyimide tape")


def test_screws_and_nuts_of_both_clamps_are_bought(changed: Callable[..., Design]) -> None:
    bought = {p.item: p for p in changed().purchase.pieces if p.group == "fasteners"}
    assert bought["M3 x 20 countersunk screw"].quantity == 4
    assert bought["M3 nut"].quantity == 8
    assert bought["M3 nut"].each is not None


@pytest.mark.slow
def test_the_same_design_gives_the_same_files_in_any_process(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    made = parts.clamp_files(design, design.clamps[0])
    for artefact in made:
        assert artefact.data == (outputs / artefact.path).read_bytes(), artefact.path


def test_a_stiffer_print_presses_harder(changed: Callable[..., Design]) -> None:
    (clamp,) = changed().clamps
    stiffer = replace(clamp, modulus_mpa=2 * clamp.modulus_mpa)
    assert stiffer.pads_n(4.0) == pytest.approx(2 * clamp.pads_n(4.0))
    # Bending follows the cube of the thickness; twist less, where a bar is nearly square.
    assert 6 < clamp.pads_n(8.0) / clamp.pads_n(4.0) < 8


@pytest.mark.parametrize(("width", "thickness"), [(8.0, 4.0), (8.0, 8.0), (8.0, 12.0), (9.0, 5.5)])
def test_the_torsion_constant_is_that_of_the_series(width: float, thickness: float) -> None:
    # Saint-Venant's solution for a rectangle, by its sum.
    a, b = max(width, thickness), min(width, thickness)
    odd = np.arange(1, 40, 2)
    tail = (np.tanh(odd * np.pi * a / (2 * b)) / odd**5).sum()
    exact = a * b**3 * (1 / 3 - 64 / np.pi**5 * b / a * tail)
    assert torsion_mm4(width, thickness) == pytest.approx(exact, rel=0.005)
