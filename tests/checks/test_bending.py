"""Damage the list of wires, and checks of the bend radius fail; the model against known shapes."""

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from damages import excerpt, failing, passing
from lumitip_fab.derive.wiring.bending import smallest_radius
from lumitip_fab.derive.wiring.loops import Way, loop_of, with_room
from lumitip_fab.design.cabling import Cable, outer_mm
from lumitip_fab.design.encoding import read_design

LIST = "wiring/cables.csv"
BOARDS = ("emitter", "receiver", "breakout")


@pytest.fixture
def cables(outputs: Path, tmp_path: Path) -> Path:
    return excerpt(outputs, tmp_path, LIST, *(f"boards/{name}" for name in BOARDS))


def changed(folder: Path, cable: str, column: int, value: str) -> None:
    """Another value for all wires of a cable."""
    file, lines = folder / LIST, []
    for line in file.read_text(encoding="utf-8").splitlines():
        fields = line.split(",")
        if fields[0].startswith(f"{cable}."):
            fields[column] = value
        lines.append(",".join(fields))
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


SECTION, LENGTH = 7, 8


def test_an_undamaged_list_passes(cables: Path) -> None:
    names = {"readable", "radius", "figure"}
    assert passing(cables, "bending", lambda _: True) == names


def test_wires_too_thick_to_bend(cables: Path) -> None:
    changed(cables, "W1", SECTION, "10")
    assert failing(cables, "bending") == {"radius"}


@pytest.mark.parametrize("value", ["nan", "0", "-1", "inf"])
def test_no_section(value: str, cables: Path) -> None:
    changed(cables, "W1", SECTION, value)
    assert failing(cables, "bending") == {"readable"}


@pytest.mark.parametrize("value", ["nan", "inf"])
def test_no_length(value: str, cables: Path) -> None:
    changed(cables, "W1", LENGTH, value)
    assert failing(cables, "bending") == {"radius", "figure"}


def test_a_cable_of_another_length(cables: Path) -> None:
    changed(cables, "W2", LENGTH, "400")
    assert failing(cables, "bending") == {"figure"}


def test_a_cable_that_does_not_reach(cables: Path) -> None:
    changed(cables, "W2", LENGTH, "160")
    assert failing(cables, "bending") == {"radius", "figure"}


def test_a_list_that_is_gone(cables: Path) -> None:
    (cables / LIST).unlink()
    assert failing(cables, "bending") == {"readable"}


def test_a_cable_that_is_not_listed(cables: Path) -> None:
    file = cables / LIST
    lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
    file.write_text("".join(line for line in lines if not line.startswith("W1.")), encoding="utf-8")
    assert failing(cables, "bending") == {"readable"}


def test_the_model_against_a_beam_that_bends_little() -> None:
    """A clamped column that is a little too long: y = A (1 - cos 2 pi x/l) / 2, by whose slope it
    is A² pi² / (4 l) longer, and whose ends bend to l² / (2 pi² A)."""
    run, more = 1000.0, 1.0
    rise = math.sqrt(4 * run * more) / math.pi
    radius, _ = smallest_radius(run, 1e-6, run + more)
    assert radius == pytest.approx(run**2 / (2 * math.pi**2 * rise), rel=0.01)


def test_a_loop_grows_with_all_its_lengths() -> None:
    radius, at = smallest_radius(150.0, 42.5, 240.0)
    twice, there = smallest_radius(300.0, 85.0, 480.0)
    assert (twice, there) == pytest.approx((2 * radius, 2 * at))


def test_a_short_cable_is_cut_longer() -> None:
    way = Way(30.0, 55.0, 20.0)
    short = Cable("W2", way.length_mm, 110.0, 0.0, 0.25, ())
    assert loop_of(short, way).radius_mm < 8 * outer_mm(0.25)
    longer = with_room(short, way, 10.0)
    assert longer.added_mm == longer.length_mm - 110.0 > 0
    found = loop_of(longer, way)
    assert found.radius_mm >= found.least_mm == 8 * outer_mm(0.25)


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["flex", "wsg50", "integrated"])
def test_cables_of_other_designs(built: Callable[[str], Path], preset: str) -> None:
    folder = built(preset)
    assert passing(folder, "bending", lambda _: True) == {"readable", "radius", "figure"}
    design = read_design(folder / "design.json")
    assert len(design.cabling.loops) >= 2
