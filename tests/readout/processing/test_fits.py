"""Exact markers, and directions at the ends of their ranges."""

import math

import numpy as np
import pytest

from lumitip.processing.fits import Border, fit_line, fit_rays


def _border(markers: list[complex]) -> Border:
    z = np.array(markers)
    return Border(z, np.ones(z.size, np.complex128), 0j, 0j)


@pytest.mark.parametrize("lean", [0.0, 1e-17, -1e-17])
def test_an_upright_line_is_at_plus_90_degrees(lean: float) -> None:
    line = fit_line(_border([complex(lean, 1.0), complex(-lean, -1.0)]))
    assert line is not None and line.angle_deg == 90.0


@pytest.mark.parametrize("lean", [0.0, 1e-17, -1e-17])
def test_a_ray_to_the_left_is_at_plus_180_degrees(lean: float) -> None:
    """A right angle: one ray to the left, one down."""
    left = [complex(-x, lean) for x in (1.0, 2.0, 3.0, 4.0)]
    down = [complex(0.0, -y) for y in (1.0, 2.0, 3.0, 4.0)]
    corner, _ = fit_rays(_border(left + down))
    assert corner is not None
    assert corner.opening_deg == pytest.approx(90.0)
    assert max(corner.directions_deg) == 180.0
    assert corner.vertex_mm == pytest.approx((0.0, 0.0), abs=1e-9)


def test_parallel_rays_have_no_vertex() -> None:
    corner, _ = fit_rays(_border([complex(x, y) for y in (-2.0, 2.0) for x in range(-3, 4)]))
    assert corner is None


def test_markers_in_one_place_have_no_direction() -> None:
    assert fit_line(_border([1.0 + 2.0j] * 8)) is None
    corner, cable = fit_rays(_border([1.0 + 2.0j] * 8))
    assert (corner, cable) == (None, None)


def test_a_line_through_exact_points_leaves_nothing() -> None:
    turn = complex(math.cos(0.3), math.sin(0.3))
    line = fit_line(_border([turn * x + 5j for x in (-2.0, 0.0, 1.0, 7.0)]))
    assert line is not None
    assert line.angle_deg == pytest.approx(math.degrees(0.3))
    assert line.rms_mm == pytest.approx(0.0, abs=1e-7)
