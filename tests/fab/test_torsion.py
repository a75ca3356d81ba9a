"""Saint-Venant's torsion of a beam's sections, against exact figures and a grid of the section."""

import numpy as np
import pytest
from scipy.sparse import lil_matrix
from scipy.sparse.linalg import spsolve

from lumitip_fab.design.beam import Beam, Vectors, rectangles
from lumitip_fab.design.clamp import torsion_mm4
from lumitip_fab.design.torsion import SHEAR, Torsion, torsion

PLATE_MPA, BOARD_MPA = 1700.0, 20000.0


def box(
    half_mm: float, front_mm: float, back_mm: float, inner_mm: float = 0.0
) -> tuple[Vectors, Vectors, Vectors, Vectors]:
    """A rectangle in a single section."""
    one = np.ones(1)
    return inner_mm * one, half_mm * one, front_mm * one, back_mm * one


def turned(*layers: object) -> Torsion:
    """A beam of one section, in torsion."""
    return torsion(Beam(np.ones(1), 10.0, layers))  # type: ignore[arg-type]


@pytest.mark.parametrize(("width", "depth"), [(16.0, 16.0), (16.0, 8.0), (16.0, 4.0), (8.0, 16.0)])
def test_a_rectangle_as_in_the_table(width: float, depth: float) -> None:
    layer = rectangles(PLATE_MPA, width / 2, [box(width / 2, 3.0, 3.0 + depth)])
    exact = SHEAR * PLATE_MPA * torsion_mm4(width, depth)
    assert turned(layer).stiffness_nmm2[0] == pytest.approx(exact, rel=0.01)


def test_the_shear_of_a_square_and_of_a_strip() -> None:
    """T = 0.208 a³ of a square, t of a strip (Roark)."""
    square = turned(rectangles(1.0, 8.0, [box(8.0, 0.0, 16.0)]))
    shear = SHEAR * square.reach_mm[0][0] / square.stiffness_nmm2[0]
    assert shear == pytest.approx(1 / (0.208 * 16.0**3), rel=0.01)
    strip = turned(rectangles(1.0, 8.0, [box(24.0, 0.0, 2.0)]))
    assert strip.reach_mm[0][0] == pytest.approx(2.0, rel=0.01)


def by_grid(shear_mpa: Vectors, step_mm: tuple[float, float]) -> float:
    """Stiffness of a section of several materials, by Prandtl's stress function on a grid of its
    pixels; 0 MPa is outside."""
    rows, columns = shear_mpa.shape
    number = np.arange(rows * columns).reshape(rows, columns)
    matrix, soft = lil_matrix((number.size, number.size)), 1.0 / np.maximum(shear_mpa, 1e-9)
    steps = (1, 0, step_mm[0]), (-1, 0, step_mm[0]), (0, 1, step_mm[1]), (0, -1, step_mm[1])
    for r, c in zip(*np.nonzero(shear_mpa), strict=True):
        for dr, dc, step in steps:
            to = r + dr, c + dc
            inside = 0 <= to[0] < rows and 0 <= to[1] < columns and shear_mpa[to] > 0
            flow = (soft[r, c] + soft[to]) / 2 if inside else 2 * soft[r, c]
            matrix[number[r, c], number[r, c]] += flow / step**2
            if inside:
                matrix[number[r, c], number[to]] -= flow / step**2
    kept = np.flatnonzero(shear_mpa.ravel())
    system = matrix.tocsr()[kept][:, kept]
    height = spsolve(system.tocsc(), np.full(len(kept), 2.0))
    return float(2 * height.sum() * step_mm[0] * step_mm[1])


@pytest.mark.parametrize(
    ("behind_mm", "within"), [(0.5, 0.1), (1.5, 0.1), (4.0, 0.15), (6.0, 0.25)]
)
def test_a_plate_with_its_board_and_a_flare(behind_mm: float, within: float) -> None:
    """48 mm of plate of 2.4 mm, of which 1.6 mm are board, and a flare behind it."""
    half, core, step = 24.0, 8.0, (0.2, 0.5)
    board = rectangles(BOARD_MPA, core, [box(22.0, 0.0, 1.6)])
    rims, floor = box(half, 0.0, 1.6, 22.0), box(half, 1.6, 2.4)
    plate = rectangles(PLATE_MPA, core, [rims, floor, box(core, 2.4, 2.4 + behind_mm)])
    w = np.arange(step[0] / 2, 2.4 + behind_mm, step[0])[:, None]
    u = np.abs(np.arange(-half + step[1] / 2, half, step[1]))[None, :]
    mpa = np.where(w < 2.4, PLATE_MPA, np.where(u < core, PLATE_MPA, 0.0))
    mpa = np.where((w < 1.6) & (u < 22.0), BOARD_MPA, mpa)
    found = turned(plate, board).stiffness_nmm2[0]
    assert found == pytest.approx(by_grid(SHEAR * mpa, step), rel=within)
