"""Bolts through printed parts are tightened with half of what the plastic under them bears."""

import math
import re
from collections.abc import Callable

import pytest

from lumitip_fab.design import Design
from lumitip_fab.design.seat import torque_nm
from mounting_text import steps

PETG_MPA = 40.0


@pytest.mark.parametrize(
    ("preset", "head_mm", "hole_mm", "thread_mm", "torque_nm", "pushed_kg"),
    [("published", 8.5, 5.3, 5.0, "0.69", "2.8"), ("robotiq_2f140", 8.5, 5.3, 5.0, "0.69", "2.8")],
)
def test_the_torque_is_that_of_half_the_plastic_s_strength(
    preset: str,
    head_mm: float,
    hole_mm: float,
    thread_mm: float,
    torque_nm: str,
    pushed_kg: str,
    written: Callable[..., Design],
) -> None:
    pull_n = PETG_MPA / 2 * math.pi / 4 * (head_mm**2 - hole_mm**2)
    assert 0 <= 0.2 * pull_n * thread_mm / 1000 - float(torque_nm) < 0.01
    assert 0 <= 0.2 * pull_n / 5 / 9.81 - float(pushed_kg) < 0.1, "five threads from the axis"
    design = written({}, preset)
    found = re.findall(r"to ([\d.]+) N m\b.*?the weight of ([\d.]+) kg", steps(design))
    assert found == [(torque_nm, pushed_kg)] * (1 + len(design.flanges))


def test_a_thin_land_round_a_sleeve_bears_less(written: Callable[..., Design]) -> None:
    """Half of what the head's seat bears would be 0.38 N m."""
    assert "Tighten them to 0.35 N m" in steps(written({}, "wsg50"))


def test_a_load_of_more_than_half_leaves_less_to_the_torque() -> None:
    assert torque_nm(5.0, 1000.0, 400.0) == pytest.approx(0.5)
    assert torque_nm(5.0, 1000.0, 600.0) == pytest.approx(0.4)
