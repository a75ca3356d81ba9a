"""What light must do, and what is known of the published sensor."""

from collections.abc import Callable

import numpy as np
import pytest

from lumitip.twin import Cable, Corner, HalfPlane, Image, Model, Polygon, Sheet, Twin, TwinError
from lumitip.twin.materials import MATERIALS, MEASURED_GAP_MM
from lumitip.twin.optics import drive_of_values, values_of_drive
from lumitip.twin.pairs import Emitter, Pairs
from lumitip.twin.rays import bundle

TwinAt = Callable[..., Twin]
KNOWN_WIDTHS_MM = {2.0: 1.3, 3.0: 1.9, 6.0: 4.5}


def width_mm(twin: Twin) -> float:
    """Way from 10 to 90 % of an edge across the fingertip, drawn on the raster, mean of cells."""
    y_mm = twin.plane().y_mm
    way = np.arange(-25.0, 25.0, 0.1)
    drawn = np.clip(0.5 - (y_mm - way[:, None]) / 0.5, 0.0, 1.0).astype(np.float32)
    share = twin.batch(drawn)[::-1] / 255.0
    widths = [np.diff(np.interp([0.1, 0.9], cell, way))[0] for cell in share.T]
    return float(np.mean(widths))


@pytest.mark.parametrize("gap_mm", KNOWN_WIDTHS_MM)
def test_edges_are_as_wide_as_known(twin_at: TwinAt, gap_mm: float) -> None:
    twin, way = twin_at(gap_mm), np.arange(-25.0, 25.0, 0.1)
    assert width_mm(twin) == pytest.approx(KNOWN_WIDTHS_MM[gap_mm], rel=0.1)
    share = twin.edges(-way, 0.0) / 255.0
    widths = [np.diff(np.interp([0.1, 0.9], cell, way))[0] for cell in share.T]
    assert np.mean(widths) == pytest.approx(KNOWN_WIDTHS_MM[gap_mm], rel=0.1), "by its table"


@pytest.mark.parametrize("damage", [{"gap_mm": 2.5}, {"gap_mm": 3.5}, {"hole_mm": 3.5}])
def test_wrong_optics_miss_the_known_width(twin: Twin, damage: dict[str, float]) -> None:
    wrong = Twin(twin.layout, Model.from_layout(twin.layout, **({"gap_mm": 3.0} | damage)))
    assert width_mm(wrong) != pytest.approx(KNOWN_WIDTHS_MM[3.0], rel=0.1)


def test_corner_cells_get_as_little_light_as_known(twin_at: TwinAt) -> None:
    drive = twin_at(6.0).drive
    assert drive[[0, 4, 27, 31]].mean() / drive.max() == pytest.approx(0.59, abs=0.03)


def test_materials_read_as_published(twin_at: TwinAt) -> None:
    twin = twin_at(MEASURED_GAP_MM)
    for material in MATERIALS:
        mean = twin.values(material.sheet()).mean()
        assert mean == pytest.approx(material.published_mean, abs=0.5), material.name
        assert abs(mean - material.published_mean) < (material.published_bar or 1.0)


def test_nothing_is_full_light_and_an_opaque_sheet_is_dark(twin_at: TwinAt) -> None:
    for gap_mm in (2.0, 3.0, 6.0):
        assert twin_at(gap_mm).values() == pytest.approx(np.full(32, 255.0))
        assert twin_at(gap_mm).values(Sheet()) == pytest.approx(np.zeros(32), abs=0.01)
        assert twin_at(gap_mm).values(Sheet(clear=1.0)) == pytest.approx(np.full(32, 255.0))


def test_more_cover_is_never_more_light(twin: Twin) -> None:
    way = np.linspace(-20.0, 20.0, 81)
    for angle_deg in (0.0, 17.0, 90.0, 211.0):
        values = twin.edges(way, angle_deg)
        assert np.diff(values, axis=0).max() < 0.02
        assert values[0].min() > 254.9 and values[-1].max() < 0.1
    for thin, thick in [(1.0, 2.0), (2.0, 4.0)]:
        cables = [twin.values(Cable(1.0, 20.0, diameter_mm=d)) for d in (thin, thick)]
        assert (cables[0] >= cables[1] - 0.02).all()
    hole, wall = Polygon([(-4, -4), (4, -4), (4, 4), (-4, 4)]), Sheet(clear=0.5)
    assert (twin.values([hole, wall]) <= twin.values(hole) + 1e-3).all()


def test_light_takes_the_same_way_back() -> None:
    model = Model(emitter_depth_mm=0.5, detector_depth_mm=1.1)
    for dx_mm, dy_mm in ((0.0, 0.0), (6.0, 0.0), (5.196, 3.0)):
        there, back = bundle(model, dx_mm, dy_mm), bundle(model.reversed(), -dx_mm, -dy_mm)
        assert there.weight.sum() == pytest.approx(back.weight.sum(), rel=1e-9)
        low = np.average(np.hypot(*there.at(0.3 * model.gap_mm)), weights=there.weight)
        x, y = back.at(0.7 * model.gap_mm)
        high = np.average(np.hypot(x + dx_mm, y + dy_mm), weights=back.weight)
        assert low == pytest.approx(high, rel=1e-9), "the same places, seen from the other end"


def test_a_symmetric_layout_is_lit_symmetrically(twin: Twin) -> None:
    layout = twin.layout
    places = np.stack([layout.x_mm, layout.y_mm], axis=1)
    for mirror in ((-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)):
        away = np.linalg.norm(places[:, None] - places * mirror, axis=2)
        twins = away.argmin(axis=1)
        assert away.min(axis=1).max() < 1e-3
        assert twin.drive == pytest.approx(twin.drive[twins], rel=1e-4)
        corner = Corner(1.0, 2.0, -60.0, 70.0)
        turned = Corner(
            mirror[0],
            2.0 * mirror[1],
            float(
                np.degrees(
                    np.arctan2(
                        mirror[1] * np.sin(np.radians(-60.0)), mirror[0] * np.cos(np.radians(-60.0))
                    )
                )
            ),
            70.0,
        )
        assert twin.values(turned)[twins] == pytest.approx(twin.values(corner), abs=0.5)


def test_cells_far_from_a_small_object_see_nothing_of_it(twin: Twin) -> None:
    small = Polygon([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    values, away_mm = twin.values(small), np.hypot(twin.layout.x_mm, twin.layout.y_mm)
    assert values[away_mm > 9.0] == pytest.approx(255.0, abs=0.1)
    assert values.min() < 250.0


def test_circuit_saturates_and_is_undone() -> None:
    model, drive = Model(), np.array([0.0, 0.1, 0.5, 0.9, 1.0, 1.5, 3.0, 30.0])
    values = values_of_drive(drive, model)
    assert values[:3] == pytest.approx(255.0 * drive[:3], abs=0.1), "linear in little light"
    assert np.diff(values).min() > 0.0 and values[-1] < 255.0
    assert drive_of_values(values, model) == pytest.approx(drive, rel=1e-3)
    voltage = 1.0 - values / 255.0
    current = drive * -np.expm1(-voltage * model.supply_v / model.knee_v)
    assert current == pytest.approx(voltage * -1.0 + 1.0, abs=1e-3), "Kirchhoff"


def test_a_saturated_fingertip_hides_thin_material(twin: Twin) -> None:
    bright = Twin(twin.layout, twin.model.changed(gain=4.0))
    thin = Sheet(clear=0.6)
    assert twin.values(thin).mean() == pytest.approx(0.6 * 255.0, rel=0.05)
    assert bright.values(thin).mean() > 250.0


def test_the_die_is_seen_deeper_in_thinner_silicone(twin: Twin) -> None:
    glass = Model.from_layout(twin.layout, silicone_index=1.0)
    assert glass.emitter_depth_mm == pytest.approx(1.0)
    assert Model.from_layout(twin.layout).emitter_depth_mm == pytest.approx(0.9 / 1.41 + 0.1)


def test_light_of_neighbours_grows_with_the_gap(twin: Twin) -> None:
    shares = []
    for gap_mm in (2.0, 3.0, 6.0):
        pairs = Pairs.of(twin.layout, Emitter(Model.from_layout(twin.layout, gap_mm)))
        own = [k for k, (_, x, y, _) in enumerate(pairs.kinds) if x == y == 0.0]
        shares.append(1.0 - float(pairs.light[own].sum() / pairs.full.max()))
    assert shares == sorted(shares)
    assert shares[0] < 0.05
    assert shares[2] > 0.5


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: Model(gap_mm=0.0),
        lambda: Model(alpha=1.2),
        lambda: Model(hole_shape="square"),
        lambda: HalfPlane(clear=0.6, diffuse=0.6),
        lambda: HalfPlane(height=1.5),
        lambda: Cable(diameter_mm=0.0),
        lambda: Polygon([(0, 0), (1, 1)]),
        lambda: Image(np.full((2, 2), 3.0)),
        lambda: Image(np.zeros((2, 2)), pixel_mm=0.0),
    ],
)
def test_what_cannot_be_is_refused(wrong: Callable[[], object]) -> None:
    with pytest.raises(TwinError, match=r" is | has shape "):
        wrong()
