"""Tables and fits of the estimator: shared by equal cells, and many poses at once."""

import numpy as np
import pytest
from numpy.typing import NDArray

from common import layout_of
from lumitip import Layout
from lumitip.estimation import PoseEstimator
from lumitip.estimation.bank import Bank, lines
from lumitip.estimation.estimator import KINDS
from lumitip.estimation.fit import Frame, fit, fits
from lumitip.estimation.lookup import Lookup, between_borders
from lumitip.estimation.shapes import Bent, Cable, Cells, Corner, Edge, Shape
from lumitip.twin import Cable as CableThing
from lumitip.twin import HalfPlane, Twin

Floats = NDArray[np.float64]
DIAMETER_MM = 3.0
STARTS: dict[str, list[list[float]]] = {
    "edge": [[0.1, 0.5], [0.4, -1.0], [-0.3, 2.0]],
    "cable": [[0.1, 0.5, 3.0], [0.4, -1.0, 3.2], [-0.3, 2.0, 2.8]],
    "bent": [[0.1, 0.5, 3.0, 0.0], [0.2, -1.0, 3.2, 0.01], [-0.3, 2.0, 2.8, -0.01]],
    "corner": [[0.1, 0.5, 0.3, 1.5], [0.6, -1.0, 1.0, 1.6], [-0.3, 2.0, -2.0, 1.7]],
}


@pytest.fixture(scope="module")
def shapes(twin: Twin) -> dict[str, Shape]:
    """Each shape, with one drift of the optics: the gap."""
    other = Twin(twin.layout, twin.model.changed(gap_mm=3.4))
    cells, both = Cells(twin.layout.x_mm, twin.layout.y_mm), (twin, other)
    edges = [one.edge_table() for one in both]
    beyond = [
        between_borders(one.cable_table(DIAMETER_MM), edge, DIAMETER_MM)
        for one, edge in zip(both, edges, strict=True)
    ]
    edge, cable = Lookup(edges), Lookup(beyond, edges)
    return {
        "edge": Edge(cells, edge),
        "cable": Cable(cells, cable, DIAMETER_MM),
        "bent": Bent(cells, cable, DIAMETER_MM),
        "corner": Corner(cells, edge),
    }


def seen(values: Floats) -> Frame:
    ones = np.ones(values.size)
    full = values > 254.0
    return Frame(values / 255.0, 100.0 * ones, 255.0 * ones, full, 3.0, np.zeros_like(full))


@pytest.mark.parametrize("kind", STARTS)
def test_several_poses_are_fitted_as_each_alone(
    shapes: dict[str, Shape], twin: Twin, kind: str
) -> None:
    shape = shapes[kind]
    thing = CableThing if shape.kind == "cable" else HalfPlane
    frame = seen(twin.values(thing(offset_mm=0.7, angle_deg=8.0)))
    starts = np.array([[*start, 0.0, 1.0, 0.9] for start in STARTS[kind]])
    together = fits(shape, starts, frame)
    for start, found in zip(starts, together, strict=True):
        alone = fit(shape, start, frame)
        np.testing.assert_allclose(found.pose, alone.pose, rtol=1e-7, atol=1e-9)
        assert found.cost == pytest.approx(alone.cost)
        assert (found.converged, found.drifts) == (alone.converged, 1)
    assert any(found.converged for found in together)


@pytest.mark.parametrize("kind", STARTS)
def test_the_slopes_are_those_of_the_shares(shapes: dict[str, Shape], kind: str) -> None:
    shape = shapes[kind]
    poses = np.array([[*start, 0.0, 1.0, 0.9] for start in STARTS[kind]])
    _, slopes = shape.slopes(poses)
    assert len(slopes) == poses.shape[1] - 2
    for entry, slope in enumerate(slopes):
        by = np.zeros(poses.shape[1])
        # With a drift, shares are rounded as the tables are.
        by[entry] = step = 1e-6 if entry < len(shape.names) else 1e-3
        ahead, behind = shape.slopes(poses + by)[0], shape.slopes(poses - by)[0]
        # Beside a border between entries of the table the slope changes.
        off = np.abs((ahead - behind) / (2.0 * step) - slope)
        assert np.quantile(off, 0.95) < 1e-3 * max(np.abs(slope).max(), 1.0), (kind, entry)


def test_a_cable_of_the_expected_width_takes_what_its_table_says(
    shapes: dict[str, Shape], twin: Twin
) -> None:
    cells = Cells(twin.layout.x_mm, twin.layout.y_mm)
    poses = lines(cells)[::97]
    wanted = twin.cable_table(DIAMETER_MM)(
        np.degrees(poses[:, :1]), cells.beside(poses[:, 0], poses[:, 1])
    )
    np.testing.assert_allclose(shapes["cable"].shares(poses), wanted, atol=2e-6)


def test_a_wider_cable_takes_a_strip_more_at_each_border(
    shapes: dict[str, Shape], twin: Twin
) -> None:
    cells, table = Cells(twin.layout.x_mm, twin.layout.y_mm), twin.edge_table()
    angle, offset_mm, width_mm = 0.2, 0.6, 3.5
    left = cells.beside(np.array(angle), np.array(offset_mm))

    def strip(wide_mm: float) -> Floats:
        borders = (table(np.degrees(angle), left + s * wide_mm / 2.0) for s in (-1.0, 1.0))
        return np.subtract(*borders)

    plain = twin.cable_table(DIAMETER_MM)(np.degrees(angle), left)
    share, _ = shapes["cable"].slopes(np.array([[angle, offset_mm, width_mm, 0.0, 1.0, 1.0]]))
    np.testing.assert_allclose(share[0], plain + strip(width_mm) - strip(DIAMETER_MM), atol=2e-6)


@pytest.mark.slow
def test_cells_inside_a_large_grid_share_a_row_of_the_table(cells: Layout) -> None:
    large, small = (
        layout_of(tuple(rows + i % 2 for i in range(rows)), 3.0, cells.optics) for rows in (31, 13)
    )
    tables = [Twin(layout).edge_table() for layout in (large, small)]
    assert len(tables[0].row) == len(large) > 950
    assert len(tables[0].shares) < 100
    inside = np.hypot(large.x_mm, large.y_mm) < 20.0
    assert len(set(tables[0].row[inside].tolist())) == 1
    # A cell there sees what one in the middle of a small grid sees.
    rows = [
        table.shares[table.row[np.hypot(layout.x_mm, layout.y_mm).argmin()]]
        for layout, table in zip((large, small), tables, strict=True)
    ]
    np.testing.assert_allclose(*rows, atol=1e-6)


@pytest.mark.slow
def test_nothing_is_made_while_frames_come(
    twin: Twin, wrong_twins: list[Twin], monkeypatch: pytest.MonkeyPatch
) -> None:
    ready = PoseEstimator(twin.layout, tracking=True).prepare()

    def forbidden(*_: object) -> None:
        raise AssertionError("a table is made while frames come")

    for name in ("edge_table", "cable_table"):
        monkeypatch.setattr(Twin, name, forbidden)
    monkeypatch.setattr(Bank, "of", forbidden)
    for kind in (None, *KINDS):
        for source in (twin, wrong_twins[0]):
            for thing in (HalfPlane(offset_mm=1.0), CableThing(offset_mm=1.0, angle_deg=20.0)):
                ready.reset()
                assert ready(source.values(thing), kind).kind in KINDS


def test_the_closest_poses_are_those_of_a_search_of_all(
    shapes: dict[str, Shape], twin: Twin, monkeypatch: pytest.MonkeyPatch
) -> None:
    cells = Cells(twin.layout.x_mm, twin.layout.y_mm)
    made = Bank.of(shapes["edge"], lines(cells), np.ones(len(twin.layout)))
    frame = seen(twin.values(HalfPlane(offset_mm=-1.3, angle_deg=14.0)))
    few = made.closest(frame.light, frame.scale, 8)
    monkeypatch.setattr("lumitip.estimation.bank._FEW", len(made.poses))
    np.testing.assert_array_equal(few, made.closest(frame.light, frame.scale, 8))
    assert len(few) == 8
