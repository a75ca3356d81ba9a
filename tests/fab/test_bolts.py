"""Bolts through printed parts are tightened with half of what the plastic under them bears."""

import math
import re
from collections.abc import Callable

import pytest

from lumitip_fab.design import Design
from mounting_text import steps

PETG_MPA = 40.0


@pytest.mark.parametrize(
    ("preset", "head_mm", "hole_mm", "thread_mm", "torque_nm", "push_n"),
    [("published", 8.5, 5.3, 5.0, 0.6, 24), ("wsg50", 7.0, 4.3, 4.0, 0.3, 12)],
)
def test_the_torque_is_that_of_half_the_plastic_s_strength(
    preset: str,
    head_mm: float,
    hole_mm: float,
    thread_mm: float,
    torque_nm: float,
    push_n: int,
    written: Callable[..., Design],
) -> None:
    pull_n = PETG_MPA / 2 * math.pi / 4 * (head_mm**2 - hole_mm**2)
    assert 0 <= 0.2 * pull_n * thread_mm / 1000 - torque_nm < 0.1
    design = written({}, preset)
    found = re.findall(r"to ([\d.]+) N m\D+(\d+) N\b", steps(design))
    assert found == [(f"{torque_nm:g}", str(push_n))] * (1 + len(design.flanges))
