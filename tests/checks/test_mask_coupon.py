"""Damage the coupon of the mask's material, and exactly the right checks fail."""

from collections.abc import Callable
from pathlib import Path

import pytest

from active_pages import ACTIVE, added
from damages import box, carve, cut_short, failing, flip_a_triangle, passing

pytestmark = pytest.mark.slow

STL, PAGE = "mask/coupon.stl", "mask/coupon_a4.pdf"
Damage = Callable[[Path], None]


def carved(change: Callable) -> Damage:
    return lambda out: carve(out / STL, change)


def drawn(before: bytes, after: bytes) -> Damage:
    """Change the operators of the page, which keep their length."""

    def draw(out: Path) -> None:
        page = (out / PAGE).read_bytes()
        assert page.count(before) == 1
        (out / PAGE).write_bytes(page.replace(before, after.ljust(len(before))))

    return draw


DAMAGES: dict[str, tuple[Damage, set[str]]] = {
    "smaller": (
        carved(lambda body: body.scale((0.8, 0.8, 1.0))),
        {"covers", "three_mf"},
    ),
    "drilled": (
        carved(lambda body: body - box((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))),
        {"whole"},
    ),
    "thicker": (carved(lambda body: body.scale((1.0, 1.0, 1.5))), {"thickness", "three_mf"}),
    "a triangle turned": (lambda out: flip_a_triangle(out / STL), {"whole"}),
    "STL cut short": (lambda out: cut_short(out / STL, 200), {"covers"}),
    "3MF missing": (lambda out: (out / "mask/coupon.3mf").unlink(), {"covers"}),
    "page missing": (lambda out: (out / PAGE).unlink(), {"covers"}),
    "page cut short": (lambda out: cut_short(out / PAGE, 300), {"covers"}),
    **{change.__name__: (added(PAGE, change), {"covers"}) for change in ACTIVE},
    "grey": (drawn(b"\n0 g\n", b"\n1 g\n"), {"covers"}),
    "only an outline": (drawn(b"36 re f*", b"36 re S"), {"covers"}),
}


@pytest.mark.parametrize("name", DAMAGES)
def test_a_damaged_coupon_fails_exactly(name: str, damaged_masks: Path) -> None:
    damage, expected = DAMAGES[name]
    damage(damaged_masks)
    assert failing(damaged_masks, "mask_coupon") == expected


def test_every_check_is_in_a_damage(masks: Path) -> None:
    names = passing(masks, "mask_coupon", lambda _: True)
    assert names == set().union(*(expected for _, expected in DAMAGES.values()))
