"""The walls round an engraved letter that one printed line may make."""

import numpy as np
import pytest

from lumitip_fab.checks.walls import beside
from lumitip_fab.design import Box, Letter, Printing


@pytest.mark.parametrize(("min_wall_mm", "reach_mm"), [(0.6, 0.7), (0.8, 0.8), (1.2, 1.2)])
def test_walls_are_exempt_as_far_from_the_letter_as_a_wall_may_be_thin(
    min_wall_mm: float, reach_mm: float
) -> None:
    letter = Letter(Box(-1.0, 1.0, 1.0, 4.0), wall_mm=10.0, depth_mm=0.5)
    printing = Printing("PETG", 1.27, min_wall_mm, 0.0, 0.45, 0.2, (250.0, 210.0, 210.0), 15.0)
    region = beside(letter, printing)
    heights = 1.0 - np.array([reach_mm - 0.01, reach_mm + 0.01])
    points = np.column_stack([np.zeros(2), np.full(2, 9.8), heights])
    assert region.holds(points).tolist() == [True, False]
    assert region.least_mm == printing.line_mm
