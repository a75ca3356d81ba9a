"""Damage the moulds' files, and exactly the right checks fail."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from manifold3d import Manifold

from damages import box, carve, edit, failing, flip_a_triangle, swap
from lumitip_fab.checks import mould

pytestmark = pytest.mark.slow

STL = "mould/receiver_mould.stl"
NOTE = "mould/receiver_casting.md"
Damage = Callable[[Manifold], Manifold]


# The published mould on its bed: floor at 2.4, rim at 3.9, wall to 5.5; tip at y = -21.85, flank
# of the finger at x = 23.9 and of the wall at 24.05, pads at (±22.75, 24.75), weir at y = 33.


def pad_lowered(part: Manifold) -> Manifold:
    return part - box((21.5, 23.5, 3.8), (24.0, 26.0, 3.95))


def pad_cut(part: Manifold) -> Manifold:
    return part - box((21.5, 23.6, 2.41), (22.6, 25.9, 4))


def tip_line_lowered(part: Manifold) -> Manifold:
    return part - box((-5, -21.99, 3.8), (5, -21.4, 3.95))


def floor_raised(part: Manifold) -> Manifold:
    return part + box((0, 0, 2), (5, 5, 2.45))


def tip_floor_raised(part: Manifold) -> Manifold:
    return part + box((8, -21.95, 2.9), (11, -20.5, 3.8))


def wall_upright(part: Manifold) -> Manifold:
    return part + box((24.06, 19, 2), (25.5, 21, 5.5))


def wall_too_near(part: Manifold) -> Manifold:
    return part + box((23.95, 19, 2), (24.6, 21, 3.5)) + wedge(23.95, 0.1)


def wedge(x: float, slope: float) -> Manifold:
    """A piece of wall with its foot at x, opening upward."""
    foot, top = box((x, 19, 3.5), (25, 21, 3.51)), box((x + 2 * slope, 19, 5.49), (25, 21, 5.5))
    return Manifold.batch_hull([foot, top])


def wall_too_far(part: Manifold) -> Manifold:
    foot, top = box((23, 19, 3.9), (24.4, 21, 3.91)), box((23, 19, 5.99), (24.55, 21, 6))
    return part - Manifold.batch_hull([foot, top])


def wall_overhanging(part: Manifold) -> Manifold:
    return part + box((24.0, 19, 5.25), (26.0, 21, 6.2))


def wall_thin(part: Manifold) -> Manifold:
    return part - box((24.8, 18, -1), (30, 22, 6))


def island_added(part: Manifold) -> Manifold:
    return part + box((-2, 46, 0), (2, 50, 4))


def sprue_added(part: Manifold) -> Manifold:
    return part + box((-130, 38, 0), (130, 41, 2))


def beam_over_nothing(part: Manifold) -> Manifold:
    return part + box((10, 38, 1.5), (60, 41, 4))


def post_added(part: Manifold) -> Manifold:
    return part + box((-3, 33.15, 3.5), (3, 35.4, 25))


def squashed(part: Manifold) -> Manifold:
    return part.scale((1, 1, 0.98))


def tilted(part: Manifold) -> Manifold:
    return part.transform([[1, 0, 0.1, -0.39], [0, 1, 0, 0], [0, 0, 1, 0]])


def grip_deeper(part: Manifold) -> Manifold:
    """The gap of one side reaches 0.2 mm farther down."""
    return part - box((20, 2.5, 4.72), (40, 19.5, 6))


def grip_shallower(part: Manifold) -> Manifold:
    return part + box((-26.4, 8, 4.0), (-24.35, 12, 5.05))


def letter_filled(part: Manifold) -> Manifold:
    return part + box((-3, 41, 0.5), (3, 42.38, 3.7))


def lifted(part: Manifold) -> Manifold:
    return part.translate((0, 0, 0.004))


SOLID = {
    pad_lowered: {"stops"},
    pad_cut: {"stops"},
    tip_line_lowered: {"stops"},
    floor_raised: {"thickness"},
    tip_floor_raised: {"tip_thickness"},
    wall_upright: {"draft"},
    wall_too_near: {"gap"},
    wall_too_far: {"gap", "draft"},  # the ends of the cut are upright
    wall_overhanging: {"undercut"},
    wall_thin: {"min_wall"},
    island_added: {"bodies"},
    sprue_added: {"fits_bed"},
    beam_over_nothing: {"span"},
    post_added: {"seat"},
    squashed: {"thickness", "tip_thickness", "stops", "volume", "grip"},
    tilted: {"stops", "draft", "undercut", "letter"},
    grip_deeper: {"grip"},
    grip_shallower: {"grip"},
    letter_filled: {"letter"},
    lifted: {"fits_bed"},
}


@pytest.mark.parametrize("damage", SOLID, ids=lambda d: d.__name__)
def test_a_damaged_mould(damage: Damage, damaged: Path) -> None:
    carve(damaged / STL, damage)
    assert failing(damaged, "mould") == SOLID[damage]


def triangle_flipped(folder: Path) -> None:
    flip_a_triangle(folder / STL)


def fingers_swapped(folder: Path) -> None:
    swap(folder / STL, folder / "mould/emitter_mould.stl")


def mould_truncated(folder: Path) -> None:
    data = (folder / STL).read_bytes()
    (folder / STL).write_bytes(data[: len(data) // 2])


def mould_missing(folder: Path) -> None:
    (folder / STL).unlink()


def volume_edited(folder: Path) -> None:
    text = (folder / NOTE).read_text(encoding="utf-8")
    changed = re.sub(r"\*\*([0-9.]+) mL", lambda m: f"**{float(m[1]) * 1.03:.2f} mL", text)
    (folder / NOTE).write_text(changed, encoding="utf-8")


def mass_edited(folder: Path) -> None:
    text = (folder / NOTE).read_text(encoding="utf-8")
    changed = re.sub(r"part A \| \*\*[0-9.]+ g", "part A | **99.00 g", text)
    (folder / NOTE).write_text(changed, encoding="utf-8")


def layers_edited(folder: Path) -> None:
    edit(folder / NOTE, "in layers of 0.15 mm", "in layers of 0.2 mm")


def clamp_forgotten(folder: Path) -> None:
    edit(folder / NOTE, "`mould/clamp.3mf`", "tape")


def screw_edited(folder: Path) -> None:
    edit(folder / NOTE, "M3 x 20 countersunk", "M3 x 12 countersunk")


def hours_edited(folder: Path) -> None:
    edit(folder / NOTE, "Leave it for 24 h", "Leave it for 2 h")


def ratio_edited(folder: Path) -> None:
    edit(folder / NOTE, "1 g of part A with 1 g of part B", "1 g of part A with 10 g of part B")


def glue_edited(folder: Path) -> None:
    edit(folder / NOTE, "Let it harden for 24 h", "Let it harden for 2 h")


def pot_life_edited(folder: Path) -> None:
    edit(folder / NOTE, "for some 240 min", "for some 2400 min")


def primer_edited(folder: Path) -> None:
    edit(folder / NOTE, "Let it dry for 90 min", "Let it dry for 9 min")


def trial_edited(folder: Path) -> None:
    edit(folder / NOTE, "Wait 24 h at 23 °C", "Wait 24 h at 123 °C")


def turned_over(folder: Path) -> None:
    edit(folder / NOTE, "open side up", "open side down")


def note_empty(folder: Path) -> None:
    (folder / NOTE).write_text("", encoding="utf-8")


def note_missing(folder: Path) -> None:
    (folder / NOTE).unlink()


def backing_missing(folder: Path) -> None:
    (folder / "backing/receiver_backing.stl").unlink()


EVERY = {name.removeprefix("mould.") for name in mould.NAMES}
FILES = {
    triangle_flipped: {"watertight", "volume", "seat"},
    mould_truncated: EVERY,
    mould_missing: EVERY,
    fingers_swapped: {"letter"},
    volume_edited: {"volume", "masses"},
    mass_edited: {"masses"},
    layers_edited: {"note"},
    hours_edited: {"note"},
    ratio_edited: {"note"},
    glue_edited: {"note"},
    pot_life_edited: {"note"},
    primer_edited: {"note"},
    trial_edited: {"note"},
    turned_over: {"note"},
    clamp_forgotten: {"clamped"},
    screw_edited: {"clamped"},
    note_empty: {"volume", "masses", "note", "clamped"},
    note_missing: {"volume", "masses", "note", "clamped"},
    backing_missing: {"seat"},
}


@pytest.mark.parametrize("damage", FILES, ids=lambda d: d.__name__)
def test_a_damaged_file(damage: Callable[[Path], None], damaged: Path) -> None:
    damage(damaged)
    assert failing(damaged, "mould") == FILES[damage]


def test_undamaged_moulds_pass(outputs: Path) -> None:
    assert failing(outputs, "mould") == set()


def test_every_check_appears_in_a_damage_of_its_own() -> None:
    told = [*SOLID.values(), *(names for names in FILES.values() if names != EVERY)]
    assert set().union(*told) == EVERY
