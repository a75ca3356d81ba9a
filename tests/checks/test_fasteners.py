"""Holes that a wrong derivation drew and a generator made alike are found by what goes through."""

from collections.abc import Callable
from pathlib import Path

import pytest

from damages import failing
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.making import fits
from lumitip_fab.derive.mount import flange_body, holder, rules
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import design_text
from lumitip_fab.parts.backing import backing
from lumitip_fab.parts.flange import flange_files
from lumitip_fab.parts.holder import holder_files
from lumitip_fab.pipeline.artefact import Artefact

pytestmark = pytest.mark.slow

Alter = Callable[[pytest.MonkeyPatch], None]


def holes_narrow(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(fits.Drawn, "hole_mm", lambda _, nominal_mm: nominal_mm - 0.4)


def holes_wide(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(fits.Drawn, "hole_mm", lambda _, nominal_mm: nominal_mm + 0.7)


def heads_tight(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(flange_body, "SINK_PLAY_MM", 0.0)


def nuts_tight(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(holder, "NUT_PLAY_MM", 0.0)


def screws_long(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(holder, "screw_length_mm", lambda *_: 14.0)
    patch.setattr(rules, "_refuse_nuts", lambda *_: None)


# Recess, pins and peg are measured against what they meet too.
ROUND = {"recess", "pin_width", "socket_width", "peg_play"}
FLANGE: dict[Alter, set[str]] = {
    holes_narrow: {"bolt_clearance", "screw_clearance", *ROUND},
    holes_wide: {"bolt_clearance", "screw_clearance", *ROUND},
    heads_tight: {"head_clearance"},
}
HOLDER: dict[Alter, set[str]] = {
    holes_narrow: {"screw_clearance", "nut_clearance"},
    holes_wide: {"screw_clearance", "nut_clearance"},
    nuts_tight: {"nut_clearance"},
    screws_long: {"nut_room"},
}


@pytest.fixture
def derived(design_dir: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[Alter], Design]:
    """The published design by an altered derivation."""

    def get(alter: Alter) -> Design:
        alter(monkeypatch)
        return derive(load(design_dir / "presets/published.toml"))

    return get


def _written(folder: Path, design: Design, files: tuple[Artefact, ...]) -> None:
    (folder / "design.json").write_text(design_text(design), encoding="utf-8")
    for made in files:
        (folder / made.path).write_bytes(made.data)


@pytest.mark.parametrize("alter", FLANGE, ids=lambda a: a.__name__)
def test_a_wrong_derivation_of_the_flange(
    alter: Alter, derived: Callable[[Alter], Design], damaged: Path
) -> None:
    design = derived(alter)
    _written(damaged, design, flange_files(design, design.flanges[0]))
    assert failing(damaged, "flange") == FLANGE[alter]


def test_a_wrong_derivation_of_the_coupling(
    derived: Callable[[Alter], Design], damaged: Path
) -> None:
    """Of the gripper's pins nothing tells how wide they are: the bolts' holes alone are found."""
    d = derived(holes_narrow)
    made = (backing(d, f) for f in d.fingers)
    _written(damaged, d, tuple(artefact for files in made for artefact in files))
    assert failing(damaged, "backing") == {"bolt_clearance"}


@pytest.mark.parametrize("alter", HOLDER, ids=lambda a: a.__name__)
def test_a_wrong_derivation_of_the_holder(
    alter: Alter, derived: Callable[[Alter], Design], damaged: Path
) -> None:
    design = derived(alter)
    _written(damaged, design, holder_files(design, design.holders[0]))
    assert failing(damaged, "holder") == HOLDER[alter]
