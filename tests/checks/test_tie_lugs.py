"""Damage the lugs for cable ties, and exactly the right checks fail."""

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from manifold3d import Manifold

from damages import box, carve, cut_short, failing, passing
from lumitip_fab.checks import tie_lugs
from lumitip_fab.design import TieLug
from lumitip_fab.design.encoding import read_design

pytestmark = pytest.mark.slow

BACKING, HOLDER = "backing/receiver_backing.stl", "holder/holder.stl"
Damage = Callable[[Manifold, TieLug], Manifold]


def across(lug: TieLug, out: tuple[float, float], up: tuple[float, float], more: float) -> Manifold:
    """A bar through a lug, from its wall out, along it and up."""
    (first, last), (low, high) = lug.along_mm, (lug.face_mm + out[0], lug.face_mm + out[1])
    x = sorted((lug.side * low, lug.side * high))
    return box((x[0], first - more, up[0]), (x[1], last + more, up[1]))


def filled(part: Manifold, lug: TieLug) -> Manifold:
    """A thread of plastic across the opening."""
    low = lug.opening.y_min_mm
    return part + across(lug, (-0.2, lug.out_mm - 0.2), (low + 0.3, low + 0.6), -1.0)


def bar_thin(part: Manifold, lug: TieLug) -> Manifold:
    """The bar 0.3 mm thinner from inside."""
    deep, box_ = lug.opening.x_max_mm, lug.opening
    cut = (box_.y_min_mm + 0.4, box_.y_max_mm)
    return part - across(lug, (deep - 0.1, deep + 0.3), cut, 1.0)


def roof_thin(part: Manifold, lug: TieLug) -> Manifold:
    top = lug.opening.y_max_mm
    return part - across(lug, (0.0, lug.opening.x_max_mm), (top - 0.1, top + 0.3), 1.0)


def beneath_thin(part: Manifold, lug: TieLug) -> Manifold:
    low = lug.opening.y_min_mm
    return part - across(lug, (0.0, lug.opening.x_max_mm), (low - 0.4, low + 0.1), 1.0)


def cut_off(part: Manifold, lug: TieLug) -> Manifold:
    """A lug shorter along its wall."""
    last = lug.along_mm[1]
    (low, high), x = (lug.profile[0][1], lug.profile[2][1]), lug.face_mm * lug.side
    wide = sorted((x, lug.side * (lug.face_mm + lug.out_mm + 1)))
    return part - box((wide[0], last - 0.4, low), (wide[1], last + 1.0, high + 0.5))


def knob(part: Manifold, lug: TieLug) -> Manifold:
    """A lug that stands out farther, at its top."""
    top = lug.profile[2][1]
    return part + across(lug, (lug.out_mm - 0.3, lug.out_mm + 0.5), (top - 1.2, top - 0.2), 0.0)


def lip(part: Manifold, lug: TieLug) -> Manifold:
    """A lug that reaches towards the plate, at its top."""
    first, top, x = lug.along_mm[0], lug.profile[2][1], lug.side * lug.face_mm
    wide = sorted((x + lug.side * 0.2, x + lug.side * lug.opening.x_max_mm))
    return part + box((wide[0], first - 1.0, top - 1.6), (wide[1], first + 0.5, top - 0.2))


def missing(part: Manifold, lug: TieLug) -> Manifold:
    return part - across(lug, (0.01, lug.out_mm + 1), (lug.profile[0][1], lug.profile[2][1]), 1.0)


DAMAGES: dict[Damage, set[str]] = {
    filled: {"opening"},
    bar_thin: {"wall"},
    roof_thin: {"wall"},
    beneath_thin: {"wall"},
    cut_off: {"length"},
    knob: {"reach"},
    lip: {"flaps"},
    missing: {"wall", "reach", "length"},
}


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damaged_lug_of_a_finger(damage: Damage, damaged: Path) -> None:
    lug = read_design(damaged / "design.json").mount.lugs[0]
    carve(damaged / BACKING, lambda part: damage(part, lug))
    assert failing(damaged, "tie_lugs") == DAMAGES[damage]


def test_a_damaged_lug_of_the_holder(damaged: Path) -> None:
    lug = read_design(damaged / "design.json").holders[0].lugs[1]
    carve(damaged / HOLDER, lambda part: bar_thin(part, lug))
    assert failing(damaged, "tie_lugs") == {"wall"}


def test_files_that_cannot_be_read(damaged: Path) -> None:
    cut_short(damaged / BACKING)
    (damaged / HOLDER).unlink()
    assert failing(damaged, "tie_lugs") == {"readable"}


def test_every_check_fails_for_some_damage(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    names = {m.check.partition(".")[2] for m in tie_lugs.measure(outputs, design)}
    assert names == set().union(*DAMAGES.values()) | {"readable"}


@pytest.mark.parametrize("preset", ["flex", "wsg50"])
def test_other_fingers_have_sound_lugs_or_none(built: Callable[[str], Path], preset: str) -> None:
    design = read_design(built(preset) / "design.json")
    assert bool(design.mount.lugs) == bool(passing(built(preset), "tie_lugs", lambda _: True))
    for lug in design.mount.lugs:
        assert lug.wall_mm >= 1.5 and not math.isclose(*lug.along_mm)
